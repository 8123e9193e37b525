# The main scene of an exported project: a terrain map alone and a level with a map, both in the pack; prints the worlds' hashes.
extends Node

func _ready() -> void:
	for file: String in ["res://levels/canyon/terrain.png", "res://levels/canyon/level.json"]:
		var terrain := WadiTerrain3D.new()
		terrain.level = WadiLevel.new()
		terrain.level.file = file
		terrain.level.cells = Vector2i(50, 64)
		terrain.backend = "cpu"
		terrain.running = false
		add_child(terrain)
		terrain.start()
		terrain.step(20)
		print("%s: hash %s %s" % [file, terrain.get_hash() if terrain.is_started() else "none", terrain.get_last_message()])
	get_tree().quit()
