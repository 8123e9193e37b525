@tool
## Draws the ground and the water of a [WadiTerrain3D]: meshes whose vertices the shaders lift to what the world publishes.
##
## Put it under the terrain. The grid is drawn in square chunks; a chunk that is far from the camera has fewer triangles and its edges are
## sewn to those of its neighbours. Each chunk has the bounds of what lies in it, so that nothing is left out of the picture or of shadows.
class_name WadiSurface3D
extends Node3D

const Grid := preload("surface_grid.gd")
const GROUND := preload("ground.gdshader")
const WATER := preload("water.gdshader")
const BOUND: Array[StringName] = [&"packed_texture", &"sand_texture", &"flow_texture", &"cells", &"cell_size", &"detail", &"to_terrain"]

## The terrain; empty: the parent.
@export var terrain: WadiTerrain3D
## Material of rock and sand, with [code]ground.gdshader[/code] or one that includes the same file; empty: the shader's defaults.
@export var ground_material: ShaderMaterial
## Material of the water; empty: the shader's defaults.
@export var water_material: ShaderMaterial
## Whether water is drawn.
@export var draw_water := true
## Length that the patterns of both materials scale with [m]: a tenth of a metre for a beach of toys; 0: the side of a cell.
@export_range(0, 10, 0.01, "or_greater", "suffix:m") var detail := 0.0
## How far the rim goes on outside the grid, as it is at each moment [m]; 0: the picture ends with the grid.
@export_range(0, 1000, 1, "or_greater", "suffix:m") var apron := 0.0
## Cells along the side of a chunk: 16, 32, 64 or 128.
@export_enum("16:16", "32:32", "64:64", "128:128") var chunk_cells := 64
## Distance within which a chunk has a vertex at every cell [m], each doubling of it halves them; 0: twice the chunk's diagonal, which
## is also the least.
@export_range(0, 1000, 1, "or_greater", "suffix:m") var near_distance := 0.0
@export var cast_shadow := GeometryInstance3D.SHADOW_CASTING_SETTING_ON

class Chunk:
	var region: Rect2i  # cells, y counting from the south
	var middle: Vector2  # x, z in the terrain's space
	var ground: MeshInstance3D
	var water: MeshInstance3D
	var level := -1
	var sewn := -1

var _chunks: Array[Chunk] = []
var _across := 0  # chunks from west to east
var _apron: Array[MeshInstance3D] = []
var _grid: Grid
var _materials: Array[ShaderMaterial] = []
var _seen_from := Vector3.INF


func _ready() -> void:
	set_notify_transform(true)
	if terrain == null:
		terrain = get_parent() as WadiTerrain3D
	if terrain == null:
		push_error("WadiSurface3D: no WadiTerrain3D: set `terrain` or make this its child")
		set_process(false)
		return
	var wanted := (1 << WadiTerrain3D.OUTPUT_PACKED) | (1 << WadiTerrain3D.OUTPUT_SAND_DEPTH)
	if draw_water:
		wanted |= 1 << WadiTerrain3D.OUTPUT_FLOW
	terrain.outputs |= wanted
	terrain.started.connect(rebuild)
	terrain.world_changed.connect(_on_world_changed)
	if terrain.is_started():
		rebuild()


func _notification(what: int) -> void:
	if what == NOTIFICATION_TRANSFORM_CHANGED:
		for material in _materials:
			material.set_shader_parameter("to_terrain", global_transform.affine_inverse())
	elif what == NOTIFICATION_EDITOR_PRE_SAVE:  # what a world shows is no part of the scene
		for material in _materials:
			for parameter in BOUND:
				material.set_shader_parameter(parameter, null)
	elif what == NOTIFICATION_EDITOR_POST_SAVE and not _materials.is_empty():
		_bind(terrain.get_cells(), terrain.get_cell_size())


func _get_configuration_warnings() -> PackedStringArray:
	if terrain == null and not get_parent() is WadiTerrain3D:
		return ["No terrain: set `terrain` or make this a child of a WadiTerrain3D."]
	return []


## Makes the meshes anew: called when the world starts; call it after a change of this node's properties.
func rebuild() -> void:
	for child in get_children(true):
		if child is MeshInstance3D and child.has_meta("wadi"):
			child.free()
	_chunks.clear()
	_apron.clear()
	var cells: Vector2i = terrain.get_cells()
	var side: float = terrain.get_cell_size()
	_grid = Grid.new(chunk_cells, side)
	_bind(cells, side)
	_across = ceili(cells.x / float(chunk_cells))
	for b in ceili(cells.y / float(chunk_cells)):
		for a in _across:
			_chunks.append(_make_chunk(Vector2i(a, b) * chunk_cells, cells, side))
	if apron > 0:
		_apron.append(_make_instance(_materials[0], _grid.apron(cells, apron, 1), Vector3.ZERO))
		if draw_water:
			_apron.append(_make_instance(_materials[1], _grid.apron(cells, apron, 0), Vector3.ZERO))
	_set_bounds([Rect2i(Vector2i.ZERO, cells)])
	_seen_from = Vector3.INF
	_process(0)


func _bind(cells: Vector2i, side: float) -> void:
	_materials.clear()
	_materials.append(_material(ground_material, GROUND))
	_materials[0].set_shader_parameter("sand_texture", terrain.get_texture(WadiTerrain3D.OUTPUT_SAND_DEPTH))
	if draw_water:
		_materials.append(_material(water_material, WATER))
		_materials[1].set_shader_parameter("flow_texture", terrain.get_texture(WadiTerrain3D.OUTPUT_FLOW))
	for material in _materials:
		material.set_shader_parameter("packed_texture", terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED))
		material.set_shader_parameter("cells", cells)
		material.set_shader_parameter("cell_size", side)
		material.set_shader_parameter("detail", detail if detail > 0 else side)
		material.set_shader_parameter("to_terrain", global_transform.affine_inverse())


