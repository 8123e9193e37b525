# Bad input gives an error and a message that says what is wrong, changes nothing and ends nothing.
extends SceneTree

var check := Check.new()
var terrain: WadiTerrain3D

func refused(error: Variant, words: Array, what: String) -> void:
	var message := terrain.get_last_message()
	check.that(not (error is int and error == OK), what + ": is refused")
	for word: String in words:
		check.that(word in message, "%s: \"%s\" says \"%s\"" % [what, message, word])

func refused_level(change: Dictionary, words: Array, expected: Error) -> void:
	var level := WadiLevel.new()
	for key: String in change:
		level.set(key, change[key])
	terrain.level = level
	var error := terrain.start()
	check.same(error, expected, "start with %s" % change)
	refused(error, ["start: "] + words, "start with %s" % change)
	check.same(terrain.is_started(), false, "started with %s" % change)

func text_file(name: String, text: String) -> String:
	var path := "user://" + name
	FileAccess.open(path, FileAccess.WRITE).store_string(text)
	return path

func before_start() -> void:
	refused(terrain.start(), ["level"], "start without a level")
	refused(terrain.step(1), ["step", "start()"], "step")
	refused(terrain.brush(WadiTerrain3D.LAYER_WATER, Vector3.ZERO, 1, 1), ["brush"], "brush")
	refused(terrain.open_source(WadiTerrain3D.LAYER_WATER, Vector3.ZERO, 1, 1), ["open_source"], "open_source")
	refused(terrain.set_source(0, WadiTerrain3D.LAYER_WATER, Vector3.ZERO, 1, 1), ["set_source"], "set_source")
	refused(terrain.close_source(0), ["close_source"], "close_source")
	refused(terrain.set_material("friction", 1), ["set_material"], "set_material")
	refused(terrain.load_state(PackedByteArray([1])), ["load_state"], "load_state")
	refused(terrain.sync_textures(), ["sync_textures"], "sync_textures")
	check.that(terrain.get_texture(WadiTerrain3D.OUTPUT_SURFACE) == null, "texture")
	check.same(terrain.query(PackedVector2Array([Vector2.ZERO])), 0, "query")
	check.same(terrain.get_query(1).size(), 0, "get_query")
	check.same(terrain.get_heights(Rect2i(0, 0, 1, 1)).size(), 0, "heights")
	check.same(terrain.get_dirty_regions(-1).size(), 0, "regions")
	check.same(terrain.save_state().size(), 0, "save_state")
	check.same([terrain.get_hash(), terrain.get_step(), terrain.get_time(), terrain.get_cells()], ["", 0, 0.0, Vector2i.ZERO], "no world")
	terrain.stop()

func levels() -> void:
	refused_level({}, ["file"], ERR_INVALID_PARAMETER)
	refused_level({"file": "res://nowhere/level.json"}, ["res://nowhere/level.json"], ERR_FILE_NOT_FOUND)
	refused_level({"file": "res://nowhere/map.png"}, ["map.png"], ERR_FILE_NOT_FOUND)
	refused_level({"file": text_file("broken.json", "{ \"format_version\": 1, ")}, [], ERR_FILE_CORRUPT)
	refused_level({"file": text_file("empty.json", "")}, [], ERR_FILE_CORRUPT)
	var grid := "{ \"format_version\": 1, \"name\": \"x\", \"grid\": { \"nx\": 8, \"ny\": 8, \"dx\": 1 }, \"dt\": 0.01 %s }"
	refused_level({"file": text_file("key.json", grid % ", \"watr\": []")}, ["watr", "water"], ERR_FILE_CORRUPT)
	refused_level({"file": text_file("map.json", grid % ", \"terrain\": [{ \"file\": \"none.png\", \"min\": 0, \"max\": 1 }]")}, ["none.png"], ERR_FILE_NOT_FOUND)
	refused_level({"file": "res://levels/castle/level.json", "variant": "none"}, ["none"], ERR_INVALID_PARAMETER)
	refused_level({"file": "res://levels/castle/level.json", "method": "best"}, ["best"], ERR_INVALID_PARAMETER)
	refused_level({"file": "res://levels/castle/level.json", "cells": Vector2i(-4, 4)}, ["-4"], ERR_INVALID_PARAMETER)
	refused_level({"settings": grid % ""}, ["cells"], ERR_INVALID_PARAMETER)
	refused_level({"settings": grid % "", "cells": Vector2i(8, 8), "water": PackedFloat32Array([1, 2])}, ["water", "2", "64"], ERR_INVALID_PARAMETER)
	refused_level({"settings": grid % "", "cells": Vector2i(4, 4)}, ["4"], ERR_INVALID_PARAMETER)
	var values := PackedFloat32Array()
	values.resize(64)
	values[9] = NAN
	refused_level({"settings": grid % "", "cells": Vector2i(8, 8), "water": values}, [], ERR_INVALID_PARAMETER)

