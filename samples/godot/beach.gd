## A beach: sand castle, rising tide, three sets of waves. The sea must stay out of the courtyard until the last set is over.
extends "game.gd"

const COURT := Rect2(-1.7, -4.9, 3.4, 3.4)  # x, z
const KEEP := Vector2(0, -3.2)
const WADING := 0.03  # depth that counts as flooded [m]
const SEA_WALL := [Vector3(-4.5, 0, -0.7), Vector3(-3.5, 0, 0.5), Vector3(0, 0, 1), Vector3(3.5, 0, 0.5), Vector3(4.5, 0, -0.7)]
const GATE := [Vector3(0, 0, -0.7), Vector3(0, 0, -2.1)]

## What a player can choose from. `flooded`: share of the courtyard that loses; `gone`: lines along which sand is taken at first.
const CASTLES := [
	{name = "Castle", says = "A sea wall stands before it. Lost when a quarter of the courtyard is flooded.", bucket = 20, flooded = 0.25, gone = []},
	{name = "Calm day", says = "The bucket is full, and half of the courtyard may be flooded.", bucket = 160, flooded = 0.5, gone = []},
	{name = "Open gate", says = "No sea wall, and a gate towards the sea. Lost when an eighth is flooded.", bucket = 20, flooded = 0.125, gone = [SEA_WALL, GATE]},
]

var _court := PackedVector2Array()
var _flooded := 0.0
var _worst := 0.0
var _next_court := 0.0


func _choices() -> Array:
	return CASTLES.map(func(castle: Dictionary) -> Array: return [castle.name, castle.says])


func _begin() -> void:
	_court.clear()
	for j in 12:
		for i in 12:
			var place := COURT.position + COURT.size * Vector2(i + 0.5, j + 0.5) / 12.0
			if place.distance_to(KEEP) > 1.2:
				_court.append(place)
	bucket = CASTLES[choice].bucket
	for line: Array in CASTLES[choice].gone:
		for n in line.size() - 1:
			world.brush_line(WadiTerrain3D.LAYER_SAND, line[n], line[n + 1], 0.6, -0.55)
	if not CASTLES[choice].gone.is_empty():
		world.step(1)  # so that it is seen before the game begins
	_raise_flag()
	$Sea.read(world.level)
	if not $Sea.coming.is_connected(_on_waves_coming):
		$Sea.coming.connect(_on_waves_coming)


func _on_waves_coming(number: int, of: int) -> void:
	screens.announce("Waves from the sea: set %d of %d" % [number, of])
	sounds.play(&"bell")


func _judge(time: float) -> void:
	_raise_flag()
	$Sea.tell(time)
	if time >= _next_court:
		_next_court = time + 0.25
		ask(_court, _look)
	if _flooded > CASTLES[choice].flooded:
		verdict = Verdict.LOST
		create_tween().tween_property($Flag, "rotation:x", 1.5, 0.8).set_trans(Tween.TRANS_BOUNCE)
	elif time >= duration:
		verdict = Verdict.WON


func _look(answer: Array) -> void:
	var wet := 0
	for point: Dictionary in answer:
		if point.water_depth > WADING:
			wet += 1
	_flooded = wet / float(answer.size())
	_worst = maxf(_worst, _flooded)


func _score() -> String:
	return "Courtyard flooded %.0f %%, %.0f %% at worst, %.0f %% loses" % [100 * _flooded, 100 * _worst, 100 * CASTLES[choice].flooded]


func _points() -> int:
	return roundi(1000 * (1 - _worst))


func _medal() -> Score.Medal:
	return Score.Medal.GOLD if _worst < 0.02 else Score.Medal.SILVER if _worst < 0.1 else Score.Medal.BRONZE


func _raise_flag() -> void:
	var cells := world.get_cells()
	var at := Vector2i((KEEP / world.get_cell_size() * Vector2(1, -1)).round()) + cells / 2
	$Flag.position = Vector3(KEEP.x, world.get_heights(Rect2i(at, Vector2i.ONE))[0], KEEP.y)


## Between the sets of waves: sand from behind the castle onto its front wall, which the waves take down, and then on its flanks.
const STROKES := [
	[1.0, 10.5, 0, Vector2(-6, -9.5), Vector2(1.2, 0)],
	[10.5, 12.8, 1, Vector2(-2.3, -1.35), Vector2(2, 0)],
	[12.8, 15.1, 1, Vector2(2.3, -1.35), Vector2(-2, 0)],
	[15.1, 17.4, 1, Vector2(-2.3, -1.35), Vector2(2, 0)],
	[18.0, 27.0, 0, Vector2(-6, -10.5), Vector2(1.2, 0)],
	[27.0, 29.0, 1, Vector2(-2.3, -1.35), Vector2(2.3, 0)],
	[29.0, 31.0, 1, Vector2(2.3, -1.35), Vector2(-2.3, 0)],
	[31.0, 32.5, 1, Vector2(-2.2, -1.35), Vector2(0, -2)],
	[32.5, 34.0, 1, Vector2(2.2, -1.35), Vector2(0, -2)],
	[34.0, 37.7, 1, Vector2(-2.3, -1.35), Vector2(1.15, 0)],
]
## Where there is an open gate: it first.
const GATE_STROKES := [
	[1.0, 9.0, 0, Vector2(-6, -9.5), Vector2(1.2, 0)],
	[9.0, 10.5, 1, Vector2(-0.3, -1.4), Vector2(0.4, 0)],
]


func _strokes() -> Array:
	return STROKES if CASTLES[choice].gone.is_empty() else GATE_STROKES + STROKES.slice(1)
