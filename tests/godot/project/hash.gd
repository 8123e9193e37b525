# Hashes, heights and textures of a terrain in Godot are those of the C host, in every bit. Arguments: FOLDER BACKEND.
extends SceneTree

func _initialize() -> void:
	var check := Check.new()
	var terrain := Scene.terrain(self, Scene.level("castle"), Scene.argument(1))
	terrain.outputs = (1 << (WadiTerrain3D.OUTPUT_PACKED_HALF + 1)) - 1
	check.same(terrain.start(), OK, "start")
	check.same(terrain.get_stats()["backend"], Scene.argument(1), "backend")
	var hashes := Scene.run(terrain)
	check.same(hashes, Scene.host_hashes(), "hashes")
	check.same(terrain.sync_textures(), OK, "sync_textures")
	var outputs := 0 if DisplayServer.get_name() == "headless" else WadiTerrain3D.OUTPUT_PACKED_HALF + 1
	for output in outputs: # without a display the engine keeps no updates of textures
		var bytes := terrain.get_texture(output).get_image().get_data()
		check.that(bytes == Scene.host_bytes("output_%d.bin" % output), "texture of output %d is the host's copy" % output)
	var cells := terrain.get_cells()
	var whole := Rect2i(Vector2i.ZERO, cells)
	var expected := Scene.host_bytes("heights.bin").to_float32_array()
	for way in ["read from the device", "copied by updates"]: # the second call finds the copy that the first one asked for
		check.that(terrain.get_heights(whole) == expected, "heights, %s" % way)
		terrain.sync_textures()
	var part := Rect2i(17, 40, 3, 2) # its northern row is that of cells with y = 41
	var rows := PackedFloat32Array()
	for y in [41, 40]:
		var from: int = (cells.y - 1 - y) * cells.x + 17
		rows.append_array(expected.slice(from, from + 3))
	check.same(terrain.get_heights(part), rows, "heights of a region")
	var bounds := terrain.get_bounds(whole)
	var lowest := Array(expected).min() as float
	check.same(bounds.x, lowest, "lowest solid surface")
	var surface := Scene.host_bytes("output_%d.bin" % WadiTerrain3D.OUTPUT_SURFACE).to_float32_array()
	check.same(bounds.y, Array(surface).max() as float, "highest visible surface")
	check.same(terrain.get_bounds(Rect2i(-9, -9, 2, 2)), Vector2.ZERO, "bounds outside the grid")

	# Controls: another edit and another moment are told apart.
	terrain.step(1)
	terrain.sync_textures()
	var later := terrain.get_texture(WadiTerrain3D.OUTPUT_PACKED).get_image().get_data()
	check.that(outputs == 0 or later != Scene.host_bytes("output_%d.bin" % WadiTerrain3D.OUTPUT_PACKED), "control: a step later textures differ")
	var other := Scene.terrain(self, Scene.level("castle"), Scene.argument(1))
	other.start()
	var last: String = Scene.run(other, 1.0625)[-1]
	check.that(last != hashes[-1], "control: other amounts give another hash")
	check.done(self)
