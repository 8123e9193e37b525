## Strokes of a brush that are part of a scene: they act ahead of the first step of the [WadiTerrain3D] that is this node's parent.
##
## The editor's brush writes them; each acts in turn, so that the order counts. The level's file stays as it is.
@tool
class_name WadiStrokes
extends Node

## Numbers of a stroke: layer, x, y, z in the terrain's space [m], radius [m], amount [m], softness.
const NUMBERS := 7

## All strokes, [constant NUMBERS] floats each.
@export var strokes := PackedFloat32Array():
	set(value):
		if value.size() % NUMBERS != 0:
			push_error("WadiStrokes: strokes: %d numbers; must be a multiple of %d" % [value.size(), NUMBERS])
			return
		strokes = value
		if is_node_ready() and Engine.is_editor_hint():
			show_again()

var _fresh := PackedByteArray()  # the world before any stroke, in the editor


func _ready() -> void:
	if terrain() == null:
		return
	terrain().started.connect(_on_started)
	if terrain().is_started() and _fresh.is_empty():
		_on_started()


## In the editor: the world as it was ahead of strokes that were drawn before this node came.
func begin_from(state: PackedByteArray) -> void:
	_fresh = state


func _get_configuration_warnings() -> PackedStringArray:
	return [] if terrain() != null else ["Must be a child of a WadiTerrain3D."]


func terrain() -> WadiTerrain3D:
	return get_parent() as WadiTerrain3D


func _on_started() -> void:
	if Engine.is_editor_hint():
		_fresh = terrain().save_state()
	_apply()
	if Engine.is_editor_hint() and not strokes.is_empty():
		show_now(terrain())


## Takes the world back to its start and draws all strokes: after an undo, in the editor, where time stands still otherwise.
func show_again() -> void:
	if terrain() == null or not terrain().is_started():
		return
	terrain().load_state(_fresh)
	_apply()
	show_now(terrain())


## Draws what was done to a world in the editor, where no ticks do.
static func show_now(world: WadiTerrain3D) -> void:
	world.step(1)
	world.sync_textures()
	var everywhere: Array[Rect2i] = [Rect2i(Vector2i.ZERO, world.get_cells())]
	world.world_changed.emit(everywhere)


func _apply() -> void:
	for n in range(0, strokes.size(), NUMBERS):
		act(strokes.slice(n, n + NUMBERS))


## One stroke, on the world alone.
func act(stroke: PackedFloat32Array) -> void:
	terrain().brush(roundi(stroke[0]), Vector3(stroke[1], stroke[2], stroke[3]), stroke[4], stroke[5], stroke[6])
