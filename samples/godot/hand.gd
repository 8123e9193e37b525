## The player's camera and hand. Right button or arrows: orbit; wheel: distance; WASD: move; left button: the tool, 1 and 2 choose it.
extends Camera3D

## Where the mouse points at the ground, with the tool, whether it works, and the seconds since the last time.
signal pointed(tool: int, place: Vector3, working: bool, delta: float)

enum { DIG, BUILD }

@export var target := Vector3.ZERO
@export var distance := 20.0
@export var yaw := 0.0
@export var pitch := 35.0
## Radius of the tool [m].
@export var radius := 0.5

var tool := DIG
var _working := false
var _own := Vector2.ZERO  # yaw and pitch ahead of `look_beside`


func _ready() -> void:
	_place()


## Target x, y, z, distance [m], yaw and pitch [degrees].
func look(numbers: PackedFloat64Array) -> void:
	target = Vector3(numbers[0], numbers[1], numbers[2])
	distance = numbers[3]
	yaw = numbers[4]
	pitch = numbers[5]
	_place()


## Another yaw and pitch, with the target in the right half of the picture, until `swing_back`.
func look_beside(other: Vector2) -> void:
	_own = Vector2(yaw, pitch)
	yaw = other.x
	pitch = other.y
	h_offset = -0.28 * distance


func swing_back() -> void:
	var swing := create_tween().set_trans(Tween.TRANS_SINE).set_parallel()
	swing.tween_property(self, "yaw", _own.x, 2)
	swing.tween_property(self, "pitch", _own.y, 2)
	swing.tween_property(self, "h_offset", 0.0, 2)


func _place() -> void:
	var turn := Basis.from_euler(Vector3(-deg_to_rad(pitch), deg_to_rad(yaw), 0))
	global_transform = Transform3D(turn, target + turn.z * distance)


func _process(delta: float) -> void:
	var move := Vector3.ZERO
	move.x = float(Input.is_physical_key_pressed(KEY_D)) - float(Input.is_physical_key_pressed(KEY_A))
	move.z = float(Input.is_physical_key_pressed(KEY_S)) - float(Input.is_physical_key_pressed(KEY_W))
	target += Basis.from_euler(Vector3(0, deg_to_rad(yaw), 0)) * move * (distance * 0.8 * delta)
	yaw += 60 * delta * (float(Input.is_key_pressed(KEY_LEFT)) - float(Input.is_key_pressed(KEY_RIGHT)))
	pitch = clampf(pitch + 40 * delta * (float(Input.is_key_pressed(KEY_UP)) - float(Input.is_key_pressed(KEY_DOWN))), 5, 85)
	_place()


func _physics_process(delta: float) -> void:
	var mouse := get_viewport().get_mouse_position()
	var ray := PhysicsRayQueryParameters3D.create(project_ray_origin(mouse), project_position(mouse, far))
	var hit := get_world_3d().direct_space_state.intersect_ray(ray)
	if not hit.is_empty():
		pointed.emit(tool, hit.position, _working, delta)


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseButton:
		match event.button_index:
			MOUSE_BUTTON_LEFT:
				_working = event.pressed
			MOUSE_BUTTON_WHEEL_UP:
				distance = maxf(0.9 * distance, 2)
			MOUSE_BUTTON_WHEEL_DOWN:
				distance = minf(1.1 * distance, 300)
	elif event is InputEventMouseMotion and event.button_mask & MOUSE_BUTTON_MASK_RIGHT:
		yaw -= 0.3 * event.relative.x
		pitch = clampf(pitch + 0.3 * event.relative.y, 5, 85)
	elif event is InputEventKey and event.pressed:
		match event.physical_keycode:
			KEY_1:
				tool = DIG
			KEY_2:
				tool = BUILD
