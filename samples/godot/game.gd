## What both scenes have in common: the world, a camera, a hand with a tool, the words on the screen, and play from a script.
##
## Arguments after `--`:
##   --script-run         play `_strokes` instead of a hand, then print verdict and hash and leave; with --fixed-fps 60 ahead of `--` as
##                        fast as the machine can, and with the same hash each time
##   --idle               with --script-run: nobody plays
##   --cells=NXxNY        another grid than the scene's
##   --backend=NAME       cpu, vulkan, cuda or auto
##   --until=SECONDS      with --script-run: leave at this time of the world
##   --view=X,Y,Z,D,YAW,PITCH  the camera: target, distance [m], degrees
##   --pictures=DIR@T,T   with --script-run and a renderer: DIR/SCENE_T.jpg at these times of the world
extends Node3D

enum Verdict { OPEN, WON, LOST }

## Seconds of the world that a game lasts.
@export var duration := 52.0
## Words at the top.
@export_multiline var task := ""
## Sand that a scoop digs or builds at the middle of the tool, and water that is built with it: dry sand flows apart [m].
@export var scoop := 0.08
@export var damp := 0.018
## Seconds between scoops.
@export var every := 1.0 / 15
## Scoops in the bucket at the start, and the most that it holds: what is built was dug before.
@export var bucket := 20
@export var bucket_size := 160

@onready var world: WadiTerrain3D = $World
@onready var camera := $Camera
@onready var words: Label = $Words

var verdict := Verdict.OPEN
var scripted := false
var idle := false

var _waited := 0.0
var _next_scoop := 0.0
var _until := INF
var _pictures := PackedStringArray()  # times still to come
var _picture_folder := ""
var _answers := {}  # ticket of a query: what takes the answer


func _ready() -> void:
	for argument in OS.get_cmdline_user_args():
		_take(argument)
	if scripted:
		camera.set_process(false)
		camera.set_physics_process(false)
		camera.set_process_unhandled_input(false)
		world.wait_for_device = true
		world.time_dropped.connect(func(seconds: float) -> void: _leave("%f s dropped" % seconds, 1))
	else:
		world.time_dropped.connect(func(seconds: float) -> void: $Late.text = "%.0f ms late" % (1000 * seconds))
	if RenderingServer.get_current_rendering_method() == "gl_compatibility":
		$Sun.shadow_enabled = false  # there a light with shadows is added behind tone mapping, and the sum is too bright
	world.device_lost.connect(func(message: String) -> void: _leave("device lost: " + message, 1))
	# The scenes keep `running` off, so that arguments count before the world is made.
	if world.start() != OK:
		_leave(world.get_last_message(), 2)
		return
	world.running = true
	if scripted:
		# Nothing is drawn until a picture is due.
		RenderingServer.render_loop_enabled = false
	camera.used.connect(_on_hand_used)
	_begin()


func _take(argument: String) -> void:
	var value := argument.get_slice("=", 1)
	match argument.get_slice("=", 0):
		"--script-run":
			scripted = true
		"--idle":
			idle = true
		"--cells":
			world.level = world.level.duplicate()
			world.level.cells = Vector2i(value.get_slice("x", 0).to_int(), value.get_slice("x", 1).to_int())
		"--backend":
			world.backend = value
		"--until":
			_until = value.to_float()
		"--view":
			camera.look(value.split_floats(","))
		"--pictures":
			_picture_folder = value.get_slice("@", 0)
			_pictures = value.get_slice("@", 1).split(",")
		_:
			_leave("unknown argument " + argument, 2)


func _leave(message: String, code: int) -> void:
	if code != 0:
		push_error(message)
	print(message)
	set_physics_process(false)
	get_tree().quit(code)


## The game's own: once, when the world stands.
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


func _physics_process(_delta: float) -> void:
	if scripted:
		_advance_script()
	for ticket: int in _answers.keys():
		var answer: Array = world.get_query(ticket)
		if not answer.is_empty():
			_answers[ticket].call(answer)
			_answers.erase(ticket)
	if verdict == Verdict.OPEN:
		_judge(world.get_time())
	words.text = "%s\n%4.1f of %.0f s   %s%s" % [task, world.get_time(), duration, _score(), _verdict_words()]
	var over := verdict != Verdict.OPEN or world.get_time() >= _until
	if scripted and over and _answers.is_empty() and _pictures.is_empty():
		_leave("%s %s %s\nverdict %s at %.2f s, %s\nhash %s after %d steps" % [name, world.get_cells(), "idle" if idle else "played",
				Verdict.find_key(verdict), world.get_time(), _score(), world.get_hash(), world.get_step()], 0)


## With `wait_for_device` and --fixed-fps a physics step is the same share of the world's time in every run, on any machine.
func _advance_script() -> void:
	world.sync_textures()
	if not idle:
		_play_strokes(world.get_time())
	if not _pictures.is_empty() and world.get_time() >= _pictures[0].to_float():
		_take_picture(_pictures[0])


func _play_strokes(time: float) -> void:
	if time + 1e-6 < _next_scoop:
		return
	_next_scoop += every
	for stroke: Array in _strokes():
		if time >= stroke[0] - 1e-6 and time < stroke[1] - 1e-6:
			_use(stroke[2], stroke[3] + stroke[4] * (time - stroke[0]))


func _on_hand_used(tool: int, place: Vector3, delta: float) -> void:
	_waited += delta
	if _waited >= every:
		_waited = 0
		var local := world.to_local(place)
		_use(tool, Vector2(local.x, local.z))


## One scoop at x, z in the world's space.
func _use(tool: int, place: Vector2) -> void:
	var at := Vector3(place.x, 0, place.y)
	if verdict != Verdict.OPEN:
		return
	if tool == camera.DIG and bucket < bucket_size:
		bucket += 1
		world.brush(WadiTerrain3D.LAYER_SAND, at, camera.radius, -scoop)
	elif tool == camera.BUILD and bucket > 0:
		bucket -= 1
		world.brush(WadiTerrain3D.LAYER_SAND, at, camera.radius, scoop)
		world.brush(WadiTerrain3D.LAYER_WATER, at, camera.radius, damp)


func _take_picture(time: String) -> void:
	set_physics_process(false)
	world.running = false
	RenderingServer.render_loop_enabled = true
	for n in 4:
		await get_tree().process_frame
	await RenderingServer.frame_post_draw
	var file := "%s/%s_%s.jpg" % [_picture_folder, name.to_lower(), time]
	if get_viewport().get_texture().get_image().save_jpg(file, 0.88) != OK:
		push_error("cannot write " + file)
	RenderingServer.render_loop_enabled = false
	world.running = true
	_pictures.remove_at(0)
	set_physics_process(true)


## Asks the world about points (x, z in its space); `then` gets the answers some frames later.
func ask(points: PackedVector2Array, then: Callable) -> void:
	var ticket := world.query(points)
	if ticket > 0:
		_answers[ticket] = then


func _verdict_words() -> String:
	match verdict:
		Verdict.WON:
			return "\nWon!  R plays again, N goes to the other scene."
		Verdict.LOST:
			return "\nLost.  R plays again, N goes to the other scene."
	return ""


func _unhandled_key_input(event: InputEvent) -> void:
	if scripted or not event.is_pressed():
		return
	match (event as InputEventKey).physical_keycode:
		KEY_R:
			get_tree().reload_current_scene()
		KEY_N:
			get_tree().change_scene_to_file("res://canyon.tscn" if name == "Beach" else "res://beach.tscn")
		KEY_ESCAPE:
			get_tree().quit()
