## Flat meshes that WadiSurface3D draws with: squares of a chunk at each level of detail, sewn to coarser neighbours, and the apron.
extends RefCounted

const WEST := 1
const EAST := 2
const SOUTH := 4
const NORTH := 8

var side: float  # of a cell [m]
var coarsest: int  # level with two squares a side

var _cells: int  # along a chunk's side
var _meshes := {}


func _init(cells: int, cell_side: float) -> void:
	_cells = cells
	side = cell_side
	coarsest = roundi(log(cells) / log(2.0)) - 1


## A chunk with a vertex at every 2^level-th cell; on the sides in `sewn` at every second of those. Origin in the south-west, north is -z.
func chunk(level: int, sewn: int) -> ArrayMesh:
	var key := level * 16 + sewn
	if not _meshes.has(key):
		_meshes[key] = _make_chunk(_cells >> level, side * (1 << level), sewn)
	return _meshes[key]


func _make_chunk(squares: int, step: float, sewn: int) -> ArrayMesh:
	var row := squares + 1
	var vertices := PackedVector3Array()
	for j in row:
		for i in row:
			vertices.append(Vector3(i * step, 0, -j * step))
	var indices := PackedInt32Array()
	for j in squares:
		for i in squares:
			var corners := PackedInt32Array([j * row + i, (j + 1) * row + i, (j + 1) * row + i + 1, j * row + i + 1])
			for n in 4:
				corners[n] = _sewn_to(corners[n], row, sewn)
			# The diagonal changes from square to square, so that slopes look alike in all directions.
			var order: Array = [0, 1, 2, 0, 2, 3] if (i + j) % 2 == 0 else [0, 1, 3, 1, 2, 3]
			for n in [0, 3]:
				var a: int = corners[order[n]]
				var b: int = corners[order[n + 1]]
				var c: int = corners[order[n + 2]]
				if a != b and b != c and c != a:
					indices.append_array([a, b, c])
	return _mesh(vertices, PackedVector2Array(), indices)


## The vertex itself, or on a sewn side its even neighbour.
static func _sewn_to(vertex: int, row: int, sewn: int) -> int:
	var i := vertex % row
	@warning_ignore("integer_division")
	var j := vertex / row
	var last := row - 1
	if (i == 0 and sewn & WEST) or (i == last and sewn & EAST):
		j -= j % 2
	if (j == 0 and sewn & SOUTH) or (j == last and sewn & NORTH):
		i -= i % 2
	return j * row + i


## What lies around the grid, `reach` metres wide; origin in the grid's middle. From inside out: an edge that is lowered by `lowered`
## cells two cells within the rim, the rim, then the far edge. UV = (1, how far the vertex is lowered).
func apron(cells: Vector2i, reach: float, lowered: float) -> ArrayMesh:
	var half := Vector2(cells) * (0.5 * side)
	var rim := PackedVector2Array()  # around the grid: east along the south side, north, west, south
	var out := PackedVector2Array()  # the direction away from the grid
	for i in cells.x + 1:
		rim.append(Vector2(-half.x + i * side, half.y))
		out.append(Vector2(0, 1))
	for j in cells.y + 1:
		rim.append(Vector2(half.x, half.y - j * side))
		out.append(Vector2(1, 0))
	for i in cells.x + 1:
		rim.append(Vector2(half.x - i * side, -half.y))
		out.append(Vector2(0, -1))
	for j in cells.y + 1:
		rim.append(Vector2(-half.x, -half.y + j * side))
		out.append(Vector2(-1, 0))
	var inner := half - Vector2(2 * side, 2 * side)
	var vertices := PackedVector3Array()
	var uvs := PackedVector2Array()
	for n in rim.size():
		var within := rim[n].clamp(-inner, inner)
		var beyond := rim[n] + out[n] * reach
		vertices.append_array([Vector3(within.x, 0, within.y), Vector3(rim[n].x, 0, rim[n].y), Vector3(beyond.x, 0, beyond.y)])
		uvs.append_array([Vector2(1, lowered), Vector2(1, 0), Vector2(1, 0)])
	var indices := PackedInt32Array()
	var count := rim.size()
	for n in count:
		var next := (n + 1) % count
		var corner := rim[n].is_equal_approx(rim[next])
		if not corner:
			if lowered > 0:
				indices.append_array(_square(3 * n, 3 * n + 1, 3 * next, 3 * next + 1))
			indices.append_array(_square(3 * n + 1, 3 * n + 2, 3 * next + 1, 3 * next + 2))
		else:  # the rim's corner, its two far neighbours and the far corner
			var far := rim[n] + (out[n] + out[next]) * reach
			vertices.append(Vector3(far.x, 0, far.y))
			uvs.append(Vector2(1, 0))
			indices.append_array(_square(3 * n + 1, 3 * n + 2, 3 * next + 2, vertices.size() - 1))
	return _mesh(vertices, uvs, indices)


## Two triangles between an inner and an outer edge, clockwise from above where the second pair lies to the left when looking out.
static func _square(inner: int, outer: int, next_inner: int, next_outer: int) -> PackedInt32Array:
	return [inner, next_inner, next_outer, inner, next_outer, outer]


static func _mesh(vertices: PackedVector3Array, uvs: PackedVector2Array, indices: PackedInt32Array) -> ArrayMesh:
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = vertices
	if uvs.is_empty():
		uvs.resize(vertices.size())
	arrays[Mesh.ARRAY_TEX_UV] = uvs
	var normals := PackedVector3Array()
	normals.resize(vertices.size())
	normals.fill(Vector3.UP)
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_INDEX] = indices
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh
