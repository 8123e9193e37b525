#!/bin/sh
# Brings the add-on, its libraries and the levels into this project: setup.sh [folder with addons/wadi as plugin/godot builds it].
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
built=${1:-$root/build/godot}
if [ ! -e "$built/addons/wadi" ]; then
    echo "setup.sh: no $built/addons/wadi: build the extension first (plugin/godot/README.md)" >&2
    exit 2
fi
rm -rf "$here/addons/wadi" "$here/levels"
mkdir -p "$here/addons/wadi" "$here/levels"
cp -RL "$built/addons/wadi/." "$here/addons/wadi"
cp -R "$root/plugin/godot/addons/wadi/." "$here/addons/wadi"
for level in beach canyon; do
    mkdir "$here/levels/$level"
    cp "$root/samples/levels/$level/level.json" "$here/levels/$level"
done
cp "$root/samples/levels/canyon/terrain.png" "$here/levels/canyon"
# A map is read as it is, in exported games too: Godot must not turn it into a texture.
printf '[remap]\n\nimporter="keep"\n' > "$here/levels/canyon/terrain.png.import"
# Ahead of the engine's first look: one without a screen that finds an extension by itself crashes as it ends (godotengine/godot 123511).
mkdir -p "$here/.godot"
[ -e "$here/.godot/extension_list.cfg" ] || echo "res://addons/wadi/wadi.gdextension" > "$here/.godot/extension_list.cfg"
