## Part of the editor in editor.sh alone: says twice a second where on the screen the node World, the button Brush and the 3D view are and
## how many strokes the scene holds, a line each, and keeps a picture of the editor for each number of strokes.
@tool
extends EditorPlugin

const AT := Vector2(1.15, 1.95) # x, z

var _next := 0
var _count := -1
var _since := 0 # looks
var _kept := -1

func _process(_delta: float) -> void:
	if Time.get_ticks_msec() < _next:
		return
	_next = Time.get_ticks_msec() + 500
	var lines := PackedStringArray()
	_look(EditorInterface.get_base_control(), lines)
	var view: Control = EditorInterface.get_editor_viewport_3d(0).get_parent()
	if view.is_visible_in_tree():
		lines.append(_line("View", view.get_global_rect().get_center()))
	var scene := EditorInterface.get_edited_scene_root()
	var strokes := scene.get_node_or_null("World/Strokes") if scene != null else null
	var count: int = strokes.strokes.size() / 7 if strokes != null else 0
	lines.append("strokes %d" % count)
	var world: WadiTerrain3D = scene.get_node("World") if scene != null else null
	if world != null and world.is_started(): # ground where editor.sh draws, of the world and as it is drawn [mm]
		var cell := Vector2i((AT * Vector2(1, -1) / world.get_cell_size() + 0.5 * Vector2(world.get_cells())).floor()) # from the south
		var texel := world.get_texture(WadiTerrain3D.OUTPUT_PACKED).get_image().get_pixelv(cell)
		lines.append(_line("Ground", 1000 * Vector2(world.get_heights(Rect2i(cell, Vector2i.ONE))[0], texel.r - texel.g)))
	var spring := world.get_node_or_null("Spring") if world != null else null
	for gizmo: EditorNode3DGizmo in spring.get_gizmos() if spring != null else []:
		if gizmo.get_plugin()._get_gizmo_name() == "WadiSource3D":
			lines.append("gizmo of a source")
	_since = _since + 1 if count == _count else 0
	_count = count
	if _since >= 4 and lines.has("pressed 1"): # drawn by now
		if _kept != count:
			get_viewport().get_texture().get_image().save_png("res://probe_%d.png" % count)
		_kept = count
		lines.append("picture %d" % count)
	var file := FileAccess.open("res://probe.txt", FileAccess.WRITE)
	file.store_string("\n".join(lines) + "\n")

func _line(name: String, at: Vector2) -> String:
	return "%s %d %d" % [name, at.x, at.y]

func _look(control: Node, lines: PackedStringArray) -> void:
	if control is Button and control.text == "Brush" and control.is_visible_in_tree():
		lines.append(_line("Brush", control.get_global_rect().get_center()))
		lines.append("pressed %d" % int(control.button_pressed))
	elif control is Tree and control.is_visible_in_tree() and control.get_parent().get_class() == "SceneTreeEditor":
		var item: TreeItem = control.get_root()
		while item != null and item.get_text(0) != "World":
			item = item.get_next_in_tree()
		if item != null:
			lines.append(_line("World", control.get_global_position() + control.get_item_area_rect(item, 0).get_center() - control.get_scroll()))
	for child in control.get_children(true):
		_look(child, lines)
