# Physics ticks advance the world by their time, whatever it was stepped by besides; time that is dropped is told. --fixed-fps 60.
extends SceneTree

# Counts the ticks that its parent has had.
class Ticks extends Node:
	var count := 0
	func _physics_process(_delta: float) -> void:
		count += 1

func ticks(terrain: WadiTerrain3D) -> Ticks:
	var node := Ticks.new()
	terrain.add_child(node)
	return node

func pass_ticks(count: int) -> void:
	for n in count:
		await physics_frame

func _initialize() -> void:
	var check := Check.new()
	await physics_frame
	var terrain := Scene.terrain(self, Scene.level("castle"))
	terrain.wait_for_device = true
	terrain.start()
	var dt: float = terrain.get_stats()["dt"]
	var counter := ticks(terrain)
	var dropped := [0.0]
	terrain.time_dropped.connect(func(seconds: float) -> void: dropped[0] += seconds)
	var regions := [0]
	terrain.world_changed.connect(func(changed: Array[Rect2i]) -> void: regions[0] += changed.size())

	await pass_ticks(5)
	check.same(terrain.get_step(), 0, "steps while it does not run")
	counter.count = 0
	terrain.running = true
	await pass_ticks(50)
	var expected := floori(counter.count / 60.0 / dt)
	check.that(counter.count > 40, "ticks came")
	check.same(terrain.get_step(), expected, "steps after %d ticks" % counter.count)
	check.same(dropped[0], 0.0, "nothing dropped with wait_for_device")
	check.that(regions[0] > 0, "world_changed told what changed")
	terrain.running = false
	var reference := Scene.terrain(self, Scene.level("castle"))
	reference.start()
	reference.step(expected)
	check.same(terrain.get_hash(), reference.get_hash(), "hash after ticks and after as many steps")

	# Half as fast.
	terrain.time_scale = 0.5
	terrain.running = true
	counter.count = 0
	var before := terrain.get_time()
	await pass_ticks(60)
	check.that(absf(terrain.get_time() - before - counter.count / 120.0) <= dt, "time_scale 0.5 gives half the time")

	# One step a tick at most: the rest is dropped, and told.
	terrain.time_scale = 1
	terrain.max_steps_per_frame = 1
	counter.count = 0
	before = terrain.get_time()
	await pass_ticks(30)
	terrain.running = false
	await pass_ticks(2)
	var ran := terrain.get_time() - before
	check.that(absf(ran - 30 * dt) <= dt, "one step per tick: %f s" % ran)
	check.that(dropped[0] > 0.1 and absf(dropped[0] + ran - 30 / 60.0) <= 2 / 60.0, "dropped %f s + ran %f s = 0.5 s" % [dropped[0], ran])

	# What changed. With wait_for_device the regions are those of the newest tick.
	check.that(terrain.get_dirty_regions(-1).size() > 0, "regions that ever changed")
	check.same(terrain.get_dirty_step(), terrain.get_step(), "the step that regions are of")
	check.same(terrain.get_dirty_regions(terrain.get_dirty_step()).size(), 0, "regions since then")
	check.done(self)
