#!/usr/bin/env bash
# Writes a scene file whose root is a node with a script. Usage: script_scene.sh NODE_TYPE SCRIPT_NAME; the script is at res://SCRIPT_NAME.
set -euo pipefail
cat <<END
[gd_scene format=3]
[ext_resource type="Script" path="res://$2" id="script"]
[node name="Root" type="$1"]
script = ExtResource("script")
END
