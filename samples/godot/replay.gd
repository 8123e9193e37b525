## Arguments of the games, and play by a script with pictures.
##
## Arguments after `--`:
##   --script-run         play `_strokes` instead of a hand, then print verdict and hash and leave; with --fixed-fps 60 ahead of `--` as
##                        fast as the machine can, and with the same hash each time
##   --idle               with --script-run: nobody plays
##   --choice=N           another of the game's choices, counted from 0
##   --cells=NXxNY        another grid than the scene's
##   --backend=NAME       cpu, vulkan, cuda or auto
##   --until=SECONDS      with --script-run: leave at this time of the world
##   --view=X,Y,Z,D,YAW,PITCH  the camera: target, distance [m], degrees
##   --pictures=DIR@T,T   with --script-run and a renderer: DIR/SCENE_T.jpg at these times of the world
extends RefCounted

var on := false  # whether a script plays
var idle := false

var _next_scoop := 0.0
var _until := INF
var _pictures := PackedStringArray()  # times still to come
var _picture_folder := ""
var _game: Node3D


func _init(game: Node3D) -> void:
	_game = game
	for argument in OS.get_cmdline_user_args():
		_take(argument)


func _take(argument: String) -> void:
	var value := argument.get_slice("=", 1)
	match argument.get_slice("=", 0):
		"--script-run":
			on = true
		"--idle":
			idle = true
		"--choice":
			_game.choice = clampi(value.to_int(), 0, _game._choices().size() - 1)
		"--cells":
			_game.world.level = _game.world.level.duplicate()
			_game.world.level.cells = Vector2i(value.get_slice("x", 0).to_int(), value.get_slice("x", 1).to_int())
		"--backend":
			_game.world.backend = value
		"--until":
			_until = value.to_float()
		"--view":
			_game.camera.look(value.split_floats(","))
		"--pictures":
			_picture_folder = value.get_slice("@", 0)
			_pictures = value.get_slice("@", 1).split(",")
		_:
			_game.leave("unknown argument " + argument, 2)


## Whether the script is through: the game is over, or the time to leave has come, and nothing is left to do.
func is_done() -> bool:
	return (_game.verdict != _game.Verdict.OPEN or _game.world.get_time() >= _until) and _pictures.is_empty()


## With `wait_for_device` and --fixed-fps a physics step is the same share of the world's time in every run, on any machine.
func advance() -> void:
	_game.world.sync_textures()
	var time: float = _game.world.get_time()
	if not idle:
		_play_strokes(time)
	if not _pictures.is_empty() and time >= _pictures[0].to_float():
		_take_picture(_pictures[0])


func _play_strokes(time: float) -> void:
	if time + 1e-6 < _next_scoop:
		return
	_next_scoop += _game.every
	for stroke: Array in _game._strokes():
		if time >= stroke[0] - 1e-6 and time < stroke[1] - 1e-6:
			_game.use(stroke[2], stroke[3] + stroke[4] * (time - stroke[0]))


func _take_picture(time: String) -> void:
	_game.set_physics_process(false)
	_game.world.running = false
	RenderingServer.render_loop_enabled = true
	_game.spray.fronts.restart()
	for n in 4:
		await _game.get_tree().process_frame
	await RenderingServer.frame_post_draw
	var file := "%s/%s_%s.jpg" % [_picture_folder, _game.name.to_lower(), time]
	if _game.get_viewport().get_texture().get_image().save_jpg(file, 0.88) != OK:
		push_error("cannot write " + file)
	RenderingServer.render_loop_enabled = false
	_game.world.running = true
	_pictures.remove_at(0)
	_game.set_physics_process(true)
