## A canyon with three dams and crates behind the first. The flood must carry enough of them out in the south before it is over.
##
## Left alone the dams hold back the water for a while each; who digs breaches early and in the right place saves time.
extends "game.gd"

## Beyond this z a crate has arrived [m].
const MOUTH := 52.0

## What a player can choose from: [name, one line on it, crates that must arrive].
const FLOODS := [
	["Three crates", "Three of six crates must leave the canyon.", 3],
	["Four crates", "Four of six crates must leave the canyon.", 4],
]

var _arrived := 0


func _choices() -> Array:
	return FLOODS


func _begin() -> void:
	var low := Vector2(world.get_extent()) * -0.5
	for crate: RigidBody3D in $Crates.get_children():
		var cell := Vector2i((Vector2(crate.position.x - low.x, -crate.position.z - low.y) / world.get_cell_size()).floor())
		crate.position.y = world.get_heights(Rect2i(cell, Vector2i.ONE))[0] + 0.9


func _judge(time: float) -> void:
	for crate: RigidBody3D in $Crates.get_children():
		if crate.position.z > MOUTH and not crate.freeze:
			crate.freeze = true
			_arrived += 1
			sounds.play(&"bell")
			screens.announce("A crate is out: %d of %d" % [_arrived, FLOODS[choice][2]])
	if _arrived >= FLOODS[choice][2]:
		verdict = Verdict.WON
	elif time >= duration:
		verdict = Verdict.LOST


func _score() -> String:
	return "%d of %d crates are out" % [_arrived, FLOODS[choice][2]]


func _points() -> int:
	return roundi(20 * (duration - world.get_time()))


func _medal() -> Score.Medal:
	return Score.Medal.GOLD if _points() > 100 else Score.Medal.SILVER if _points() > 50 else Score.Medal.BRONZE


## A breach in each dam, begun before the water is there.
const STROKES := [
	[0.5, 3.0, 0, Vector2(-12, -33), Vector2(0, 1)],
	[4.0, 9.0, 0, Vector2(12, -2), Vector2(0, 1)],
	[10.0, 15.0, 0, Vector2(-12, 30), Vector2(0, 1)],
]


func _strokes() -> Array:
	return STROKES
