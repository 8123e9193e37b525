# Loads every block that godot_blocks.py wrote. What the engine says of one comes behind its name.
extends SceneTree

func _initialize() -> void:
	for file in DirAccess.get_files_at("res://blocks"):
		printerr("BLOCK ", file)
		var shader := load("res://blocks/" + file) as Shader
		if shader != null:
			shader.get_rid() # compiles it
	quit()
