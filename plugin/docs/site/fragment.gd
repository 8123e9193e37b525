# What blocks of GDScript on pages assume, when they are no whole scripts: godot_blocks.py compiles each behind this.
extends Node3D
var terrain: WadiTerrain3D
