## What both games have in common: a start screen, the world, a bucket and a tool, what one hears and reads, an end and its score.
## Arguments and play by a script: replay.gd.
extends Node3D

const Replay := preload("replay.gd")
const Score := preload("score.gd")

enum Verdict { OPEN, WON, LOST }

## Seconds of the world that a game lasts.
@export var duration := 52.0
## What to do, on the start screen.
@export_multiline var task := ""
## Sand that a scoop digs or builds at the middle of the tool, and water that is built with it: dry sand flows apart [m].
@export var scoop := 0.08
@export var damp := 0.018
## Seconds between scoops.
@export var every := 1.0 / 15
## Scoops in the bucket at the start, and the most that it holds: what is built was dug before.
@export var bucket := 20
@export var bucket_size := 160
## Yaw and pitch of the camera on the start screen [degrees].
@export var first_look := Vector2(-20, 26)
## The other scene.
@export_file("*.tscn") var other := ""

@onready var world: WadiTerrain3D = $World
@onready var camera := $Camera
@onready var sounds := $Sounds
@onready var spray := $Spray
@onready var tools := $Tools
@onready var screens := $Screens

static var chosen := {}  # scene: which of its choices
static var straight := false  # into the game, without the start screen

var choice := 0
var verdict := Verdict.OPEN
var playing := false
var replay: Replay

var _waited := 0.0
var _answers := {}  # ticket of a query: what takes the answer


func _ready() -> void:
	get_tree().auto_accept_quit = false
	choice = chosen.get(name, 0)
	replay = Replay.new(self)
	if replay.on:
		camera.set_process(false)
		camera.set_physics_process(false)
		camera.set_process_unhandled_input(false)
		world.wait_for_device = true
		world.time_dropped.connect(func(seconds: float) -> void: leave("%f s dropped" % seconds, 1))
	else:
		world.time_dropped.connect(func(seconds: float) -> void: $Late.text = "%.0f ms late" % (1000 * seconds))
	if RenderingServer.get_current_rendering_method() == "gl_compatibility":
		$Sun.shadow_enabled = false  # there a light with shadows is added behind tone mapping, and the sum is too bright
	world.device_lost.connect(func(message: String) -> void: leave("device lost: " + message, 1))
	camera.pointed.connect(_on_hand_pointed)
	screens.chosen.connect(_choose)
	screens.play.connect(_on_play)
	screens.again.connect(restart)
	screens.other.connect(func() -> void: get_tree().change_scene_to_file(other))
	# The scenes keep `running` off, so that arguments count before the world is made.
	if not _make_world():
		return
	if replay.on:
		# Nothing is drawn until a picture is due.
		RenderingServer.render_loop_enabled = false
		play()
	elif straight:
		straight = false
		play()
	else:
		camera.look_beside(first_look)
		screens.show_start(name, task, _choices(), choice)


func _make_world() -> bool:
	if world.is_started():
		world.stop()
	if world.start() != OK:
		leave(world.get_last_message(), 2)
		return false
	_begin()
	return true


func _choose(which: int) -> void:
	if which != choice:
		choice = which
		chosen[name] = which
		_make_world()


func _on_play() -> void:
	camera.swing_back()
	play()


func play() -> void:
	playing = true
	world.running = true


## The same game from its beginning.
func restart() -> void:
	straight = true
	get_tree().reload_current_scene()


func leave(message: String, code: int) -> void:
	if code != 0:
		push_error(message)
	print(message)
	set_physics_process(false)
	await sounds.end()
	get_tree().quit(code)


## The game's own: what a player can choose from, each [name, one line on it].
func _choices() -> Array:
	return []


## The game's own: whenever a world was made.
func _begin() -> void:
	pass


## The game's own: the rules, at every physics step, while the verdict is open.
func _judge(_time: float) -> void:
	pass


