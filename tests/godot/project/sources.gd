# A source brings its discharge times the time that the terrain ran, wherever it stands, and takes as much with a negative one; a terrain
# that does not run gets nothing. --fixed-fps 60.
extends SceneTree

func pass_ticks(count: int) -> void:
	for n in count:
		await physics_frame

func _initialize() -> void:
	var check := Check.new()
	await physics_frame
	for softness: float in [0.0, 0.5, 1.0]:
		var terrain := Scene.terrain(self, Scene.pool(1))
		terrain.position = Vector3(3, 1, -2)
		terrain.rotation_degrees = Vector3(0, 30, 0)
		terrain.wait_for_device = true
		terrain.start()
		var source := WadiSource3D.new()
		source.softness = softness
		source.discharge = 0.6
		source.position = Vector3(1, 0, 0.5)
		terrain.add_child(source)
		await pass_ticks(10)
		check.same(terrain.get_stats()["water_in"], 0.0, "while it does not run")
		terrain.running = true
		await pass_ticks(121)
		terrain.running = false
		var stats := terrain.get_stats()
		var poured: float = stats["water_in"] / stats["time"]
		check.that(absf(poured / 0.6 - 1) < 0.03, "softness %.1f: %.4f m3/s" % [softness, poured])
		check.same(stats["water_drift_quanta"], 0, "drift")
		source.discharge = -0.6
		terrain.running = true
		await pass_ticks(60)
		terrain.running = false
		var taken: float = terrain.get_stats()["water_out"]
		check.that(absf(taken / 0.6 - 1) < 0.06, "softness %.1f: took %.4f m3 in a second" % [softness, taken])
		terrain.free()

	# Control: with the mean of another softness another volume arrives.
	var wrong := Scene.terrain(self, Scene.pool(1))
	wrong.start()
	wrong.brush(WadiTerrain3D.LAYER_WATER, Vector3.ZERO, 1, 0.5 / (PI * WadiSource3D.mean_weight(0.0)), 1)
	wrong.step(1)
	var arrived: float = wrong.get_stats()["water_in"]
	check.that(absf(arrived / 0.5 - 1) > 0.5, "control: %.3f m3 of 0.5" % arrived)
	wrong.free()
	check.done(self)
