# The games as a player meets them: start screen, choice, announcements, tool, sounds, end, score, again. Arguments: those of
# the games. Controls, of which each must fail, by name in the environment's WADI_CONTROL: unkept (no score can be written), untold (the sea
# has no sets), silent (sounds of zeros), hidden (the tool is not placed).
extends SceneTree

const Score := preload("res://score.gd")

var failed := false
var control := OS.get_environment("WADI_CONTROL")
var game: Node3D


func check(right: bool, what: String) -> void:
	if not right:
		failed = true
		print("FAILED: ", what)


func _initialize() -> void:
	_run()


func _run() -> void:
	Score.file = "user://no/such/folder.cfg" if control == "unkept" else "user://scores_of_a_test.cfg"
	DirAccess.remove_absolute(Score.file)
	await _beach()
	await _canyon()
	DirAccess.remove_absolute(Score.file)
	await game.sounds.end()
	print("the games' screens, score, tools and sounds: %s" % ("failed" if failed else "right"))
	quit(1 if failed else 0)


func _open(scene: String) -> void:
	change_scene_to_file(scene)
	await _arrive()


func _arrive() -> void:
	await process_frame
	while current_scene == null or not current_scene.is_node_ready():
		await process_frame
	game = current_scene
	game.world.wait_for_device = true


# Physics ticks until the game is over or its world has this time.
func _wait(time: float) -> void:
	for n in 2000:
		if game.world.get_time() >= time or game.verdict != game.Verdict.OPEN:
			return
		await physics_frame


func _height(place: Vector2) -> float:
	var world: WadiTerrain3D = game.world
	var cell := Vector2i((Vector2(place.x, -place.y) / world.get_cell_size()).floor()) + world.get_cells() / 2
	return world.get_heights(Rect2i(cell, Vector2i.ONE))[0]


func _shown(part: String) -> bool:
	return game.screens.get_node(part).visible


func _text(part: String) -> String:
	return game.screens.get_node(part).text


func _press(button: String) -> void:
	game.screens.get_node(button).pressed.emit()


func _key(code: Key) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = code
	event.pressed = true
	game._unhandled_key_input(event)


func _beach() -> void:
	await _open("res://beach.tscn")
	for n in 5:
		await physics_frame
	check(_shown("Start") and not _shown("End"), "beach: no start screen")
	check(game.world.is_started() and game.world.get_time() == 0, "beach: the world does not stand behind the start screen")
	await _choices()
	if control == "untold":
		game.get_node("Sea").sets.clear()
	_press("%Play")
	check(not _shown("Start"), "beach: the start screen stays")
	await _wait(0.2)
	check(game.world.get_time() >= 0.2, "beach: the world does not run")
	check(_text("Announce").ends_with("set 1 of 3"), "beach: \"%s\" is announced" % _text("Announce"))
	var sea: Node = game.get_node("Sea")
	check(sea.sets == PackedFloat32Array([1, 17, 34]), "beach: sets of waves at %s" % sea.sets)
	check(absf(sea.level_at(22) - 0.8) < 0.01 and absf(sea.level_at(44) - 0.15) < 0.01, "beach: the sea's level")
	await _tools()
	_sounds()
	await _ends()


func _choices() -> void:
	var list: Array = game.screens.get_node("%Choices").get_children()
	check(list.size() == 3, "beach: %d choices" % list.size())
	var wall := _height(Vector2(0, 1))
	var gate := _height(Vector2(0, -1.3))
	list[2].pressed.emit()
	check(wall - _height(Vector2(0, 1)) > 0.25, "open gate: the sea wall is %f m lower" % (wall - _height(Vector2(0, 1))))
	check(gate - _height(Vector2(0, -1.3)) > 0.25, "open gate: the gate is %f m lower" % (gate - _height(Vector2(0, -1.3))))
	list[0].pressed.emit()
	check(_height(Vector2(0, 1)) == wall and _height(Vector2(0, -1.3)) == gate, "beach: chosen back it is another castle")


func _tools() -> void:
	var place := Vector2(-6, -9)
	for tool in 2:
		var held: int = game.bucket
		if control != "hidden":
			game._on_hand_pointed(tool, Vector3(place.x, 3, place.y), true, 1.0)
		var tools: Node3D = game.tools
		check(tools.visible and tools.get_node("Shovel").visible == (tool == 0) and tools.get_node("Bucket").visible == (tool == 1), "tool %d is not seen" % tool)
		check(game.bucket - held == (1 if tool == 0 else -1), "tool %d: %d scoops" % [tool, game.bucket - held])
		var says: String = tools.get_node("Says").text
		check(absf(says.to_float() - _height(place)) < 0.05, "tool %d says \"%s\", the ground is %f m high" % [tool, says, _height(place)])
		check(says.contains("%.1f of %.1f" % [held * game.scoop_volume(), 160 * game.scoop_volume()]), "tool %d says \"%s\" with %d scoops" % [tool, says, held])
		var box: AABB = tools.get_node("Ring").mesh.get_aabb()
		check(absf(box.size.x - 1) < 0.01 and absf(box.get_center().x - place.x) < 0.01 and absf(box.get_center().y - _height(place)) < 0.1, "tool %d: its ring is at %s" % [tool, box])
		check(game.spray.grains.emitting, "tool %d: no grains fly" % tool)
		check(game.sounds._players[&"dig" if tool == 0 else &"pour"][0].playing, "tool %d: no sound" % tool)
		await physics_frame