## The game's own: what the script's hand does, each [from, until [s], tool, place (x, z) [m], velocity [m/s]].
func _strokes() -> Array:
	return []


## The game's own: one line on how it stands.
func _score() -> String:
	return ""


## The game's own: points of a game that was won, and its medal.
func _points() -> int:
	return 0


func _medal() -> Score.Medal:
	return Score.Medal.NONE


func _physics_process(_delta: float) -> void:
	if replay.on:
		replay.advance()
	for ticket: int in _answers.keys():
		var answer: Array = world.get_query(ticket)
		if not answer.is_empty():
			_answers[ticket].call(answer)
			_answers.erase(ticket)
	if playing and verdict == Verdict.OPEN:
		_judge(world.get_time())
		if verdict != Verdict.OPEN:
			_end()
	if playing and not replay.on:
		$Ears.listen(self)
	screens.say(world.get_time(), duration, _score(), bucket / float(bucket_size))
	if replay.on and replay.is_done() and _answers.is_empty():
		leave("%s %s %s\nverdict %s at %.2f s, %s\nhash %s after %d steps" % [name, world.get_cells(), "idle" if replay.idle else "played",
				Verdict.find_key(verdict), world.get_time(), _score(), world.get_hash(), world.get_step()], 0)


func _end() -> void:
	var won := verdict == Verdict.WON
	sounds.play(&"win" if won else &"lose")
	if replay.on:
		return
	var medal := _medal() if won else Score.Medal.NONE
	var record := won and Score.keep(name, _choices()[choice][0], _points(), medal)
	screens.show_end(won, medal, _points() if won else 0, Score.best(name, _choices()[choice][0]), record, _score())


func _on_hand_pointed(tool: int, place: Vector3, working: bool, delta: float) -> void:
	var local := world.to_local(place)
	if playing and verdict == Verdict.OPEN:
		tools.point(Vector2(local.x, local.z), tool, working, bucket * scoop_volume(), bucket_size * scoop_volume())
		_waited += delta
		if working and _waited >= every:
			_waited = 0
			use(tool, Vector2(local.x, local.z))
	else:
		tools.hide()


## Sand of a scoop [m3]: the brush gives all within half its radius and falls to nothing by 3 s^2 - 2 s^3.
func scoop_volume() -> float:
	return 0.575 * PI * camera.radius ** 2 * scoop


## One scoop at x, z in the world's space.
func use(tool: int, place: Vector2) -> void:
	var at := Vector3(place.x, 0, place.y)
	if verdict != Verdict.OPEN:
		return
	if tool == camera.DIG and bucket < bucket_size:
		bucket += 1
		world.brush(WadiTerrain3D.LAYER_SAND, at, camera.radius, -scoop)
		sounds.play(&"dig")
	elif tool == camera.BUILD and bucket > 0:
		bucket -= 1
		world.brush(WadiTerrain3D.LAYER_SAND, at, camera.radius, scoop)
		world.brush(WadiTerrain3D.LAYER_WATER, at, camera.radius, damp)
		sounds.play(&"pour")
	else:
		return
	if replay.on:
		tools.point(place, tool, true, bucket * scoop_volume(), bucket_size * scoop_volume())
	spray.burst(tools.tip(), camera.radius, false)


## Asks the world about points (x, z in its space); `then` gets the answers some frames later.
func ask(points: PackedVector2Array, then: Callable) -> void:
	var ticket := world.query(points)
	if ticket > 0:
		_answers[ticket] = then


func _unhandled_key_input(event: InputEvent) -> void:
	if replay.on or not event.is_pressed():
		return
	match (event as InputEventKey).physical_keycode:
		KEY_R:
			restart()
		KEY_N:
			get_tree().change_scene_to_file(other)
		KEY_M:
			sounds.switch()
		KEY_ESCAPE:
			leave("", 0)


func _notification(what: int) -> void:
	if what == NOTIFICATION_WM_CLOSE_REQUEST:
		leave("", 0)
