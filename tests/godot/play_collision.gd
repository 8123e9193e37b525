# Balls on sand that is raised, dug away and flooded: a ball's foot never lies below the ground by more than the ground below it moved in
# the last steps, which is what the physics engine takes to push bodies apart, and the tiles hold what the world holds. With `--fixed` after `--` the tiles are not brought up to date: then it must fail.
extends SceneTree

const RADIUS := 0.4
const SLOP := 0.03  # [m] that the physics engine lets bodies sink into each other
const STEPS := 6

var world: WadiTerrain3D
var collision: StaticBody3D
var balls: Array[RigidBody3D] = []
var before: Array[PackedFloat32Array] = []
var worst := -INF
var tick := 0
var failed := false


func _initialize() -> void:
	world = WadiTerrain3D.new()
	world.level = WadiLevel.new()
	world.level.file = "res://levels/beach/level.json"
	world.level.variant = "alone"
	world.level.cells = Vector2i(160, 128)
	world.backend = "cpu"
	world.wait_for_device = true
	collision = load("res://addons/wadi/collision.gd").new()
	world.add_child(collision)
	root.add_child(world)
	if not world.is_started() and world.start() != OK:
		push_error(world.get_last_message())
		quit(2)
		return
	world.running = true
	for place: Vector2 in [Vector2(-6, -8), Vector2(0, -9), Vector2(6, -7), Vector2(8, -5)]:
		var ball := RigidBody3D.new()
		ball.gravity_scale = 1.0
		ball.can_sleep = false
		ball.linear_damp = 0.8
		ball.angular_damp = 4.0
		var shape := CollisionShape3D.new()
		shape.shape = SphereShape3D.new()
		shape.shape.radius = RADIUS
		ball.add_child(shape)
		ball.position = Vector3(place.x, _ground(place) + RADIUS + 0.1, place.y)
		root.add_child(ball)
		balls.append(ball)


func _ground(place: Vector2) -> float:
	var cell := world.get_cell_size()
	var q := Vector2(place.x, -place.y) / cell + 0.5 * Vector2(world.get_cells()) - Vector2(0.5, 0.5)
	var low := Vector2i(q.floor()).clamp(Vector2i.ZERO, world.get_cells() - Vector2i(2, 2))
	var h := world.get_heights(Rect2i(low, Vector2i(2, 2)))  # north first
	var t := q - Vector2(low)
	return lerpf(lerpf(h[2], h[3], t.x), lerpf(h[0], h[1], t.x), t.y)


# What lies under a ball moves: slowly up, down, and up in one blow of more than the ball's size.
func _physics_process(_delta: float) -> bool:
	tick += 1
	if balls.is_empty():
		return true
	if tick == 2 and "--fixed" in OS.get_cmdline_user_args():
		world.world_changed.disconnect(collision._on_world_changed)
	world.sync_textures()
	if tick > 60 and tick < 120:
		world.brush(WadiTerrain3D.LAYER_SAND, balls[0].position, 1.0, 0.02)
		world.brush(WadiTerrain3D.LAYER_SAND, balls[1].position, 1.0, -0.02)
	if tick == 130:
		world.brush(WadiTerrain3D.LAYER_SAND, balls[2].position, 1.5, 1.5)
	if tick >= 140 and tick < 200:
		world.brush(WadiTerrain3D.LAYER_WATER, balls[3].position, 1.5, 0.02)
	if tick == 210:
		world.brush(WadiTerrain3D.LAYER_TERRAIN, balls[3].position, 2.0, 1.2)
	before.append(_grounds())
	var now := before[-1]
	for n in balls.size():
		var due := 0.0
		for k in mini(STEPS, before.size()):
			due = maxf(due, absf(now[n] - before[-1 - k][n]))
		worst = maxf(worst, now[n] - (balls[n].position.y - RADIUS) - due)
	if tick < 330:
		return false
	print("worst: %.3f m below the ground less its change in %d steps (%.2f m of slop); %d tiles rebuilt" % [worst, STEPS, SLOP, collision.rebuilt])
	if worst > SLOP:
		failed = true
		print("FAILED: a ball sank")
	if collision.rebuilt < 20 and "--fixed" not in OS.get_cmdline_user_args():
		failed = true
		print("FAILED: the tiles were not rebuilt")
	_compare_tiles()
	quit(1 if failed else 0)
	return true


func _grounds() -> PackedFloat32Array:
	var grounds := PackedFloat32Array()
	for ball in balls:
		grounds.append(_ground(Vector2(ball.position.x, ball.position.z)))
	return grounds


# The physics engine's own answer, a ray from above, against the world's heights.
func _compare_tiles() -> void:
	collision.update_touched()
	var far := 0.0
	for n in 200:
		var place := Vector2(-15 + 30.0 * fmod(n * 0.618034, 1.0), -12 + 24.0 * fmod(n * 0.754878, 1.0))
		var ray := PhysicsRayQueryParameters3D.create(Vector3(place.x, 50, place.y), Vector3(place.x, -50, place.y))
		ray.exclude = balls.map(func(ball: RigidBody3D) -> RID: return ball.get_rid())
		var hit := root.get_world_3d().direct_space_state.intersect_ray(ray)
		far = maxf(far, INF if hit.is_empty() else absf(hit.position.y - _ground(place)))
	print("rays against heights: %.4f m at most" % far)
	if far > 0.06:
		failed = true
		print("FAILED: the tiles are not the ground")
