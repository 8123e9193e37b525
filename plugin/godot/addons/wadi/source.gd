@tool
## Pours water or sand into a running [WadiTerrain3D] where it stands, or takes it away.
##
## It is a source of the world. What changes here (place, [member discharge], [member running] ...) changes the source ahead of the
## terrain's next physics tick: one call for each change, none while nothing changes, all of them in the command log. Leaving the tree,
## a pause and a disabled [member Node.process_mode] stop it while the terrain goes on. Beyond the grid it pours nothing.
## [br][br]
## A move costs the world more than another discharge (the add-on's page says how much). What moves in every tick may pour by
## [method WadiTerrain3D.brush] instead.
@icon("icons/WadiSource3D.svg")
class_name WadiSource3D
extends Node3D

## The terrain; empty: the parent.
@export var terrain: WadiTerrain3D:
	set(value):
		_follow(value)
		terrain = value
## Whether it pours.
@export var running := true
## Sand or water.
@export_enum("Sand:1", "Water:2") var layer: int = WadiTerrain3D.LAYER_WATER:
	set(value):
		layer = value
		update_gizmos()
## Volume in a second of the world's time [m3/s]; below 0 it takes, no more than there is. The cells whose middles are within the disc
## share it, or, where there are none, the cell below takes all.
@export var discharge := 0.5
## Of the disc that it pours over [m].
@export_range(0.01, 100, 0.01, "or_greater", "suffix:m") var radius := 1.0:
	set(value):
		radius = value
		update_gizmos()

var _index := -1  # of the world's source, from the first time that it pours until it leaves
var _said := []  # what the world was told of it last


func _ready() -> void:
	process_physics_priority = -1  # ahead of the terrain's tick
	if terrain == null:
		terrain = get_parent() as WadiTerrain3D
	if terrain == null:
		push_error("WadiSource3D: no WadiTerrain3D: set `terrain` or make this its child")
	_update()


func _get_configuration_warnings() -> PackedStringArray:
	if terrain == null and not get_parent() is WadiTerrain3D:
		return ["No terrain: set `terrain` or make this a child of a WadiTerrain3D."]
	return []


func _physics_process(_delta: float) -> void:
	_update()


func _notification(what: int) -> void:
	match what:
		NOTIFICATION_ENTER_TREE, NOTIFICATION_PAUSED, NOTIFICATION_UNPAUSED, NOTIFICATION_DISABLED, NOTIFICATION_ENABLED:
			if is_node_ready():
				_update()
		NOTIFICATION_EXIT_TREE:
			_leave()


func _follow(other: WadiTerrain3D) -> void:
	if other == terrain or Engine.is_editor_hint():
		return
	_leave()
	if is_instance_valid(terrain):
		terrain.started.disconnect(_on_started)
		terrain.state_loaded.disconnect(_on_state_loaded)
	if other != null:
		other.started.connect(_on_started)
		other.state_loaded.connect(_on_state_loaded)


func _has_world() -> bool:
	return is_instance_valid(terrain) and terrain.is_started()


## A new world knows nothing of this.
func _on_started() -> void:
	_index = -1
	_said = []
	_update()


## The state may have another source of that number, or none.
func _on_state_loaded() -> void:
	if _index >= 0:
		terrain.callv("set_source", [_index] + _said)


func _leave() -> void:
	if _index >= 0 and _has_world():
		terrain.close_source(_index)
	_index = -1
	_said = []


func _update() -> void:
	if Engine.is_editor_hint() or not is_inside_tree() or not _has_world():
		return
	if running and discharge != 0 and (can_process() or not (terrain.is_inside_tree() and terrain.can_process())):
		_say([layer, position if get_parent() == terrain else terrain.to_local(global_position), radius, discharge])
	elif _index >= 0:
		_say(_said.slice(0, 3) + [0.0])  # where it is: another place costs more


## What the world refused is not said again until it changes.
func _say(what: Array) -> void:
	if what == _said:
		return
	_said = what
	if _index < 0:
		_index = terrain.callv("open_source", what)
	else:
		terrain.callv("set_source", [_index] + what)
