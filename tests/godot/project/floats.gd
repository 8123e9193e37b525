# A box of half the water's density floats half under, a sphere as deep as Archimedes says, in a pool on a turned and moved terrain; one
# without WadiFloat3D falls through. --fixed-fps 60.
extends SceneTree

const DEPTH := 2.0

func body(terrain: WadiTerrain3D, at: Vector3, mass: float, shape: Shape3D, floating: bool) -> RigidBody3D:
	var made := RigidBody3D.new()
	made.mass = mass
	var collision := CollisionShape3D.new()
	collision.shape = shape
	made.add_child(collision)
	made.position = terrain.to_global(at)
	root.add_child(made)
	if floating:
		var water := WadiFloat3D.new()
		water.shape = WadiFloat3D.SHAPE_SPHERE if shape is SphereShape3D else WadiFloat3D.SHAPE_BOX
		water.linear_drag = mass
		water.samples = 8
		made.add_child(water)
		water.terrain = water.get_path_to(terrain)
	return made

func _initialize() -> void:
	var check := Check.new()
	await physics_frame
	var terrain := Scene.terrain(self, Scene.pool(DEPTH))
	terrain.position = Vector3(20, 7, -4)
	terrain.rotation = Vector3(0, 0.7, 0)
	terrain.wait_for_device = true
	terrain.start()
	terrain.running = true
	var box := body(terrain, Vector3(-3, DEPTH + 1, 1), 500, BoxShape3D.new(), true)
	box.lock_rotation = true
	var sphere := body(terrain, Vector3(3, DEPTH + 1, -1), 1000.0 * PI / 6 * 0.25, SphereShape3D.new(), true)
	var stone := body(terrain, Vector3(0, DEPTH + 1, 0), 500, BoxShape3D.new(), false)
	for n in 900:
		await physics_frame
	var surface := terrain.position.y + DEPTH
	check.that(absf(box.position.y - surface) < 0.02, "box: its middle is %f m above the water, expected 0" % (box.position.y - surface))
	# A quarter of a sphere's volume lies below depth h where h^2 (3 r - h) / (4 r^3) = 1/4: h = 0.3264 for r = 1/2.
	var under := surface - (sphere.position.y - 0.5)
	check.that(absf(under - 0.3264) < 0.02, "sphere: %f m under water, expected 0.326" % under)
	check.that(stone.position.y < surface - 100, "control: without WadiFloat3D it falls")
	check.that(Vector2(box.position.x, box.position.z).distance_to(Vector2(terrain.to_global(Vector3(-3, 0, 1)).x, terrain.to_global(Vector3(-3, 0, 1)).z)) < 0.5, "box: stays where it fell")

	# Answers of a query at the same places, in the node's axes.
	var ticket := terrain.query(PackedVector2Array([Vector2(-3, 1), Vector2(100, 0)]))
	check.that(ticket > 0, "query")
	terrain.sync_textures() # waits for the steps; without it answers come some ticks later
	var answers := terrain.get_query(ticket)
	check.same(answers.size(), 2, "answers")
	check.that(absf(answers[0]["surface"] - DEPTH) < 0.01 and absf(answers[0]["water_depth"] - DEPTH) < 0.01, "depth of the pool")
	check.that(answers[0]["normal"].distance_to(Vector3.UP) < 0.05 and answers[0]["inside"], "normal of the pool")
	check.same(answers[1]["inside"], false, "a point outside the grid")

	# A push along the node's x moves water along x.
	for n in 20:
		terrain.push(Vector3.ZERO, 2, Vector3(1.5, 0, 0.5), 1)
		await physics_frame
	ticket = terrain.query(PackedVector2Array([Vector2.ZERO]))
	terrain.sync_textures()
	answers = terrain.get_query(ticket)
	var velocity: Vector3 = answers[0]["velocity"]
	check.that(velocity.x > 0.5 and velocity.z > 0.1 and velocity.z < velocity.x, "velocity of pushed water: %s" % velocity)
	check.done(self)