func properties() -> void:
	terrain.level = Scene.level("castle")
	for bad: Array in [["backend", "gpu9"], ["threads", -1], ["max_steps_per_frame", 0], ["time_scale", NAN], ["time_scale", -1.0], ["outputs", 1 << 20]]:
		var good: Variant = terrain.get(bad[0])
		terrain.set(bad[0], bad[1])
		refused(terrain.start(), [bad[0] if bad[0] != "backend" else "gpu9"], "%s = %s" % bad)
		check.same(terrain.is_started(), false, "started with %s = %s" % bad)
		terrain.set(bad[0], good)

func calls() -> void:
	check.same(terrain.start(), OK, "start")
	check.same(terrain.start(), ERR_ALREADY_IN_USE, "a second start")
	terrain.step(3)
	var hash := terrain.get_hash()
	var water := WadiTerrain3D.LAYER_WATER
	refused(terrain.brush(water, Vector3(NAN, 0, 0), 1, 1), ["brush", "x0"], "NaN place")
	refused(terrain.brush(water, Vector3(0, 0, INF), 1, 1), ["brush", "y0"], "infinite place")
	refused(terrain.brush(water, Vector3.ZERO, NAN, 1), ["radius"], "NaN radius")
	refused(terrain.brush(water, Vector3.ZERO, -1, 1), ["radius"], "negative radius")
	refused(terrain.brush(water, Vector3.ZERO, 1, NAN), ["amount"], "NaN amount")
	refused(terrain.brush(water, Vector3.ZERO, 1, 1, 2), ["softness"], "softness 2")
	refused(terrain.brush(7, Vector3.ZERO, 1, 1), ["layer", "7"], "layer 7")
	refused(terrain.brush_line(water, Vector3.ZERO, Vector3(NAN, 0, 0), 1, 1), ["brush_line", "x1"], "NaN end")
	refused(terrain.push(Vector3.ZERO, 1, Vector3(NAN, 0, 0)), ["push", "velocity"], "NaN velocity")
	refused(terrain.push(Vector3.ZERO, 1, Vector3.ZERO, 2), ["strength"], "strength 2")
	check.same(terrain.open_source(WadiTerrain3D.LAYER_TERRAIN, Vector3.ZERO, 1, 1), -1, "a source of rock")
	refused(1, ["open_source", "layer", "0"], "a source of rock")
	for bad: Array in [[Vector3(NAN, 0, 0), 1.0, 1.0, "center[0]"], [Vector3(0, 0, INF), 1.0, 1.0, "center[1]"], [Vector3.ZERO, 0.0, 1.0, "radius"], [Vector3.ZERO, NAN, 1.0, "radius"], [Vector3.ZERO, 1.0, NAN, "discharge"], [Vector3.ZERO, 1.0, 2e9, "discharge"]]:
		check.same(terrain.open_source(water, bad[0], bad[1], bad[2]), -1, "source %s" % [bad])
		refused(1, ["open_source", bad[3]], "source %s" % [bad])
	for index: int in [-1, 32, 1 << 40]:
		refused(terrain.set_source(index, water, Vector3.ZERO, 1, 1), ["set_source", "index", str(index)], "set_source %d" % index)
		refused(terrain.close_source(index), ["close_source", "index", str(index)], "close_source %d" % index)
	refused(terrain.close_source(0), ["close_source", "index", "0"], "close_source of none")
	refused(terrain.step(-1), ["step", "-1"], "step -1")
	refused(terrain.set_material("frction", 1), ["frction"], "unknown material")
	refused(terrain.set_material("friction", NAN), ["friction"], "NaN friction")
	check.same(terrain.query(PackedVector2Array()), 0, "no points")
	refused(1, ["points", "0"], "no points")
	check.same(terrain.query(PackedVector2Array([Vector2(NAN, 0)])), 0, "NaN point")
	check.same(terrain.get_query(999).size(), 0, "unknown ticket")
	check.that(terrain.get_texture(99) == null, "output 99")
	refused(1, ["output", "99"], "output 99")
	for region in [Rect2i(-1, 0, 2, 2), Rect2i(0, 0, 257, 1), Rect2i(255, 127, 2, 2), Rect2i(0, 0, 0, 0), Rect2i(2147483647, 0, 2, 2)]:
		check.same(terrain.get_heights(region).size(), 0, "heights of %s" % region)
	check.same(terrain.get_dirty_regions(-5).size(), 0, "since step -5")
	terrain.callv("query", [Vector2.ZERO]) # the engine's own message about the type
	terrain.callv("step", [])
	terrain.outputs = -1
	refused(1, ["outputs"], "outputs -1")
	terrain.outputs = 0
	terrain.max_steps_per_frame = 5000
	refused(1, ["max_steps_per_frame", "5000"], "5000 steps per frame")
	terrain.max_steps_per_frame = 8
	check.same(terrain.get_hash(), hash, "hash after all that")
	check.same(terrain.step(3), OK, "steps after all that")
	for n in 32:
		check.same(terrain.open_source(water, Vector3.ZERO, 1, 0.01), n, "source %d" % n)
	check.same(terrain.open_source(water, Vector3.ZERO, 1, 0.01), -1, "source 32")
	refused(1, ["open_source", "32"], "source 32")
	terrain.close_source(7)
	check.same(terrain.open_source(water, Vector3.ZERO, 1, 0.01), 7, "the one that was closed")
	check.same(terrain.step(3), OK, "steps with 32 sources")

