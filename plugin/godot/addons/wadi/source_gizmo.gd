## The symbol of a WadiSource3D, the disc that it pours over, and its node's name.
@tool
extends EditorNode3DGizmoPlugin

const ICON := "res://addons/wadi/icons/WadiSource3D.svg"
const SEGMENTS := 32


func _init() -> void:
	create_material("water", Color(0.35, 0.75, 0.95), false, true) # on top of the ground while it is selected
	create_material("sand", Color(0.9, 0.72, 0.45), false, true)
	var symbol := Image.new() # drawn here: a plugin starts ahead of a project's first import
	symbol.load_svg_from_string(FileAccess.get_file_as_string(ICON), 4)
	create_icon_material("icon", ImageTexture.create_from_image(symbol), true)


func _get_gizmo_name() -> String:
	return "WadiSource3D"


func _has_gizmo(node: Node3D) -> bool:
	return node is WadiSource3D


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	var source := gizmo.get_node_3d() as WadiSource3D
	if not source.renamed.is_connected(source.update_gizmos):
		source.renamed.connect(source.update_gizmos)
	var material := get_material("water" if source.layer == WadiTerrain3D.LAYER_WATER else "sand", gizmo)
	var lines := PackedVector3Array()
	for n in SEGMENTS:
		for end in [n, n + 1]:
			lines.append(Vector3(source.radius, 0, 0).rotated(Vector3.UP, TAU * end / SEGMENTS))
	gizmo.add_lines(lines, material)
	gizmo.add_unscaled_billboard(get_material("icon", gizmo), 0.05)
	var words := TextMesh.new()
	words.text = source.name
	words.font_size = 32
	words.pixel_size = source.radius / 80
	words.depth = 0
	gizmo.add_mesh(words, material, Transform3D(Basis(Vector3.RIGHT, -0.25 * TAU), Vector3(0, 0, 1.3 * source.radius)))
