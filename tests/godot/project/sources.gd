# A WadiSource3D is a source of the world. What nodes do in ticks leaves the commands and the bits of a script that opens, sets and closes
# sources at the same ticks, and brings its discharge times its time to the quantum. --fixed-fps 60.
extends SceneTree

const WATER := WadiTerrain3D.LAYER_WATER
const SAND := WadiTerrain3D.LAYER_SAND

var check := Check.new()

func pass_ticks(count: int) -> void:
	for n in count:
		await physics_frame

func pool() -> WadiTerrain3D:
	var made := Scene.terrain(self, Scene.pool(1))
	made.wait_for_device = true
	made.start()
	made.set_command_log(true)
	return made

func source(of: WadiTerrain3D, layer: int, at: Vector3, radius: float, discharge: float) -> WadiSource3D:
	var made := WadiSource3D.new()
	made.layer = layer
	made.position = at
	made.radius = radius
	made.discharge = discharge
	of.add_child(made)
	return made

func volumes() -> void:
	for radius: float in [1.0, 0.6, 0.05]: # the last one holds no middle of a cell
		var terrain := Scene.terrain(self, Scene.pool(1))
		terrain.position = Vector3(3, 1, -2)
		terrain.rotation_degrees = Vector3(0, 30, 0)
		terrain.wait_for_device = true
		terrain.start()
		var spring := source(terrain, WATER, Vector3(1, 0, 0.5), radius, 0.6)
		await pass_ticks(10)
		check.same(terrain.get_stats()["water_in"], 0.0, "while it does not run")
		terrain.running = true
		await pass_ticks(121)
		terrain.running = false
		var stats := terrain.get_stats()
		var poured: float = stats["water_in"] / stats["time"]
		check.that(absf(poured / 0.6 - 1) < 1e-4, "radius %.2f: %.6f m3/s" % [radius, poured])
		check.same(stats["water_drift_quanta"], 0, "drift")
		spring.discharge = -0.06
		terrain.running = true
		await pass_ticks(60)
		terrain.running = false
		var after := terrain.get_stats()
		var taken: float = after["water_out"] / (after["time"] - stats["time"])
		check.that(absf(taken / 0.06 - 1) < 1e-4, "radius %.2f: took %.6f m3/s" % [radius, taken])
		terrain.free()

# Every kind of change, by nodes in one world and by calls in another.
func changes() -> void:
	var nodes := pool()
	var script := pool()
	nodes.running = true
	script.running = true
	await pass_ticks(10)
	var a := source(nodes, WATER, Vector3(1, 0, 0.5), 1, 0.6)
	check.same(script.open_source(WATER, Vector3(1, 0, 0.5), 1, 0.6), 0, "the first source")
	await pass_ticks(15)
	a.position = Vector3(-2, 0, 1.25) # moves
	script.set_source(0, WATER, Vector3(-2, 0, 1.25), 1, 0.6)
	await pass_ticks(10)
	var b := source(nodes, SAND, Vector3(3, 0.5, -1), 0.75, 0.3) # a second one
	check.same(script.open_source(SAND, Vector3(3, 0, -1), 0.75, 0.3), 1, "the second source")
	await pass_ticks(10)
	a.running = false # stops
	script.set_source(0, WATER, Vector3(-2, 0, 1.25), 1, 0)
	await pass_ticks(10)
	a.discharge = 0.25 # while it is off nothing is said
	a.position.x = 0.5
	await pass_ticks(5)
	a.running = true # starts
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, 0.25)
	await pass_ticks(10)
	a.discharge = 0
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, 0)
	b.radius = 0.5
	script.set_source(1, SAND, Vector3(3, 0, -1), 0.5, 0.3)
	await pass_ticks(10)
	b.position.x = 40 # beyond the grid
	script.set_source(1, SAND, Vector3(40, 0, -1), 0.5, 0.3)
	var sand: float = nodes.get_stats()["sand_in"]
	await pass_ticks(10)
	check.that(nodes.get_stats()["sand_in"] == sand and sand > 0, "beyond the grid it pours nothing")
	b.position = Vector3(-4, 0, -2)
	b.layer = WATER
	script.set_source(1, WATER, Vector3(-4, 0, -2), 0.5, 0.3)
	await pass_ticks(10)
	b.free() # leaves
	script.close_source(1)
	await pass_ticks(5)
	a.discharge = -0.2 # takes
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, -0.2)
	await pass_ticks(10)
	a.process_mode = Node.PROCESS_MODE_DISABLED
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, 0)
	await pass_ticks(5)
	a.process_mode = Node.PROCESS_MODE_INHERIT
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, -0.2)
	await pass_ticks(10)
	nodes.process_mode = Node.PROCESS_MODE_ALWAYS
	script.process_mode = Node.PROCESS_MODE_ALWAYS
	a.process_mode = Node.PROCESS_MODE_PAUSABLE
	paused = true # the terrain goes on
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, 0)
	await pass_ticks(5)
	paused = false
	script.set_source(0, WATER, Vector3(0.5, 0, 1.25), 1, -0.2)
	await pass_ticks(5)
	nodes.process_mode = Node.PROCESS_MODE_PAUSABLE
	script.process_mode = Node.PROCESS_MODE_PAUSABLE
	paused = true # all of it stands: nothing is said
	await pass_ticks(5)
	paused = false
	await pass_ticks(5)
	source(nodes, WATER, Vector3(4, 0, 2), 1, 0.5)
	check.same(script.open_source(WATER, Vector3(4, 0, 2), 1, 0.5), 1, "the number of one that left is given again")
	await pass_ticks(5)
	nodes.running = false
	script.running = false
	check.same(nodes.get_step(), script.get_step(), "steps of both")
	var hash := nodes.get_hash()
	check.same(hash, script.get_hash(), "hash of nodes and of a script")
	var commands := nodes.get_commands()
	check.that(commands == script.get_commands(), "one command for each change: %d bytes, a script has %d" % [commands.size(), script.get_commands().size()])
	for played in [true, false]:
		var other := pool()
		if played:
			check.same(other.play_commands(commands), OK, "play_commands")
		other.step(nodes.get_step())
		check.that((other.get_hash() == hash) == played, "hash %s the commands" % ["with" if played else "without"])
		other.free()
	nodes.free()
	script.free()

