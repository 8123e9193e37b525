## The editor's part: a brush for the sand, the water and the rock of a WadiTerrain3D, and gizmos of its extent and of sources.
##
## Select the terrain, press Brush and draw in the 3D view; with Shift the brush takes instead of giving. Strokes go into a WadiStrokes
## node under the terrain, one action of undo for each time that the button is held.
@tool
extends EditorPlugin

const Extent := preload("brush_extent.gd")
const Ray := preload("brush_ray.gd")
const SourceGizmo := preload("source_gizmo.gd")
const Strokes := preload("brush_strokes.gd")

var _extent := Extent.new()
var _source := SourceGizmo.new()
var _ray := Ray.new()
var _bar := HBoxContainer.new()
var _on := Button.new()
var _layer := OptionButton.new()
var _radius := SpinBox.new()
var _amount := SpinBox.new()
var _terrain: WadiTerrain3D
var _drawn := PackedFloat32Array()  # strokes since the button went down
var _drawing := false
var _before := PackedByteArray()  # the world ahead of the first stroke


func _enter_tree() -> void:
	add_node_3d_gizmo_plugin(_extent)
	add_node_3d_gizmo_plugin(_source)
	_on.text = "Brush"
	_on.toggle_mode = true
	_bar.add_child(_on)
	for layer in ["Terrain", "Sand", "Water"]:  # in the order of WadiTerrain3D's layers
		_layer.add_item(layer)
	_layer.select(WadiTerrain3D.LAYER_SAND)
	_bar.add_child(_layer)
	_set_up(_radius, "Radius", 0.05, 1000, 1)
	_set_up(_amount, "Amount", 0.001, 100, 0.1)
	add_control_to_container(CONTAINER_SPATIAL_EDITOR_MENU, _bar)
	_bar.hide()


func _set_up(box: SpinBox, what: String, low: float, high: float, value: float) -> void:
	box.prefix = what
	box.suffix = "m"
	box.custom_minimum_size.x = 140 * EditorInterface.get_editor_scale() # for all of its words
	box.min_value = low
	box.max_value = high
	box.step = low
	box.value = value
	_bar.add_child(box)


func _exit_tree() -> void:
	remove_node_3d_gizmo_plugin(_source)
	remove_node_3d_gizmo_plugin(_extent)
	remove_control_from_container(CONTAINER_SPATIAL_EDITOR_MENU, _bar)
	_bar.queue_free()


func _handles(object: Object) -> bool:
	return object is WadiTerrain3D


func _edit(object: Object) -> void:
	_terrain = object as WadiTerrain3D
	if _terrain != null and not _terrain.is_started() and _terrain.level != null and _terrain.start() != OK:
		push_error(_terrain.get_last_message())
	if _terrain != null:
		_terrain.update_gizmos()


func _make_visible(visible: bool) -> void:
	_bar.visible = visible


func _forward_3d_gui_input(camera: Camera3D, event: InputEvent) -> int:
	if _terrain == null or not _on.button_pressed or not _terrain.is_started():
		return AFTER_GUI_INPUT_PASS
	if event is InputEventMouseButton and event.button_index == MOUSE_BUTTON_LEFT:
		_drawing = event.pressed
		if _drawing:
			_drawn.clear()
			if _strokes_of(_terrain) == null:
				_before = _terrain.save_state()
			_ray.look(_terrain)
			_draw(camera, event.position, event.shift_pressed)
		else:
			_keep()
		return AFTER_GUI_INPUT_STOP
	if event is InputEventMouseMotion and _drawing:
		_draw(camera, event.position, event.shift_pressed)
		return AFTER_GUI_INPUT_STOP
	return AFTER_GUI_INPUT_PASS


func _draw(camera: Camera3D, mouse: Vector2, taking: bool) -> void:
	var into := _terrain.global_transform.affine_inverse()
	var place: Variant = _ray.hit(into * camera.project_ray_origin(mouse), into.basis * camera.project_ray_normal(mouse))
	if place == null:
		return
	var stroke := PackedFloat32Array([_layer.selected, place.x, place.y, place.z, _radius.value,
			-_amount.value if taking else _amount.value, 0.5])
	_drawn.append_array(stroke)
	_terrain.brush(_layer.selected, place, stroke[4], stroke[5], stroke[6])
	Strokes.show_now(_terrain)


static func _strokes_of(terrain: WadiTerrain3D) -> Strokes:
	for child in terrain.get_children():
		if child is Strokes:
			return child
	return null


func _keep() -> void:
	if _drawn.is_empty():
		return
	var node := _strokes_of(_terrain)
	var undo := get_undo_redo()
	undo.create_action("Wadi: draw", UndoRedo.MERGE_DISABLE, _terrain)
	var before := PackedFloat32Array()
	if node == null:
		node = Strokes.new()
		node.name = "Strokes"
		node.begin_from(_before)
		undo.add_do_method(_terrain, "add_child", node, true)
		undo.add_do_method(node, "set_owner", EditorInterface.get_edited_scene_root())
		undo.add_do_reference(node)
		undo.add_undo_property(node, "strokes", before)  # while it has its terrain
		undo.add_undo_method(_terrain, "remove_child", node)
	else:
		before = node.strokes
		undo.add_undo_property(node, "strokes", before)
	undo.add_do_property(node, "strokes", before + _drawn)
	undo.commit_action()
