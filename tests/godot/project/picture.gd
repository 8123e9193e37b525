# The castle after the scene of scene.txt as the add-on draws it, beside a stored picture (run.sh writes a new one to FOLDER/picture.png; look at
# it, then store it here). Control: without its water it is another picture. Arguments: FOLDER.
extends SceneTree

const SIZE := Vector2i(480, 270)
const BLOCK := 10 # pixels: what drivers draw otherwise along edges is lost in the mean of so many
# Mean difference of blocks, of 1: foam depends on the time of the frame, and Compatibility lights 4 of 255 darker.
const ALLOWED := {"forward_plus": 0.008, "mobile": 0.008, "gl_compatibility": 0.018}

func drawn(water: bool) -> Image:
	var view := SubViewport.new()
	view.size = SIZE
	view.own_world_3d = true
	view.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	root.add_child(view)
	var terrain := WadiTerrain3D.new()
	terrain.level = Scene.level("castle")
	terrain.backend = "cpu"
	terrain.running = false
	view.add_child(terrain)
	var surface := WadiSurface3D.new()
	surface.draw_water = water
	terrain.add_child(surface)
	terrain.start()
	Scene.run(terrain)
	terrain.sync_textures()
	var extent := terrain.get_extent()
	var camera := Camera3D.new()
	view.add_child(camera)
	camera.look_at_from_position(Vector3(0.02 * extent.x, 0.25 * extent.x, 0.36 * extent.x), Vector3(-0.1 * extent.x, 0, 0))
	var sun := DirectionalLight3D.new()
	view.add_child(sun)
	sun.rotation_degrees = Vector3(-50, 40, 0)
	for n in 4:
		await process_frame
	await RenderingServer.frame_post_draw
	var image := view.get_texture().get_image()
	view.free()
	return image

func difference(one: Image, other: Image) -> float:
	var small := [one.duplicate(), other.duplicate()]
	for image: Image in small:
		image.convert(Image.FORMAT_RGB8)
		image.resize(SIZE.x / BLOCK, SIZE.y / BLOCK, Image.INTERPOLATE_TRILINEAR)
	var bytes: Array = small.map(func(image: Image) -> PackedByteArray: return image.get_data())
	var sum := 0.0
	for n in bytes[0].size():
		sum += absf(bytes[0][n] - bytes[1][n])
	return sum / bytes[0].size() / 255

func _initialize() -> void:
	var check := Check.new()
	var image := await drawn(true)
	image.save_png(Scene.argument(0) + "/picture.png")
	var kept := Image.load_from_file("res://picture.png")
	check.that(kept != null and kept.get_size() == SIZE, "a stored picture of %s pixels" % [SIZE])
	if kept != null:
		var off := difference(image, kept)
		var dry := difference(await drawn(false), kept)
		var allowed: float = ALLOWED[RenderingServer.get_current_rendering_method()]
		print("difference from the stored picture %.4f, without water %.4f" % [off, dry])
		check.that(off <= allowed, "the picture is the stored one: %.4f" % off)
		check.that(dry > off + 0.01 and dry > allowed, "control: without water it is another: %.4f" % dry)
	check.done(self)
