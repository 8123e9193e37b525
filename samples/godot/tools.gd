## The tool that one sees: a ring that lies on the ground, a shovel or a bucket in it, and words with height and volume.
extends Node3D

@export var world: WadiTerrain3D
## Radius of the ring [m].
@export var radius := 0.5

const POINTS := 48
const COLOURS := [Color(1, 0.55, 0.2), Color(0.45, 0.95, 0.5)]  # digs, builds

var _ring := ImmediateMesh.new()
var _at := Vector3.ZERO
var _worked := 0.0  # strokes so far, in radians of the tool's swing


func _ready() -> void:
	$Ring.mesh = _ring
	for part: Node3D in [$Shovel, $Bucket]:
		part.scale = Vector3.ONE * 2.6 * radius
	hide()


## Places it at x, z in the world's space. `held` and `most`: sand in the bucket and room in it [m3].
func point(place: Vector2, tool: int, working: bool, held: float, most: float) -> void:
	show()
	var height := _heights(place)
	_at = Vector3(place.x, height.call(place), place.y)
	_ring.clear_surfaces()
	_ring.surface_begin(Mesh.PRIMITIVE_TRIANGLE_STRIP)
	for n in POINTS + 1:
		var out := Vector2.from_angle(TAU * n / POINTS)
		for reach: float in [0.88, 1.0]:
			var there := place + out * radius * reach
			var on := maxf(height.call(there), _at.y - 0.6 * radius) + 0.05 * radius  # not down a steep wall
			_ring.surface_add_vertex(Vector3(there.x, on, there.y))
	_ring.surface_end()
	($Ring.material_override as StandardMaterial3D).albedo_color = COLOURS[tool]
	_worked += 0.35 if working else 0.0
	var swing := sin(_worked)
	$Shovel.visible = tool == 0
	$Bucket.visible = tool == 1
	$Shovel.position = _at + Vector3(0, (0.1 + 0.12 * swing) * radius, 0)
	$Shovel.rotation = Vector3(-0.5 - 0.3 * swing, 0.6, 0)
	$Bucket.position = _at + Vector3(0, 1.7 * radius, 0)
	$Bucket.rotation = Vector3(0, 0.6, (1.9 + 0.25 * swing) if working else 0.0)
	$Says.position = _at + Vector3(0, 5 * radius, 0)
	$Says.text = "%.2f m high\n%.1f of %.1f m³ in the bucket" % [_at.y, held, most]


## Where grains fly.
func tip() -> Vector3:
	return _at + Vector3(0, 0.3 * radius, 0)


## A function that gives heights at x, z near a place, between the middles of cells.
func _heights(place: Vector2) -> Callable:
	var side := world.get_cell_size()
	var cells := world.get_cells()
	var reach := Vector2.ONE * (radius + side)
	var to_cells := func(at: Vector2) -> Vector2: return Vector2(at.x, -at.y) / side + 0.5 * Vector2(cells) - Vector2(0.5, 0.5)
	var middle: Vector2 = to_cells.call(place)
	var low := Vector2i((middle - reach / side).floor()).clamp(Vector2i.ZERO, cells - Vector2i(2, 2))
	var high := Vector2i((middle + reach / side).ceil()).clamp(low + Vector2i.ONE, cells - Vector2i.ONE)
	var size := high - low + Vector2i.ONE
	var rows := world.get_heights(Rect2i(low, size))  # north first
	return func(at: Vector2) -> float:
		var q: Vector2 = (to_cells.call(at) - Vector2(low)).clamp(Vector2.ZERO, Vector2(size - Vector2i(2, 2)) + Vector2(0.999, 0.999))
		var corner := Vector2i(q)
		var south := (size.y - 1 - corner.y) * size.x + corner.x
		var t := q - Vector2(corner)
		return lerpf(lerpf(rows[south], rows[south + 1], t.x), lerpf(rows[south - size.x], rows[south - size.x + 1], t.x), t.y)
