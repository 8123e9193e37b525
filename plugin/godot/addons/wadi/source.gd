@tool
## Pours water or sand into a running [WadiTerrain3D] where it stands, or takes it away.
##
## Moves freely: a brush at every physics tick of the terrain, so that what is poured is in the command log and in the ledger.
@icon("icons/WadiSource3D.svg")
class_name WadiSource3D
extends Node3D

## The terrain; empty: the parent.
@export var terrain: WadiTerrain3D
@export var layer := WadiTerrain3D.LAYER_WATER:
	set(value):
		layer = value
		update_gizmos()
## Volume in a second of the world's time [m3/s]; below 0 it takes, no more than there is.
@export var discharge := 0.5
## Of the disc that it pours over [m].
@export_range(0.01, 100, 0.01, "or_greater", "suffix:m") var radius := 1.0:
	set(value):
		radius = value
		update_gizmos()
## Share of the radius over which the amount falls to 0.
@export_range(0, 1, 0.01) var softness := 0.5


func _ready() -> void:
	if terrain == null:
		terrain = get_parent() as WadiTerrain3D
	if terrain == null:
		push_error("WadiSource3D: no WadiTerrain3D: set `terrain` or make this its child")


func _get_configuration_warnings() -> PackedStringArray:
	if terrain == null and not get_parent() is WadiTerrain3D:
		return ["No terrain: set `terrain` or make this a child of a WadiTerrain3D."]
	return []


func _physics_process(delta: float) -> void:
	if Engine.is_editor_hint() or terrain == null or not terrain.is_started() or not terrain.running or discharge == 0:
		return
	var volume := discharge * delta * terrain.time_scale
	terrain.brush(layer, terrain.to_local(global_position), radius, volume / (PI * radius * radius * mean_weight(softness)), softness)


## Of a brush's weight over its disc: 1 up to the share 1 - s of the radius, from there falling to 0 as 3 t^2 - 2 t^3 does.
static func mean_weight(s: float) -> float:
	var full := 1 - s
	return full * full + full * s + 0.3 * s * s
