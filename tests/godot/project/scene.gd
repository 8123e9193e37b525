# The scene of scene.txt in Godot, and what the C host wrote about it.
class_name Scene extends RefCounted

# Words behind "--" on the command line: FOLDER BACKEND ...
static func argument(n: int) -> String:
	return OS.get_cmdline_user_args()[n]

static func level(name: String) -> WadiLevel:
	var made := WadiLevel.new()
	made.file = "res://levels/%s/level.json" % name
	return made

# A pool without sand, level water `depth` deep, of 48 x 32 cells of 0.25 m.
static func pool(depth: float) -> WadiLevel:
	var made := WadiLevel.new()
	made.settings = '{ "format_version": 1, "name": "pool", "grid": { "nx": 48, "ny": 32, "dx": 0.25 }, "dt": 0.01 }'
	made.cells = Vector2i(48, 32)
	var water := PackedFloat32Array()
	water.resize(48 * 32)
	water.fill(depth)
	made.water = water
	return made

# A terrain that stands until it is stepped.
static func terrain(tree: SceneTree, of: WadiLevel, backend := "cpu") -> WadiTerrain3D:
	var made := WadiTerrain3D.new()
	made.level = of
	made.backend = backend
	made.running = false
	tree.root.add_child(made)
	return made

# Does what scene.txt says, up to its end; the hashes after each "step" line. `factor` multiplies the amounts of brushes.
static func run(terrain: WadiTerrain3D, factor := 1.0) -> PackedStringArray:
	var hashes := PackedStringArray()
	var opened: Dictionary = terrain.get_meta("opened", {}) # numbers of what is open by those of the scene
	terrain.set_meta("opened", opened)
	for line in FileAccess.get_file_as_string("res://scene.txt").split("\n", false):
		var words := line.split(" ")
		var v := PackedFloat64Array()
		for word in words:
			v.append(float(word))
		match words[0]:
			"step":
				terrain.step(int(words[1]))
				hashes.append(terrain.get_hash())
			"brush":
				terrain.brush(int(words[1]), Vector3(v[2], 0, v[3]), v[4], v[5] * factor, v[6])
			"line":
				terrain.brush_line(int(words[1]), Vector3(v[2], 0, v[3]), Vector3(v[4], 0, v[5]), v[6], v[7] * factor, v[8])
			"push":
				terrain.push(Vector3(v[1], 0, v[2]), v[3], Vector3(v[4], 0, v[5]), v[6])
			"source", "tap":
				var radius := v[5] if words[0] == "source" else 0.01 # holds no middle of a cell
				var rest := [int(words[2]), Vector3(v[3], 0, v[4]), radius, v[-1]]
				if not opened.has(words[1]):
					opened[words[1]] = terrain.callv("open_source", rest)
				else:
					terrain.callv("set_source", [opened[words[1]]] + rest)
			"close":
				terrain.close_source(opened[words[1]])
				opened.erase(words[1])
			"material":
				terrain.set_material(words[1], v[2])
	return hashes

static func host_hashes() -> PackedStringArray:
	return FileAccess.get_file_as_string(argument(0) + "/hashes.txt").strip_edges().split("\n")

static func host_bytes(name: String) -> PackedByteArray:
	return FileAccess.get_file_as_bytes(argument(0) + "/" + name)
