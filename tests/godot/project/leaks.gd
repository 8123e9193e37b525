# Memory and objects stay level over steps and over worlds made and ended. Arguments: FOLDER BACKEND CYCLES STEPS [share].
extends SceneTree

const ALLOWED := 4 << 20

# Bytes of memory that the process has.
func resident() -> int:
	return int(FileAccess.open("/proc/self/statm", FileAccess.READ).get_line().split(" ")[1]) * 4096

func objects() -> int:
	return int(Performance.get_monitor(Performance.OBJECT_COUNT))

func cycle() -> void:
	var terrain := Scene.terrain(self, Scene.pool(1), Scene.argument(1))
	terrain.share_device = OS.get_cmdline_user_args().size() > 4
	terrain.start()
	terrain.brush(WadiTerrain3D.LAYER_SAND, Vector3.ZERO, 1, 0.25)
	terrain.step(4)
	terrain.sync_textures()
	terrain.get_query(terrain.query(PackedVector2Array([Vector2.ZERO])))
	terrain.get_heights(Rect2i(0, 0, 4, 4))
	terrain.get_stats()
	terrain.get_material()
	terrain.get_dirty_regions(-1)
	terrain.save_state()
	terrain.begin_save() # and never ended
	terrain.running = true
	await physics_frame
	terrain.free()

func grows(what: String, before: int, after: int, allowed: int) -> String:
	return "" if after - before <= allowed else "%s grew by %d" % [what, after - before]

func _initialize() -> void:
	var check := Check.new()
	var cycles := int(Scene.argument(2))
	for n in 20:
		await cycle()
	var bytes := resident()
	var things := objects()
	for n in cycles:
		await cycle()
	print("%d cycles: %d KiB, %d objects" % [cycles, (resident() - bytes) / 1024, objects() - things])
	check.same(grows("memory", bytes, resident(), ALLOWED), "", "%d worlds" % cycles)
	check.same(grows("objects", things, objects(), 0), "", "%d worlds" % cycles)

	var terrain := Scene.terrain(self, Scene.pool(1), Scene.argument(1))
	terrain.share_device = OS.get_cmdline_user_args().size() > 4
	terrain.start()
	var steps := int(Scene.argument(3))
	for round in 2:
		bytes = resident()
		things = objects()
		for n in steps / 4:
			terrain.brush(WadiTerrain3D.LAYER_WATER, Vector3(n % 5, 0, 0), 1, 0.01)
			terrain.step(2)
			terrain.sync_textures()
			terrain.get_dirty_regions(-1)
			terrain.get_query(terrain.query(PackedVector2Array([Vector2.ZERO])))
	print("%d steps: %d KiB, %d objects" % [steps / 2, (resident() - bytes) / 1024, objects() - things])
	check.same(grows("memory", bytes, resident(), ALLOWED), "", "%d steps" % (steps / 2))
	check.same(grows("objects", things, objects(), 0), "", "%d steps" % (steps / 2))

	# Controls: what is kept is seen.
	bytes = resident()
	things = objects()
	var kept: Array[PackedByteArray] = []
	var images: Array[Image] = []
	while kept.is_empty() or kept.size() * kept[0].size() < 2 * ALLOWED:
		kept.append(terrain.save_state())
		images.append(Image.create_empty(4, 4, false, Image.FORMAT_RF))
	check.that(grows("memory", bytes, resident(), ALLOWED) != "", "control: %d kept states are seen" % kept.size())
	check.that(grows("objects", things, objects(), 0) != "", "control: %d kept images are seen" % images.size())
	check.done(self)
