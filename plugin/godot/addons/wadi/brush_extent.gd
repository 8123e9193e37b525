## A box around the grid of a WadiTerrain3D, from its lowest to its highest ground.
@tool
extends EditorNode3DGizmoPlugin

const Ray := preload("brush_ray.gd")


func _init() -> void:
	create_material("line", Color(0.35, 0.75, 0.95))


func _get_gizmo_name() -> String:
	return "WadiTerrain3D"


func _has_gizmo(node: Node3D) -> bool:
	return node is WadiTerrain3D


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	var terrain := gizmo.get_node_3d() as WadiTerrain3D
	if not terrain.is_started():
		return
	var ray := Ray.new()
	ray.look(terrain)
	var heights := ray.bounds()
	var size := terrain.get_extent()
	var box := AABB(Vector3(-0.5 * size.x, heights.x, -0.5 * size.y), Vector3(size.x, heights.y - heights.x, size.y))
	var lines := PackedVector3Array()
	for n in 8:
		for axis in [1, 2, 4]:
			if not n & axis:
				lines.append_array([box.get_endpoint(n), box.get_endpoint(n | axis)])
	gizmo.add_lines(lines, get_material("line", gizmo))
