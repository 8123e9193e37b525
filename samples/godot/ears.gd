## Listens to the water at points all over the grid: how loud it is, and a splash where it comes to a place.
extends Node

## Speed of water that is heard as a splash where it comes [m/s].
@export var fast := 1.8

const COUNT := Vector2i(8, 6)
const EVERY := 0.2  # seconds of the world

var _points := PackedVector2Array()
var _speeds := PackedFloat32Array()
var _next := 0.0


func listen(game: Node3D) -> void:
	var time: float = game.world.get_time()
	if time < _next:
		return
	_next = time + EVERY
	if _points.is_empty():
		for j in COUNT.y:
			for i in COUNT.x:
				_points.append(game.world.get_extent() * ((Vector2(i, j) + Vector2(0.5, 0.5)) / Vector2(COUNT) - Vector2(0.5, 0.5)))
		_speeds.resize(_points.size())
	game.ask(_points, func(answer: Array) -> void: _hear(answer, game.sounds))


func _hear(answer: Array, sounds: Node) -> void:
	var sum := 0.0
	var came := 0
	for n in answer.size():
		var speed: float = answer[n].velocity.length() if answer[n].water_depth > 0.05 else 0.0
		sum += minf(speed / fast, 2)
		if speed > fast and _speeds[n] < 0.5 * fast:
			came += 1
		_speeds[n] = speed
	sounds.set_surf(sum / answer.size())
	if came > 0:
		sounds.play(&"splash", minf(4 * came - 14, 0))