# A discharge of 0 opens nothing.
func rate_zero() -> void:
	var terrain := pool()
	var empty := terrain.get_commands().size()
	var idle := source(terrain, WATER, Vector3.ZERO, 1, 0)
	terrain.running = true
	await pass_ticks(20)
	check.same(terrain.get_commands().size(), empty, "rate 0 says nothing")
	check.same(terrain.get_stats()["water_in"], 0.0, "rate 0 brings nothing")
	idle.discharge = 0.5
	await pass_ticks(20)
	check.that(terrain.get_commands().size() > empty and terrain.get_stats()["water_in"] > 0, "control: another rate does")
	terrain.free()

# Worlds that end, begin, go back in time or leave the tree; another terrain.
func worlds() -> void:
	var terrain := pool()
	var spring := source(terrain, WATER, Vector3(1, 0, 0.5), 1, 0.6)
	terrain.running = true
	await pass_ticks(12)
	terrain.running = false
	var state := terrain.save_state()
	terrain.step(30)
	var later := terrain.get_hash()
	check.same(terrain.load_state(state), OK, "load_state")
	terrain.step(30)
	check.same(terrain.get_hash(), later, "hash 30 steps after loading: it pours on")

	var calm := pool()
	calm.step(3)
	check.same(terrain.load_state(calm.save_state()), OK, "a state without the source")
	terrain.step(30)
	check.that(absf(terrain.get_stats()["water_in"] - 0.6 * 30 * 0.01) < 1e-4, "the node has it pour all the same")

	calm.load_state(state)
	terrain.load_state(state)
	root.remove_child(terrain)
	terrain.step(5)
	calm.set_source(0, WATER, Vector3(1, 0, 0.5), 1, 0)
	calm.step(5)
	root.add_child(terrain)
	terrain.step(30)
	calm.set_source(0, WATER, Vector3(1, 0, 0.5), 1, 0.6)
	calm.step(30)
	check.same(terrain.get_hash(), calm.get_hash(), "the tree left and entered again")

	terrain.stop()
	terrain.start() # signal `started`: a world that knows nothing of the node
	terrain.step(30)
	check.that(absf(terrain.get_stats()["water_in"] - 0.6 * 30 * 0.01) < 1e-4, "the next world has it from its first step")

	var other := pool()
	spring.terrain = other
	other.running = true
	var before: float = terrain.get_stats()["water_in"]
	terrain.step(30)
	check.same(terrain.get_stats()["water_in"], before, "the terrain before gets nothing more")
	await pass_ticks(12)
	other.running = false
	check.that(absf(other.get_stats()["water_in"] / other.get_time() - 0.6) < 1e-4, "the other one does")
	other.free() # the node stays
	await pass_ticks(2)
	terrain.free()
	calm.free()

# A level's own sources come first, may be set, and are not closed by the scene.
func levels() -> void:
	var level := Scene.pool(1)
	level.settings = level.settings.replace('"dt"', '"sources": [{ "shape": "point", "center": [2, 2], "material": "water", "discharge": 0.5 }], "dt"')
	var terrain := Scene.terrain(self, level)
	terrain.start()
	check.same(terrain.open_source(WATER, Vector3.ZERO, 1, 0.25), 1, "the number behind the level's")
	terrain.step(20)
	var stats := terrain.get_stats()
	check.that(absf(stats["water_in"] - 0.75 * 0.2) < 1e-4, "both pour: %f" % stats["water_in"])
	check.same(terrain.set_source(0, WATER, Vector3.ZERO, 1, 0), OK, "a level's source is set")
	check.same(terrain.close_source(1), OK, "close_source")
	terrain.step(20)
	check.same(terrain.get_stats()["water_in"], stats["water_in"], "neither pours")
	terrain.free()

func _initialize() -> void:
	await physics_frame
	await volumes()
	await changes()
	await rate_zero()
	await worlds()
	levels()
	check.done(self)
