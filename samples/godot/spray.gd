## What flies: drops from fronts and falls, which the particles themselves find in the textures of the world, and grains or drops where a
## tool works.
extends Node3D

@export var world: WadiTerrain3D
## Side of a drop and of a grain [m].
@export var size := 0.05
## Drops at most at a time.
@export var amount := 6000
## Speed from which foaming water sprays [m/s].
@export var speed_from := 1.5

const SAND := Color(0.74, 0.6, 0.4)
const WATER := Color(0.9, 0.96, 1.0)
const SECONDS := 0.9

var fronts := GPUParticles3D.new()
var grains := CPUParticles3D.new()

var _rules := ShaderMaterial.new()
var _until := 0.0


func _ready() -> void:
	_rules.shader = preload("spray.gdshader")
	_rules.set_shader_parameter("size", size)
	_rules.set_shader_parameter("speed_from", speed_from)
	fronts.process_material = _rules
	fronts.draw_pass_1 = _drop(1)
	fronts.amount = amount
	fronts.lifetime = SECONDS
	fronts.preprocess = SECONDS  # a picture of a moment has its drops
	fronts.local_coords = false
	grains.mesh = _drop(size)
	grains.amount = 60
	grains.lifetime = 0.5
	grains.emitting = false
	grains.local_coords = false
	grains.emission_shape = CPUParticles3D.EMISSION_SHAPE_SPHERE
	grains.direction = Vector3.UP
	grains.spread = 40
	grains.scale_amount_min = 0.3
	grains.scale_amount_max = 0.9
	for particles: GeometryInstance3D in [fronts, grains]:
		particles.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
		add_child(particles)
	world.outputs |= (1 << WadiTerrain3D.OUTPUT_PACKED) | (1 << WadiTerrain3D.OUTPUT_FLOW)
	world.started.connect(_on_started)


func _on_started() -> void:
	var extent := world.get_extent()
	fronts.visibility_aabb = AABB(Vector3(-0.5 * extent.x, -20, -0.5 * extent.y), Vector3(extent.x, 60, extent.y))
	_rules.set_shader_parameter("packed_texture", world.get_texture(WadiTerrain3D.OUTPUT_PACKED))
	_rules.set_shader_parameter("flow_texture", world.get_texture(WadiTerrain3D.OUTPUT_FLOW))
	_rules.set_shader_parameter("cells", world.get_cells())
	_rules.set_shader_parameter("cell_size", world.get_cell_size())
	_rules.set_shader_parameter("to_world", world.global_transform)


## Grains of sand, or drops, fly where a tool works.
func burst(place: Vector3, radius: float, wet: bool) -> void:
	grains.global_position = place
	grains.emission_sphere_radius = 0.5 * radius
	grains.initial_velocity_min = 2 * sqrt(radius)
	grains.initial_velocity_max = 4 * sqrt(radius)
	grains.color = WATER if wet else SAND
	grains.emitting = true
	_until = 0.15


func _process(delta: float) -> void:
	_until -= delta
	if _until <= 0:
		grains.emitting = false


## A round spot that faces the camera.
static func _drop(side: float) -> QuadMesh:
	var round_spot := GradientTexture2D.new()
	round_spot.width = 32
	round_spot.height = 32
	round_spot.fill = GradientTexture2D.FILL_RADIAL
	round_spot.fill_from = Vector2(0.5, 0.5)
	round_spot.fill_to = Vector2(0.5, 0.0)
	round_spot.gradient = Gradient.new()
	round_spot.gradient.set_color(0, Color.WHITE)
	round_spot.gradient.set_color(1, Color(1, 1, 1, 0))
	var material := StandardMaterial3D.new()
	material.albedo_texture = round_spot
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.billboard_mode = BaseMaterial3D.BILLBOARD_PARTICLES
	material.billboard_keep_scale = true
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	material.vertex_color_use_as_albedo = true
	material.render_priority = 1  # after the water
	var quad := QuadMesh.new()
	quad.size = Vector2(side, side)
	quad.material = material
	return quad
