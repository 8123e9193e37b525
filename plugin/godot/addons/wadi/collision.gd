## Solid ground of a [WadiTerrain3D] for Godot's physics: height map tiles that are made anew where the sand or the rock has changed.
##
## Put it under the terrain. It follows [signal WadiTerrain3D.world_changed]; tiles in which only water moved cost a comparison. The
## surface runs through the middles of the cells: half a cell along the grid's rim is left out.
class_name WadiCollision3D
extends StaticBody3D

## The terrain; empty: the parent.
@export var terrain: WadiTerrain3D
## Cells along the side of a tile.
@export_range(8, 128, 1) var tile_cells := 32
## Whether bodies that a change would bury are carried up with the ground below them. A height map has no inside that would push them out.
@export var carry_bodies := true
## Most bodies that are carried in a tile at a time.
@export_range(1, 256, 1) var most_carried := 32

## Tiles made anew since the start, without those of the start.
var rebuilt := 0

## More tiles than this are made by the worker threads together: a tile of 32 x 32 cells is 0.1 ms of script.
const ALONE := 4

class Tile:
	var region: Rect2i  # cells whose middles are its points, y counting from the south
	var shape: HeightMapShape3D
	var middle: Vector2  # x, z in the terrain's space
	var heights: PackedFloat32Array  # [m], north first
	var before: PackedFloat32Array
	var scaled: PackedFloat32Array

var _tiles: Array[Tile] = []
var _side := 1.0
var _touched := {}


func _ready() -> void:
	process_physics_priority = 100  # after the world's step
	if terrain == null:
		terrain = get_parent() as WadiTerrain3D
	if terrain == null:
		push_error("WadiCollision3D: no WadiTerrain3D: set `terrain` or make this its child")
		return
	terrain.started.connect(rebuild)
	terrain.world_changed.connect(_on_world_changed)
	if terrain.is_started():
		rebuild()


## Makes all tiles anew: called when the world starts.
func rebuild() -> void:
	for child in get_children():
		if child is CollisionShape3D:
			child.free()
	_tiles.clear()
	_touched.clear()
	rebuilt = 0
	_side = terrain.get_cell_size()
	var cells: Vector2i = terrain.get_cells()
	for j in range(0, cells.y - 1, tile_cells):
		for i in range(0, cells.x - 1, tile_cells):
			var low := Vector2i(i, j)
			_tiles.append(_make_tile(Rect2i(low, (cells - low).min(Vector2i(tile_cells, tile_cells) + Vector2i.ONE)), cells))
	var all: Array[Tile] = []
	for tile in _tiles:
		tile.heights = terrain.get_heights(tile.region)
		all.append(tile)
	_apply(all)


func _make_tile(region: Rect2i, cells: Vector2i) -> Tile:
	var tile := Tile.new()
	tile.region = region
	tile.shape = HeightMapShape3D.new()
	tile.shape.map_width = region.size.x
	tile.shape.map_depth = region.size.y
	var centre := Vector2(region.position) + 0.5 * Vector2(region.size) - 0.5 * Vector2(cells)
	tile.middle = Vector2(centre.x, -centre.y) * _side
	var node := CollisionShape3D.new()
	node.shape = tile.shape
	node.position = Vector3(tile.middle.x, 0, tile.middle.y)
	node.scale = Vector3(_side, _side, _side)  # the shape's points are 1 apart; physics wants the same scale along all axes
	add_child(node)
	return tile


func _on_world_changed(regions: Array[Rect2i]) -> void:
	for n in _tiles.size():
		for region in regions:
			if _tiles[n].region.intersects(region):
				_touched[n] = true
				break


func _physics_process(_delta: float) -> void:
	if not _touched.is_empty():
		update_touched()


## Brings the tiles that have been touched up to date; called at each physics step.
func update_touched() -> void:
	var changed: Array[Tile] = []
	for n: int in _touched:
		var tile := _tiles[n]
		var heights: PackedFloat32Array = terrain.get_heights(tile.region)
		if heights != tile.heights:
			tile.before = tile.heights
			tile.heights = heights
			changed.append(tile)
	_touched.clear()
	rebuilt += changed.size()
	_apply(changed)
	if carry_bodies:
		for tile in changed:
			_carry(tile)


func _apply(changed: Array[Tile]) -> void:
	var per_cell := func(n: int) -> void:
		var tile := changed[n]
		tile.scaled = tile.heights.duplicate()
		for k in tile.scaled.size():
			tile.scaled[k] /= _side
	if changed.size() > ALONE:
		WorkerThreadPool.wait_for_group_task_completion(WorkerThreadPool.add_group_task(per_cell, changed.size()))
	else:
		for n in changed.size():
			per_cell.call(n)
	for tile in changed:
		tile.shape.map_data = tile.scaled


## Elevation of the collision's surface at x, z in the terrain's space, before or after the last change; NAN outside the tile.
func _height(tile: Tile, heights: PackedFloat32Array, place: Vector2) -> float:
	var size := tile.region.size
	var q := (place - tile.middle) / _side + 0.5 * Vector2(size - Vector2i.ONE)
	if q.x < 0 or q.y < 0 or q.x > size.x - 1 or q.y > size.y - 1:
		return NAN
	var low := Vector2i(q).min(size - Vector2i(2, 2))
	var t := q - Vector2(low)
	var k := low.y * size.x + low.x
	var north := lerpf(heights[k], heights[k + 1], t.x)
	var south := lerpf(heights[k + size.x], heights[k + size.x + 1], t.x)
	return lerpf(north, south, t.y)


func _carry(tile: Tile) -> void:
	var low := INF
	var high := -INF
	for n in tile.heights.size():
		if tile.heights[n] != tile.before[n]:
			low = minf(low, minf(tile.heights[n], tile.before[n]))
			high = maxf(high, maxf(tile.heights[n], tile.before[n]))
	var query := PhysicsShapeQueryParameters3D.new()
	var box := BoxShape3D.new()
	box.size = Vector3((tile.region.size.x - 1) * _side, high - low + 2 * _side, (tile.region.size.y - 1) * _side)
	query.shape = box
	query.transform = terrain.global_transform * Transform3D(Basis(), Vector3(tile.middle.x, 0.5 * (low + high), tile.middle.y))
	query.exclude = [get_rid()]
	query.collision_mask = collision_mask
	for hit in get_world_3d().direct_space_state.intersect_shape(query, most_carried):
		var body := hit.collider as PhysicsBody3D
		if body == null or body is StaticBody3D:
			continue
		var local := terrain.to_local(body.global_position)
		var before := _height(tile, tile.before, Vector2(local.x, local.z))
		var after := _height(tile, tile.heights, Vector2(local.x, local.z))
		if after > before and local.y >= before and local.y < after:
			body.global_position += terrain.global_transform.basis.y.normalized() * (after - before)
