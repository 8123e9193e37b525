## The sea's waves as the level's file has them: tells of each set before it comes, and draws what is still on its way to the grid.
extends Node

## A set of waves will begin at the grid's edge: its number, from 1, and of how many.
signal coming(number: int, of: int)

## Seconds ahead of which a set is told of.
@export var ahead := 4.0
## Speed of waves outside the grid [m/s].
@export var speed := 4.5
@export var world: WadiTerrain3D
## What draws the water, with the add-on's shader.
@export var water: ShaderMaterial

const CREST := 0.3  # above the level before it, from which a rise is a wave [m]
const REST := 7.0  # without waves, after which a set begins anew [s]
const POINTS := 64  # as the shader has them
const STEP := 2.0  # metres between them

var sets := PackedFloat32Array()  # when they begin [s]

var _times := PackedFloat32Array()
var _levels := PackedFloat32Array()
var _told := 0


func read(level: WadiLevel) -> void:
	_times.clear()
	_levels.clear()
	sets.clear()
	_told = 0
	var comments := RegEx.create_from_string("(?m)^\\s*//.*$")  # level files have them, JSON does not
	var file: Dictionary = JSON.parse_string(comments.sub(FileAccess.get_file_as_string(level.file), "", true))
	for point: Array in file.sides.south.wave:
		_times.append(point[0])
		_levels.append(point[1])
	var last := -INF
	for n in range(1, _times.size()):
		if _levels[n] - _levels[n - 1] > CREST:
			if _times[n] - last > REST:
				sets.append(_times[n - 1])
			last = _times[n]


## Level at the grid's edge against that of the start [m].
func level_at(time: float) -> float:
	var n := _times.bsearch(time)
	if n == 0 or n == _times.size():
		return _levels[maxi(n - 1, 0)]
	return lerpf(_levels[n - 1], _levels[n], smoothstep(_times[n - 1], _times[n], time))


func tell(time: float) -> void:
	if _told < sets.size() and time >= sets[_told] - ahead:
		_told += 1
		coming.emit(_told, sets.size())


func _process(_delta: float) -> void:
	if _times.is_empty():
		return
	var swell := PackedFloat32Array()
	var here := level_at(world.get_time())
	for n in POINTS:
		swell.append(level_at(world.get_time() + n * STEP / speed) - here)
	water.set_shader_parameter("swell", swell)
	water.set_shader_parameter("swell_step", STEP)