func _sounds() -> void:
	for player: AudioStreamPlayer in game.sounds.get_children():
		var stream: AudioStreamWAV = player.stream
		var data: PackedByteArray = stream.data
		if control == "silent":
			data.fill(0)
		var largest := 0
		for n in range(0, data.size(), 2):
			largest = maxi(largest, absi(data.decode_s16(n)))
		check(largest > 20000 and largest < 32000, "a sound's largest sample is %d" % largest)
		var end := absi(data.decode_s16(data.size() - 2) - (data.decode_s16(0) if stream.loop_mode == AudioStreamWAV.LOOP_FORWARD else 0))
		check(end < 3500, "a sound ends with a step of %d" % end)
	var ears: Node = game.get_node("Ears")
	check(ears._points.size() == 48, "the water is heard at %d points" % ears._points.size())
	if control != "silent":
		ears._hear(range(48).map(func(n: int) -> Dictionary: return {water_depth = 0.1, velocity = Vector2(3.6 if n < 24 else 0.0, 0)}), game.sounds)
	check(is_equal_approx(game.sounds._loudness, 1), "the surf is %f loud where half of the water has twice the speed of a splash" % game.sounds._loudness)
	check(game.sounds._players[&"splash"][0].playing, "no splash is heard where water comes")
	var before: bool = game.sounds.silent
	_key(KEY_M)
	check(AudioServer.is_bus_mute(0) != before, "M does not switch sound")
	_key(KEY_M)


# A game that is won with a dry courtyard, one with half of it wet, and one that is lost.
func _ends() -> void:
	game.duration = game.world.get_time() + 0.1
	await _wait(INF)
	check(game.verdict == game.Verdict.WON and _shown("End"), "beach: no end screen")
	check(_text("%Result") == "Won!" and _text("%Medal") == "Gold" and _text("%Points") == "1000 points, your best", "beach, won: \"%s\", \"%s\"" % [_text("%Medal"), _text("%Points")])
	check(Score.best("Beach", "Castle") == Vector2i(1000, Score.Medal.GOLD), "beach: kept is %s" % Score.best("Beach", "Castle"))
	_press("%Again")
	await _arrive()
	await _wait(0.1)
	check(not _shown("Start") and not _shown("End") and game.playing and game.bucket == 20, "beach: again begins elsewhere")
	game._worst = 0.2
	game.duration = 0.1
	await _wait(INF)
	check(_text("%Medal") == "Bronze" and _text("%Points") == "800 points" and _text("%Best") == "Best so far: Gold, 1000 points", "beach, again: \"%s\", \"%s\"" % [_text("%Points"), _text("%Best")])
	_key(KEY_R)
	await _arrive()
	await _wait(0.1)
	game._flooded = 0.26
	await physics_frame
	await physics_frame
	check(game.verdict == game.Verdict.LOST and _text("%Result") == "Lost" and _text("%Medal") == "No medal", "beach, lost: \"%s\"" % _text("%Result"))
	_press("%EndOther")
	await _arrive()
	check(game.name == "Canyon", "the other game is %s" % game.name)
	await _open("res://beach.tscn")
	var first: String = game.screens.get_node("%Choices").get_child(0).text
	check(first == "Castle\nGold, 1000", "the start screen says \"%s\"" % first)
	var file := FileAccess.open(Score.file, FileAccess.WRITE)
	if file != null:
		file.store_string("[Beach]\nCastle=\"many\"\n")
		file.close()
	check(Score.best("Beach", "Castle") == Vector2i.ZERO, "a score that somebody wrote into the file is taken")


func _canyon() -> void:
	await _open("res://canyon.tscn")
	check(_shown("Start"), "canyon: no start screen")
	_press("%Play")
	await _wait(0.1)
	for n in 3:
		game.get_node("Crates").get_child(n).position = Vector3(0, 12, game.MOUTH + 1)
		await physics_frame
		await physics_frame
		check(_text("Announce") == "A crate is out: %d of 3" % (n + 1), "canyon: \"%s\" is announced" % _text("Announce"))
	await _wait(INF)
	check(game.verdict == game.Verdict.WON and _text("%Medal") == "Gold", "canyon: \"%s\"" % _text("%Medal"))
	check(Score.best("Canyon", "Three crates").x > 1100, "canyon: kept is %s" % Score.best("Canyon", "Three crates"))
