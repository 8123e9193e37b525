# The castle, shared with the renderer where that can be, drawn for a while; Compatibility has no device to share and says so
# (run.sh looks for the words). Arguments: what is expected, "shared" or "copied".
extends SceneTree

const FRAMES := 60

func _initialize() -> void:
	var check := Check.new()
	root.size = Vector2i(320, 180)
	var terrain := WadiTerrain3D.new()
	terrain.level = Scene.level("castle")
	terrain.level.cells = Vector2i(64, 32)
	terrain.share_device = true
	root.add_child(terrain)
	var surface := WadiSurface3D.new()
	surface.apron = 20
	terrain.add_child(surface)
	check.same(terrain.start(), OK, "start")
	var extent := terrain.get_extent()
	var camera := Camera3D.new()
	root.add_child(camera)
	camera.look_at_from_position(Vector3(0, 0.3 * extent.x, 0.4 * extent.x), Vector3.ZERO)
	var sun := DirectionalLight3D.new()
	sun.shadow_enabled = true
	sun.directional_shadow_mode = DirectionalLight3D.SHADOW_ORTHOGONAL
	root.add_child(sun)
	sun.rotation_degrees = Vector3(-50, 40, 0)
	for n in FRAMES:
		await process_frame
	var texture := terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED)
	check.same("shared" if texture is Texture2DRD else "copied", Scene.argument(0), "way of textures")
	check.that(terrain.get_step() > 0, "runs: %d steps" % terrain.get_step())
	terrain.free()
	check.done(self)
