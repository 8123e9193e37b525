#!/usr/bin/env bash
# Tests of the Godot extension: builds it, and a C host beside it from the installed library, and runs the scripts of project/ in Godot,
# headless and on a software Vulkan device; then what the add-on draws and the games (play.sh). Usage: run.sh [BUILD] [SCRIPT ...];
# BUILD (build/ci) has the library; SCRIPT: a name below, export, editor or play. Exit status 77 where there is no Godot (godot.sh says why).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(realpath "${1:-$root/build/ci}")
shift || true
work=$build/godot
wanted=("$@")

"$here/godot.sh" --version >/dev/null || exit 77
mkdir -p "$work"
cmake --install "$build" --component plugin --prefix "$work/installed" >"$work/install.log"
library=$work/installed/lib/libwadi.so.1
"$root/plugin/godot/build.sh" --godot "$here/godot.sh" --library "$library" --output "$work"
gcc -std=c99 -O1 -Wall -Wextra -Werror -D_DEFAULT_SOURCE "$here/host.c" -I"$work/installed/include" "$library" -o "$work/host"

# A project as a user has it: the add-on's folder, levels, and a list of extensions as the editor's import would write it.
project=$work/project
rm -rf "$project"
mkdir -p "$project/.godot" "$work/castle"
cp -r "$here/project/." "$here/scene.txt" "$project/"
cp -r "$work/addons" "$project/"
cp -r "$root/samples/levels" "$project/levels"
find "$project/levels" \( -name "*.jpg" -o -name "*.webp" \) -delete # pictures of their pages, which would be imported as textures
echo "res://addons/wadi/wadi.gdextension" >"$project/.godot/extension_list.cfg"
"$here/godot.sh" --headless --path "$project" --import >"$work/import.log" 2>&1 || { tail -n 20 "$work/import.log"; exit 1; }

LD_LIBRARY_PATH=$work/installed/lib "$work/host" "$root/samples/levels/castle/level.json" "$here/scene.txt" "$work/castle" \
    >"$work/castle/hashes.txt"

failed=
asked_for() { [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $1 "* ]]; }
script() { # NAME SCRIPT ENGINE_OPTION ... -- ARGUMENT ...
    local name=$1 file=$2 log=$work/$1.log
    shift 2
    asked_for "$name" || return 0
    local start=$SECONDS
    timeout 120 "$here/godot.sh" "$@" >"$log" 2>&1 && good=yes || good=
    grep -q "^[1-9][0-9]* checks passed, 0 failed$" "$log" || good=
    ! grep -q "SCRIPT ERROR\|leaked at exit\|RIDs of type\|handle_crash" "$log" || good=
    echo "$name: ${good:-FAILED, see $log} ($((SECONDS - start)) s)"
    [ -n "$good" ] || { failed=yes && grep "FAIL\|SCRIPT ERROR\|leaked\|RIDs of\|checks passed" "$log" | head -n 20 || true; }
}
headless() { script "$1" "$2" --headless --path "$project" --script "$2" "${@:3}"; }
drawn() { # METHOD NAME SCRIPT -- ARGUMENT ...
    local driver=vulkan
    [ "$1" != gl_compatibility ] || driver=opengl3
    script "$2" "$3" --screen --rendering-driver $driver --rendering-method "$1" --audio-driver Dummy --path "$project" --script "$3" "${@:4}"
}
window() { drawn mobile "$@"; }
headless hash_cpu hash.gd -- "$work/castle" cpu
headless hash_vulkan hash.gd -- "$work/castle" vulkan
headless docs docs.gd -- "$root/plugin/godot/doc_classes"
headless frames frames.gd --fixed-fps 60
headless saves saves.gd
headless sources sources.gd --fixed-fps 60
headless floats floats.gd --fixed-fps 60
headless bad bad.gd
headless leaks leaks.gd -- "$work/castle" cpu 100 60000
window textures_host hash.gd -- "$work/castle" cpu
window shared shared.gd -- "$work/castle"
window leaks_shared leaks.gd -- "$work/castle" vulkan 30 400 share
window picture picture.gd -- "$work/castle"
drawn forward_plus picture_forward picture.gd -- "$work/castle"
drawn gl_compatibility picture_compatibility picture.gd -- "$work/castle"
drawn mobile renderer_mobile renderer.gd -- shared
drawn forward_plus renderer_forward renderer.gd -- shared
drawn gl_compatibility renderer_compatibility renderer.gd -- copied
if asked_for renderer_compatibility && ! grep -q "share_device: this renderer has no RenderingDevice" "$work/renderer_compatibility.log"; then
    echo "renderer_compatibility: FAILED, does not say why the device is not shared" && failed=yes
fi
window costs costs.gd
if asked_for costs; then grep "^|" "$work/costs.log" || failed=yes; fi
for part in export editor; do
    asked_for $part || continue
    "$here/$part.sh" "$work" >"$work/$part.log" 2>&1 && status=0 || status=$?
    case $status in 0) echo "$part: yes" ;; 77) echo "$part: left out, $(cat "$work/$part.log")" ;; *) failed=yes && cat "$work/$part.log" ;; esac
done
if asked_for play; then "$here/play.sh" "$work" || failed=yes; fi
[ -z "$failed" ] || exit 1
