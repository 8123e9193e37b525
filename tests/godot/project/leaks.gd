# Memory and objects stay level over steps and over worlds made and ended. Arguments: FOLDER BACKEND CYCLES STEPS [share].
extends SceneTree

# The process keeps some of what was freed, so that its size tells megabytes; the engine's own count is exact.
const ALLOWED := 4 << 20
const ENGINE_ALLOWED := 64 << 10

# Bytes of memory that the process has.
func resident() -> int:
	return int(FileAccess.open("/proc/self/statm", FileAccess.READ).get_line().split(" ")[1]) * 4096

# Bytes that the engine itself has allocated: variants, arrays, images.
func engine_bytes() -> int:
	return int(Performance.get_monitor(Performance.MEMORY_STATIC))

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
	var static_bytes := engine_bytes()
	var things := objects()
	for n in cycles:
		await cycle()
	print("%d cycles: %d KiB, the engine's %d KiB, %d objects" % [cycles, (resident() - bytes) / 1024, (engine_bytes() - static_bytes) / 1024, objects() - things])
	check.same(grows("memory", bytes, resident(), ALLOWED), "", "%d worlds" % cycles)
	check.same(grows("engine's memory", static_bytes, engine_bytes(), ENGINE_ALLOWED), "", "%d worlds" % cycles)
	check.same(grows("objects", things, objects(), 0), "", "%d worlds" % cycles)

	var terrain := Scene.terrain(self, Scene.pool(1), Scene.argument(1))
	terrain.share_device = OS.get_cmdline_user_args().size() > 4
	terrain.start()
	var steps := int(Scene.argument(3))
	for round in 2:
		bytes = resident()
		static_bytes = engine_bytes()
		things = objects()
		for n in steps / 4:
			terrain.brush(WadiTerrain3D.LAYER_WATER, Vector3(n % 5, 0, 0), 1, 0.01)
			terrain.step(2)
			terrain.sync_textures()
			terrain.get_dirty_regions(-1)
			terrain.get_query(terrain.query(PackedVector2Array([Vector2.ZERO])))
	print("%d steps: %d KiB, the engine's %d KiB, %d objects" % [steps / 2, (resident() - bytes) / 1024, (engine_bytes() - static_bytes) / 1024, objects() - things])
	check.same(grows("memory", bytes, resident(), ALLOWED), "", "%d steps" % (steps / 2))
	check.same(grows("engine's memory", static_bytes, engine_bytes(), ENGINE_ALLOWED), "", "%d steps" % (steps / 2))
	check.same(grows("objects", things, objects(), 0), "", "%d steps" % (steps / 2))

	# Controls: what is kept is seen.
	bytes = resident()
	static_bytes = engine_bytes()
	things = objects()
	var kept: Array[PackedByteArray] = []
	var images: Array[Image] = []
	kept.append(terrain.save_state())
	images.append(Image.create_empty(256, 256, false, Image.FORMAT_RF))
	check.that(grows("engine's memory", static_bytes, engine_bytes(), ENGINE_ALLOWED) != "", "control: one kept state and image are seen")
	check.that(grows("objects", things, objects(), 0) != "", "control: one kept image is seen")
	while kept.size() * kept[0].size() < 16 * ALLOWED:
		kept.append(terrain.save_state())
	check.that(grows("memory", bytes, resident(), ALLOWED) != "", "control: %d kept states are seen" % kept.size())
	check.done(self)
