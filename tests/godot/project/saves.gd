# States and command logs give the same hash again; what is broken is refused and changes nothing.
extends SceneTree

func _initialize() -> void:
	var check := Check.new()
	var terrain := Scene.terrain(self, Scene.level("castle"))
	terrain.start()
	check.same(terrain.set_command_log(true), OK, "set_command_log")
	var fresh := terrain.save_state()
	check.that(fresh.size() > 100000, "state has bytes")
	var hashes := Scene.run(terrain)
	var steps := terrain.get_step()
	var commands := terrain.get_commands()
	check.that(commands.size() > 100 and commands.size() < 10000, "log has bytes: %d" % commands.size())
	var state := terrain.save_state()

	# Back to a state, onward to the same hash.
	terrain.step(10)
	var later := terrain.get_hash()
	check.that(later != hashes[-1], "control: ten steps later another hash")
	check.same(terrain.load_state(state), OK, "load_state")
	check.same(terrain.get_hash(), hashes[-1], "hash after loading")
	check.same(terrain.get_step(), steps, "step after loading")
	terrain.step(10)
	check.same(terrain.get_hash(), later, "hash ten steps after loading")

	# What is published after loading is of that state, also where a publish had the same step.
	var heights: Array[PackedFloat32Array] = []
	for raised in [false, true, false]:
		terrain.load_state(state)
		if raised:
			terrain.brush(WadiTerrain3D.LAYER_SAND, Vector3.ZERO, 1.0, 0.5)
		terrain.step(1)
		terrain.sync_textures()
		heights.append(terrain.get_heights(Rect2i(Vector2i.ZERO, terrain.get_cells())))
	check.that(heights[1] != heights[0], "control: a brush changes the heights")
	check.that(heights[2] == heights[0], "heights after loading, at a step that was published before")
	terrain.load_state(state)

	# Without waiting.
	check.same(terrain.begin_save(), OK, "begin_save")
	check.same(terrain.begin_save(), ERR_BUSY, "a second begin_save")
	var saved := PackedByteArray()
	for n in 2000:
		saved = terrain.end_save()
		if not saved.is_empty():
			break
		OS.delay_usec(500)
	check.that(saved == terrain.save_state(), "end_save gives what save_state does")
	check.that(terrain.end_save().is_empty(), "end_save without a save")

	# The log in another world; without it another hash.
	for played in [true, false]:
		var other := Scene.terrain(self, Scene.level("castle"))
		other.start()
		if played:
			check.same(other.play_commands(commands), OK, "play_commands")
		other.step(steps)
		check.that((other.get_hash() == hashes[-1]) == played, "hash of %d steps %s the log" % [steps, "with" if played else "without"])
		other.free()
	check.same(terrain.load_state(fresh), OK, "load the first state")
	Scene.run(terrain)
	check.same(terrain.get_hash(), hashes[-1], "hash of the scene from the first state")

	# Broken bytes.
	for at in [0, 40, state.size() / 2, state.size() - 1]:
		var broken := state.duplicate()
		broken[at] ^= 1
		check.that(terrain.load_state(broken) != OK, "a state with byte %d changed is refused" % at)
	check.that(terrain.load_state(state.slice(0, state.size() - 1)) != OK, "a cut state is refused")
	check.that(terrain.load_state(PackedByteArray()) != OK, "an empty state is refused")
	check.that(terrain.play_commands(state) != OK, "a state is no log")
	check.same(terrain.get_hash(), hashes[-1], "hash after refusals")
	var wrong := Scene.terrain(self, Scene.level("dam_break"))
	wrong.start()
	check.that(wrong.load_state(state) != OK and "cells" in wrong.get_last_message(), "a state of another level is refused")
	check.done(self)
