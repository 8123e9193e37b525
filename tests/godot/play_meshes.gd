# Meshes of WadiSurface3D: sewn sides share every vertex with the coarser neighbour, nothing is left open or turned over, bounds hold what
# the world publishes, and a chunk's neighbours are one level of detail away at most. With `--unsewn` after `--` no side is sewn,
# with `--still` bounds stay those of the start: then it must fail.
extends SceneTree

const Grid := preload("res://addons/wadi/surface_grid.gd")
const CELLS := 32
const SIDE := 0.5

var failed := false
var world: WadiTerrain3D
var surface: Node3D
var camera: Camera3D
var ticks := 0


func check(right: bool, what: String) -> void:
	if not right and not failed:
		print("FAILED: ", what)
	failed = failed or not right


func _initialize() -> void:
	var grid := Grid.new(CELLS, SIDE)
	var sewn_as := 0 if "--unsewn" in OS.get_cmdline_user_args() else 15
	for level in grid.coarsest + 1:
		for sewn in 16:
			_check_chunk(grid, level, sewn, sewn & sewn_as)
	_check_apron(grid)
	world = WadiTerrain3D.new()
	world.level = WadiLevel.new()
	world.level.file = "res://levels/canyon/level.json"
	world.backend = "cpu"
	surface = load("res://addons/wadi/surface.gd").new()
	surface.chunk_cells = 16
	surface.apron = 50.0
	world.add_child(surface)
	root.add_child(world)
	camera = Camera3D.new()
	root.add_child(camera)
	camera.position = Vector3(-48, 25, 62)


func _check_chunk(grid: Grid, level: int, sewn: int, built: int) -> void:
	var arrays := grid.chunk(level, built).surface_get_arrays(0)
	var vertices: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	var length := CELLS * SIDE
	var step := SIDE * (1 << level)
	var area := 0.0
	for k in range(0, indices.size(), 3):
		var a := vertices[indices[k]]
		var across := (vertices[indices[k + 1]] - a).cross(vertices[indices[k + 2]] - a)
		check(across.y < 0, "level %d, sewn %d: a triangle that is seen from below" % [level, sewn])
		area += 0.5 * absf(across.y)
	check(is_equal_approx(area, length * length), "level %d, sewn %d: triangles cover %f of %f" % [level, sewn, area, length * length])
	for index in indices:
		var v := vertices[index]
		var along := {Grid.WEST: v.x == 0, Grid.EAST: v.x == length, Grid.SOUTH: v.z == 0, Grid.NORTH: v.z == -length}
		for side: int in along:
			if along[side] and sewn & side:
				var place := absf(v.z) if side == Grid.WEST or side == Grid.EAST else v.x
				check(fmod(place, 2 * step) == 0, "level %d, sewn %d: a vertex at %s that the coarser chunk lacks" % [level, sewn, v])


func _check_apron(grid: Grid) -> void:
	var cells := Vector2i(24, 16)
	var reach := 10.0
	var arrays := grid.apron(cells, reach, 1).surface_get_arrays(0)
	var vertices: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	var area := 0.0
	for k in range(0, indices.size(), 3):
		var a := vertices[indices[k]]
		var across := (vertices[indices[k + 1]] - a).cross(vertices[indices[k + 2]] - a)
		check(across.y <= 1e-6, "apron: a triangle that is seen from below")
		area += 0.5 * absf(across.y)
	var inner := Vector2(cells) * SIDE
	var edge := (inner - Vector2(4, 4) * SIDE)
	var whole := (inner + 2 * Vector2(reach, reach)).x * (inner + 2 * Vector2(reach, reach)).y - edge.x * edge.y
	check(absf(area - whole) < 1e-2, "apron: covers %f of %f" % [area, whole])


func _process(_delta: float) -> bool:
	ticks += 1
	if ticks == 1:
		return false
	if not world.is_started() and world.start() != OK:
		print("FAILED: ", world.get_last_message())
		quit(1)
		return true
	# A flood comes, a hill rises and a pit opens: bounds must follow, at the tick that tells of the change.
	if ticks == 3:
		world.brush(WadiTerrain3D.LAYER_TERRAIN, Vector3(30, 0, 40), 6, 8)
		world.brush(WadiTerrain3D.LAYER_TERRAIN, Vector3(-35, 0, -20), 6, -12)
	if ticks == 2 and "--still" in OS.get_cmdline_user_args():
		world.world_changed.disconnect(surface._on_world_changed)
	if ticks < 8:
		world.step(200)
		world.sync_textures()
		return false
	if ticks < 10:
		world.running = false
		return false
	_check_bounds()
	print("bounds, levels of detail and seams: %s" % ("failed" if failed else "right"))
	quit(1 if failed else 0)
	return true


# The world's own answers at all middles of cells, row 0 in the south: without a renderer textures keep their first contents.
func _surfaces(cells: Vector2i) -> Array:
	var points := PackedVector2Array()
	for j in cells.y:
		for i in cells.x:
			points.append(Vector2(i + 0.5 - 0.5 * cells.x, 0.5 * cells.y - j - 0.5) * world.get_cell_size())
	var ticket := world.query(points)
	world.get_hash()  # waits for the steps
	return world.get_query(ticket)


func _check_bounds() -> void:
	var cells := world.get_cells()
	var surfaces := _surfaces(cells)
	var levels := {}
	for chunk in surface._chunks:
		var low := INF
		var high := -INF
		for j in range(chunk.region.position.y, chunk.region.end.y):
			for i in range(chunk.region.position.x, chunk.region.end.x):
				var here: Dictionary = surfaces[j * cells.x + i]
				low = minf(low, here.ground + here.sand_depth)
				high = maxf(high, here.surface)
		var box: AABB = chunk.ground.custom_aabb
		check(box.position.y <= low and box.end.y >= high, "bounds %s do not hold %f ... %f" % [box, low, high])
		check(box.size.y < 40, "bounds %s are no bounds" % box)
		levels[chunk.level] = true
		for other in surface._chunks:
			var beside: bool = chunk.region.grow(1).intersects(other.region)
			check(not beside or absi(chunk.level - other.level) <= 1, "levels of detail %d beside %d" % [chunk.level, other.level])
	check(levels.size() >= 3, "all chunks have the same level of detail")