# Nodes that go while the world runs.
func endings() -> void:
	var body := RigidBody3D.new()
	var water := WadiFloat3D.new()
	body.add_child(water)
	root.add_child(body)
	water.terrain = water.get_path_to(terrain)
	terrain.running = true
	for n in 5:
		await physics_frame
	water.samples = 99
	await physics_frame
	water.samples = 4
	body.position = Vector3(NAN, 0, 0)
	for n in 3:
		await physics_frame
	root.remove_child(terrain)
	root.add_child(terrain)
	await physics_frame
	terrain.free()
	for n in 3:
		await physics_frame
	body.free()
	for n in 20: # each ends within a signal of its own
		var other := Scene.terrain(self, Scene.pool(1))
		other.max_steps_per_frame = 1
		other.started.connect(func() -> void: other.brush(0, Vector3.ZERO, 1, 1))
		other.world_changed.connect(func(_regions: Array[Rect2i]) -> void: other.stop() if n % 2 == 0 else other.queue_free())
		other.time_dropped.connect(func(_seconds: float) -> void: other.stop() if n % 3 == 0 else null)
		other.start()
		other.running = true
		await physics_frame
		await physics_frame
		if is_instance_valid(other):
			other.free()

func _initialize() -> void:
	await physics_frame
	terrain = WadiTerrain3D.new()
	terrain.backend = "cpu"
	terrain.running = false
	root.add_child(terrain)
	before_start()
	levels()
	properties()
	calls()
	await endings()
	check.done(self)