## The material that is drawn: one's own, so that a slider moved in the editor shows at once.
static func _material(own: ShaderMaterial, shader: Shader) -> ShaderMaterial:
	if own != null:
		return own
	var material := ShaderMaterial.new()
	material.shader = shader
	return material


func _make_instance(material: ShaderMaterial, mesh: Mesh, place: Vector3) -> MeshInstance3D:
	var instance := MeshInstance3D.new()
	instance.set_meta("wadi", true)
	instance.mesh = mesh
	instance.material_override = material
	instance.position = place
	instance.cast_shadow = cast_shadow if material == _materials[0] else GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(instance, false, Node.INTERNAL_MODE_BACK)
	return instance


func _make_chunk(low: Vector2i, cells: Vector2i, side: float) -> Chunk:
	var chunk := Chunk.new()
	chunk.region = Rect2i(low, (cells - low).min(Vector2i(chunk_cells, chunk_cells)))
	var place := Vector3((low.x - 0.5 * cells.x) * side, 0, (0.5 * cells.y - low.y) * side)
	chunk.middle = Vector2(place.x, place.z) + Vector2(chunk.region.size.x, -chunk.region.size.y) * (0.5 * side)
	chunk.ground = _make_instance(_materials[0], null, place)
	if draw_water:
		chunk.water = _make_instance(_materials[1], null, place)
	return chunk


func _process(_delta: float) -> void:
	var camera := _camera()
	if camera == null or _chunks.is_empty():
		return
	var eye := global_transform.affine_inverse() * camera.global_position
	if eye.distance_to(_seen_from) < 0.05 * chunk_cells * _grid.side:
		return
	_seen_from = eye
	var diagonal := chunk_cells * _grid.side * sqrt(2.0)
	var near := maxf(near_distance, 2 * diagonal)
	for chunk in _chunks:
		var box := chunk.ground.custom_aabb
		var height := clampf(eye.y, box.position.y, box.end.y)
		var far := Vector3(chunk.middle.x, height, chunk.middle.y).distance_to(eye)
		chunk.level = clampi(floori(log(maxf(far / near, 1e-3)) / log(2.0)) + 1, 0, _grid.coarsest)
	for n in _chunks.size():
		_show(n)


## The mesh of a chunk for its own detail and that of the four beside it.
func _show(n: int) -> void:
	var chunk := _chunks[n]
	var column := n % _across
	var sewn := 0
	if column > 0 and _chunks[n - 1].level > chunk.level:
		sewn |= Grid.WEST
	if column < _across - 1 and _chunks[n + 1].level > chunk.level:
		sewn |= Grid.EAST
	if n >= _across and _chunks[n - _across].level > chunk.level:
		sewn |= Grid.SOUTH
	if n + _across < _chunks.size() and _chunks[n + _across].level > chunk.level:
		sewn |= Grid.NORTH
	var mesh := _grid.chunk(chunk.level, sewn)
	if chunk.ground.mesh != mesh:
		chunk.ground.mesh = mesh
		if chunk.water != null:
			chunk.water.mesh = mesh


func _camera() -> Camera3D:
	if Engine.is_editor_hint():
		return Engine.get_singleton("EditorInterface").get_editor_viewport_3d(0).get_camera_3d()  # by name: games have no such class
	return get_viewport().get_camera_3d()


func _on_world_changed(regions: Array[Rect2i]) -> void:
	_set_bounds(regions)


## Bounds of the chunks that these cells touch. The mean of three cells that is drawn lies within theirs; water that runs on below the
## shore and the apron's lowered edge stay within a cell's side of it.
func _set_bounds(regions: Array[Rect2i]) -> void:
	for chunk in _chunks:
		for region in regions:
			if chunk.region.grow(1).intersects(region):
				_set_box(chunk)
				break
	if _apron.is_empty() or _chunks.is_empty():
		return
	var box := _chunks[0].ground.custom_aabb
	var heights := Vector2(box.position.y, box.end.y)
	for chunk in _chunks:
		heights.x = minf(heights.x, chunk.ground.custom_aabb.position.y)
		heights.y = maxf(heights.y, chunk.ground.custom_aabb.end.y)
	var reach := Vector2(terrain.get_cells()) * (0.5 * _grid.side) + Vector2(apron, apron)
	for instance in _apron:
		instance.custom_aabb = AABB(Vector3(-reach.x, heights.x, -reach.y), Vector3(2 * reach.x, heights.y - heights.x, 2 * reach.y))


func _set_box(chunk: Chunk) -> void:
	var side := _grid.side
	var heights: Vector2 = terrain.get_bounds(chunk.region.grow(1))
	if heights == Vector2.ZERO:
		heights = Vector2(-1e4, 1e4)  # nothing has come from the device yet
	var size := Vector3(chunk.region.size.x, 0, chunk.region.size.y) * side
	size.y = heights.y - heights.x + 2 * side
	var box := AABB(Vector3(0, heights.x - side, -size.z), size)
	if not box.is_equal_approx(chunk.ground.custom_aabb):
		chunk.ground.custom_aabb = box
		if chunk.water != null:
			chunk.water.custom_aabb = box
