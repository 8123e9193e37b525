## A beach: sand castle, rising tide, three sets of waves. The sea must stay out of the courtyard until the last set is over.
extends "game.gd"

const COURT := Rect2(-1.7, -4.9, 3.4, 3.4)  # x, z
const KEEP := Vector2(0, -3.2)
const WADING := 0.03  # depth that counts as flooded [m]
const LOST_FROM := 0.25  # share of the courtyard

var _court := PackedVector2Array()
var _flooded := 0.0
var _worst := 0.0
var _next_look := 0.0


func _begin() -> void:
	for j in 12:
		for i in 12:
			var place := COURT.position + COURT.size * Vector2(i + 0.5, j + 0.5) / 12.0
			if place.distance_to(KEEP) > 1.2:
				_court.append(place)


func _judge(time: float) -> void:
	_raise_flag()
	if time >= _next_look:
		_next_look = time + 0.25
		ask(_court, _look)
	if _flooded > LOST_FROM:
		verdict = Verdict.LOST
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
	return "courtyard flooded %2.0f %% (%2.0f %% at worst, %.0f %% lose)   bucket %d" % [100 * _flooded, 100 * _worst, 100 * LOST_FROM, bucket]


func _raise_flag() -> void:
	var cells := world.get_cells()
	var at := Vector2i((KEEP / world.get_cell_size() * Vector2(1, -1)).round()) + cells / 2
	$Flag.position = Vector3(KEEP.x, world.get_heights(Rect2i(at, Vector2i.ONE))[0], KEEP.y)


## Between the sets of waves: sand from behind the castle for the wall in front of it.
const STROKES := [
	[1.0, 10.5, 0, Vector2(-6, -9.5), Vector2(1.2, 0)],
	[10.5, 14.0, 1, Vector2(-3.6, 0.5), Vector2(1.1, 0.15)],
	[14.0, 17.5, 1, Vector2(0, 1.0), Vector2(1.1, -0.15)],
	[18.0, 27.0, 0, Vector2(-6, -10.5), Vector2(1.2, 0)],
	[27.0, 30.7, 1, Vector2(-3.6, 0.5), Vector2(1.05, 0.15)],
	[30.7, 34.4, 1, Vector2(0, 1.0), Vector2(1.05, -0.15)],
]


func _strokes() -> Array:
	return STROKES
