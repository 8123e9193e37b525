# Beside a scene that somebody else wrote (an autoload of first_minutes.sh): says when its water moves on the screen, keeps a picture, leaves.
# Arguments: PICTURE SECONDS; after so many seconds it gives up.
extends Node

const MOVED := 0.02 # depth that makes a cell another [m]
const CELLS := 50
const LATER := 0.6 # seconds of the world until the picture

var _terrain: WadiTerrain3D
var _first := PackedFloat32Array()
var _drawn: Image

func _ready() -> void:
	var deadline := Time.get_ticks_msec() + 1000 * OS.get_cmdline_user_args()[1].to_int()
	while not await _moves():
		if Time.get_ticks_msec() > deadline:
			_leave("the water stands", 1)
			return
	print("water moves at %.1f" % Time.get_unix_time_from_system())
	while _terrain.get_time() < LATER:
		await RenderingServer.frame_post_draw
	var picture := get_viewport().get_texture().get_image()
	picture.save_png(OS.get_cmdline_user_args()[0])
	var top := picture.get_region(Rect2i(0, 0, picture.get_width(), 8))
	top.resize(1, 1, Image.INTERPOLATE_TRILINEAR)
	var sky := top.get_pixel(0, 0)
	print("top of the picture: %s" % sky)
	_leave("", 0 if sky.b > sky.r + 0.1 else 2)

# Whether cells have another depth than at first, and the screen another picture.
func _moves() -> bool:
	await RenderingServer.frame_post_draw
	var screen := get_viewport().get_texture().get_image()
	if _terrain == null or not _terrain.is_started():
		for node: WadiTerrain3D in get_tree().root.find_children("*", "WadiTerrain3D", true, false):
			_terrain = node
		return false
	var texels := _terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED).get_image().get_data().to_float32_array()
	if _first.is_empty():
		_first = texels
		_drawn = screen
	var other := 0
	for n in range(1, texels.size(), 4):
		other += int(absf(texels[n] - _first[n]) > MOVED)
	return other > CELLS and screen.get_data() != _drawn.get_data()

func _leave(why: String, status: int) -> void:
	print(why)
	get_tree().quit(status)
