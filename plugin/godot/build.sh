#!/usr/bin/env bash
# Builds the Godot extension and lays the add-on out, ready to be copied into a project; --help says what it needs.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)

library=$root/build/release/lib/libwadi.so.1
godot=godot
output=$root/build/godot
debug=
usage() {
    cat <<EOF
Usage: build.sh [--godot COMMAND] [--library FILE] [--output FOLDER] [--debug]
  --godot COMMAND   what starts the engine, 4.4 or later (godot): its own interface is what the extension is compiled against
  --library FILE    the library (build/release/lib/libwadi.so.1: cmake --preset release && cmake --build --preset release)
  --output FOLDER   where addons/wadi is laid out (build/godot)
  --debug           with debug information, without optimisation
Needs gcc, python3 and the Vulkan headers (Debian: gcc python3 libvulkan-dev).
EOF
}
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) usage && exit ;;
    --debug) debug=yes && shift && continue ;;
    --godot | --library | --output) [ $# -gt 1 ] || { echo "build.sh: $1 needs a value" >&2; exit 2; } ;;
    *) echo "build.sh: unknown option \"$1\"; --help lists them" >&2; exit 2 ;;
    esac
    case $1 in
    --godot) godot=$2 ;;
    --library) library=$2 ;;
    --output) output=$2 ;;
    esac
    shift 2
done
[ -e "$library" ] || { echo "build.sh: there is no library \"$library\"; --library FILE" >&2; exit 1; }
mkdir -p "$output/addons/wadi" "$output/interface" "$output/objects"
library=$(realpath "$library")
output=$(cd "$output" && pwd)
[ ! -f "$godot" ] || godot=$(realpath "$godot")

# The engine's interface, anew for another engine.
version=$($godot --version 2>/dev/null | tail -n 1) || { echo "build.sh: \"$godot\" does not start; --godot COMMAND" >&2; exit 1; }
if [ "$(cat "$output/interface/version" 2>/dev/null)" != "$version" ]; then
    (cd "$output/interface" && $godot --headless --dump-gdextension-interface --dump-extension-api --quit >dump.log 2>&1) ||
        { cat "$output/interface/dump.log"; exit 1; }
    echo "$version" >"$output/interface/version"
fi
python3 "$here/generate.py" "$output/interface/extension_api.json" "$here/source" "$here/doc_classes" "$output/interface"

flags=(-std=c11 -fPIC -fvisibility=hidden -Wall -Wextra -Werror -I"$output/interface" -I"$here/source" -I"$root/plugin/include")
[ -n "$debug" ] && flags+=(-O0 -g) || flags+=(-O2)
objects=()
for source in "$here"/source/*.c "$here"/source/*/*.c "$output"/interface/*.c; do
    [ -e "$source" ] || continue
    object=$output/objects/$(basename "$source" .c).o
    gcc "${flags[@]}" -c "$source" -o "$object"
    objects+=("$object")
done
rm -f "$output/addons/wadi/libwadi_godot.so"
gcc -shared -o "$output/addons/wadi/libwadi_godot.so" "${objects[@]}" "$library" -Wl,-rpath,'$ORIGIN' -Wl,--no-undefined -lm -ldl

# A new file each time: an engine that runs keeps those that it has open.
cp --remove-destination "$library" "$output/addons/wadi/libwadi.so.1"
cp -r "$here/addons/wadi/." "$output/addons/wadi/"
echo "$output/addons/wadi: for $version"
