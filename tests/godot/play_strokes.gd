# Strokes of the editor's brush in a game, and the ray that finds the ground below the mouse.
extends SceneTree

const Ray := preload("res://addons/wadi/brush_ray.gd")

var failed := false
var world: WadiTerrain3D
var strokes: Node


func check(right: bool, what: String) -> void:
	if not right:
		failed = true
		print("FAILED: ", what)


func _initialize() -> void:
	world = WadiTerrain3D.new()
	world.level = WadiLevel.new()
	world.level.file = "res://levels/canyon/level.json"
	world.level.cells = Vector2i(100, 128)
	world.backend = "cpu"
	world.running = false
	strokes = load("res://addons/wadi/brush_strokes.gd").new()
	strokes.strokes = PackedFloat32Array([
		WadiTerrain3D.LAYER_TERRAIN, 20, 0, 10, 4, 3, 0.5, WadiTerrain3D.LAYER_SAND, -12, 0, 32, 3, 1.5, 0.5])
	world.add_child(strokes)
	root.add_child(world)


func _process(_delta: float) -> bool:
	var plain := WadiTerrain3D.new()
	plain.level = world.level
	plain.backend = "cpu"
	plain.running = false
	root.add_child(plain)
	check(plain.is_started() or plain.start() == OK, plain.get_last_message())
	check(world.is_started() or world.start() == OK, world.get_last_message())
	for one in [plain, world]:
		one.step(1)
		one.sync_textures()
	check(absf(_height(world, 20, 10) - _height(plain, 20, 10) - 3) < 0.05, "rock was not raised by 3 m")
	var raised := _height(world, -12, 32) - _height(plain, -12, 32)
	check(raised > 1.2 and raised < 1.6, "sand was raised by %f m instead of 1.5 m" % raised)
	check(absf(_height(world, 0, -40) - _height(plain, 0, -40)) < 1e-4, "ground that no stroke touches has moved")

	var kept: PackedFloat32Array = strokes.strokes
	print("an error about a wrong number of values follows")
	strokes.strokes = PackedFloat32Array([1, 2, 3])
	check(strokes.strokes == kept, "strokes of a wrong length were taken")

	# From all around towards a place on the ground: the ray ends there, or earlier at ground that hides it, never later or below.
	var ray := Ray.new()
	ray.look(world)
	var near := 0
	for n in 50:
		var place := Vector3(-45 + 90 * fmod(n * 0.618034, 1.0), 0, -60 + 120 * fmod(n * 0.754878, 1.0))
		place.y = _height(world, place.x, place.z)
		var eye := place + Vector3(cos(n), 1.2, sin(n)).normalized() * 150
		var hit: Variant = ray.hit(eye, (place - eye).normalized())
		check(hit != null, "the ray to %s meets nothing" % place)
		if hit == null:
			continue
		check(eye.distance_to(hit) < eye.distance_to(place) + 2.5, "the ray to %s ends behind it, at %s" % [place, hit])
		check(absf(hit.y - _height(world, hit.x, hit.z)) < 2.5, "the ray ends at %s, off the ground" % hit)
		if place.distance_to(hit) < 2.5:
			near += 1
	check(near >= 40, "only %d of 50 rays end at the place they aim at" % near)
	check(ray.hit(Vector3(0, 50, 0), Vector3.UP) == null, "a ray upwards meets ground")
	check(ray.hit(Vector3(500, 50, 0), Vector3.RIGHT) == null, "a ray beside the grid meets ground")
	print("strokes and rays: %s" % ("failed" if failed else "right"))
	quit(1 if failed else 0)
	return true


func _height(of: WadiTerrain3D, x: float, z: float) -> float:
	var cell := Vector2i((Vector2(x, -z) / of.get_cell_size() + 0.5 * Vector2(of.get_cells())).floor())
	return of.get_heights(Rect2i(cell.clamp(Vector2i.ZERO, of.get_cells() - Vector2i.ONE), Vector2i.ONE))[0]
