## Where a ray meets the ground of a WadiTerrain3D, without physics: for the editor.
extends RefCounted

var _heights := PackedFloat32Array()  # north first
var _cells := Vector2i.ZERO
var _side := 1.0


## Takes the heights of now.
func look(terrain: WadiTerrain3D) -> void:
	_cells = terrain.get_cells()
	_side = terrain.get_cell_size()
	_heights = terrain.get_heights(Rect2i(Vector2i.ZERO, _cells))


## Lowest and highest ground [m].
func bounds() -> Vector2:
	var sorted := _heights.duplicate()
	sorted.sort()
	return Vector2(sorted[0], sorted[-1])


## The first place where the ray, in the terrain's space, is below the ground; null where it never is.
func hit(origin: Vector3, direction: Vector3) -> Variant:
	var step := direction.normalized() * (0.5 * _side)
	var half := Vector2(_cells) * (0.5 * _side)
	var box := AABB(Vector3(-half.x, -1e5, -half.y), Vector3(2 * half.x, 2e5, 2 * half.y))
	var entry: Variant = origin if box.has_point(origin) else box.intersects_ray(origin, direction)
	if entry == null:
		return null
	var place: Vector3 = entry
	place += step * 1e-3
	var heights := bounds()
	if place.y > heights.y and direction.y < 0:
		place += direction * ((place.y - heights.y) / -direction.y)
	while box.has_point(place) and place.y >= heights.x - absf(step.y):
		if place.y < _height(place):
			return place
		place += step
	return null


func _height(place: Vector3) -> float:
	var cell := Vector2i(Vector2(place.x, place.z) / _side + 0.5 * Vector2(_cells)).clamp(Vector2i.ZERO, _cells - Vector2i.ONE)
	return _heights[cell.y * _cells.x + cell.x]
