# What a tick costs by each way of textures: a step of the castle, and outputs PACKED, SAND_DEPTH and FLOW in textures that the engine may
# draw. Prints a table; checks that every way went the same way. Arguments: FOLDER.
extends SceneTree

const TICKS := 120
const DRAWN := 1 << WadiTerrain3D.OUTPUT_PACKED | 1 << WadiTerrain3D.OUTPUT_SAND_DEPTH | 1 << WadiTerrain3D.OUTPUT_FLOW

# [median, largest ms of a tick, hash]
func measured(backend: String, share: bool, outputs: int) -> Array:
	var terrain := Scene.terrain(self, Scene.level("castle"), backend)
	terrain.share_device = share
	terrain.outputs = outputs
	terrain.start()
	var times: Array[float] = []
	for n in TICKS + 10:
		await process_frame
		var begin := Time.get_ticks_usec()
		terrain.step(1)
		terrain.sync_textures()
		if n >= 10: # the first ones allocate
			times.append((Time.get_ticks_usec() - begin) / 1000.0)
	var hash := terrain.get_hash()
	terrain.free()
	times.sort()
	return [times[TICKS / 2], times[-1], hash]

func _initialize() -> void:
	var check := Check.new()
	print("| way | ms a tick, median | largest |\n| --- | ---: | ---: |")
	var ways := {"CPU, no textures": ["cpu", false, 0], "CPU, through host memory": ["cpu", false, DRAWN], "Vulkan, no textures": ["vulkan", false, 0],
			"Vulkan, through host memory": ["vulkan", false, DRAWN], "Vulkan, share_device": ["vulkan", true, DRAWN]}
	var hashes := {}
	for way in ways:
		var found: Array = await callv("measured", ways[way])
		print("| %s | %.2f | %.2f |" % [way, found[0], found[1]])
		hashes[found[2]] = way
		check.that(found[0] > 0, way)
	check.that(hashes.size() == 1, "one hash: %s" % [hashes])
	check.done(self)
