#!/usr/bin/env bash
# Builds the Godot extension for one system and lays the add-on out, ready to be copied into a project; --help says what it needs.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)

system=linux.$(uname -m | sed s/aarch64/arm64/)
compiler=gcc
library=$root/build/release/lib/libwadi.so.1
import_library=
godot=godot
interface=
headers=/usr/include
output=$root/build/godot
debug=
usage() {
    cat <<EOF
Usage: build.sh [--system SYSTEM] [--cc COMMAND] [--library FILE] [--godot COMMAND | --interface FOLDER] [--output FOLDER] ...
  --system SYSTEM   linux.x86_64, linux.arm64, windows.x86_64, macos.x86_64 or macos.arm64 ($system, this machine's)
  --cc COMMAND      a C compiler for that system ($compiler)
  --library FILE    the library of that system (build/release/lib/libwadi.so.1: cmake --preset release && cmake --build --preset release)
  --import-library FILE  Windows: what to link where the compiler cannot link libwadi.dll itself, libwadi.dll.a
  --godot COMMAND   what starts the engine, 4.4 or later (godot): its own interface is what the extension is compiled against
  --interface FOLDER     or what an engine wrote: gdextension_interface.h and extension_api.json (OUTPUT/interface of an earlier call)
  --headers FOLDER  has the folders vulkan and vk_video ($headers)
  --output FOLDER   where addons/wadi is laid out (build/godot); several calls may fill one folder, a system each
  --debug           with debug information, without optimisation
Needs the compiler, python3 and the Vulkan headers (Debian: gcc python3 libvulkan-dev).
EOF
}
refuse() { echo "build.sh: $1" >&2; exit "${2:-1}"; }
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) usage && exit ;;
    --debug) debug=yes && shift && continue ;;
    --system | --cc | --library | --import-library | --godot | --interface | --headers | --output) [ $# -gt 1 ] || refuse "$1 needs a value" 2 ;;
    *) refuse "unknown option \"$1\"; --help lists them" 2 ;;
    esac
    case $1 in
    --system) system=$2 ;;
    --cc) compiler=$2 ;;
    --library) library=$2 ;;
    --import-library) import_library=$2 ;;
    --godot) godot=$2 ;;
    --interface) interface=$2 ;;
    --headers) headers=$2 ;;
    --output) output=$2 ;;
    esac
    shift 2
done

# Names as wadi.gdextension has them; each library looks for libwadi in its own folder, which Windows does by itself.
kind=posix
case $system in
linux.x86_64 | linux.arm64) folder=$system extension=libwadi_godot.so wadi=libwadi.so.1 own=(-fPIC) link=(-Wl,-rpath,'$ORIGIN' -Wl,--no-undefined -lm -ldl) ;;
macos.x86_64 | macos.arm64) folder=macos extension=libwadi_godot.dylib wadi=libwadi.1.dylib own=(-fPIC) link=(-Wl,-rpath,@loader_path "-Wl,-install_name,@rpath/libwadi_godot.dylib") ;;
windows.x86_64) # GCC checks formats there by those of Microsoft's old printf, which is not the one that is called
    folder=$system extension=wadi_godot.dll wadi=libwadi.dll own=(-D__USE_MINGW_ANSI_STDIO=1 -Wno-format -Wno-format-extra-args) link=(-static-libgcc) kind=windows ;;
*) refuse "--system: \"$system\" is none of linux.x86_64, linux.arm64, windows.x86_64, macos.x86_64, macos.arm64" 2 ;;
esac
[ -e "$library" ] || refuse "there is no library \"$library\"; --library FILE"
[ -z "$import_library" ] || [ -e "$import_library" ] || refuse "there is no import library \"$import_library\"; --import-library FILE"
[ -e "$headers/vulkan/vulkan_core.h" ] || refuse "there is no \"$headers/vulkan/vulkan_core.h\"; --headers FOLDER"
objects=$output/objects/$system
bin=$output/addons/wadi/bin/$folder
mkdir -p "$bin" "$objects" "$output/generated" "$output/headers"
library=$(realpath "$library")
headers=$(realpath "$headers")
output=$(cd "$output" && pwd)
[ ! -f "$godot" ] || godot=$(realpath "$godot")

# The engine's interface, anew for another engine.
if [ -z "$interface" ]; then
    interface=$output/interface
    mkdir -p "$interface"
    version=$($godot --version 2>/dev/null | tail -n 1) || refuse "\"$godot\" does not start; --godot COMMAND"
    if [ "$(cat "$interface/version" 2>/dev/null)" != "$version" ]; then
        (cd "$interface" && $godot --headless --dump-gdextension-interface --dump-extension-api --quit >dump.log 2>&1) ||
            { cat "$interface/dump.log"; exit 1; }
        echo "$version" >"$interface/version"
    fi
fi
for file in gdextension_interface.h extension_api.json; do
    [ -e "$interface/$file" ] || refuse "there is no \"$interface/$file\"; --interface FOLDER"
done
version=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["header"]["version_full_name"])' "$interface/extension_api.json")
python3 "$here/generate.py" "$interface/extension_api.json" "$here/source" "$here/doc_classes" "$output/generated"

# Vulkan's headers in a folder of their own: beside them may lie those of this machine's C library.
ln -sfn "$headers/vulkan" "$output/headers/vulkan"
ln -sfn "$headers/vk_video" "$output/headers/vk_video"
flags=(-std=gnu11 "${own[@]}" -fvisibility=hidden -Wall -Wextra -Werror -I"$interface" -I"$output/generated" -I"$here/source" -I"$root/plugin/include" -isystem "$output/headers")
if [ -n "$debug" ]; then flags+=(-O0 -g); else flags+=(-O2) && link+=(-s); fi
# A library without Vulkan has no calls for the renderer's device.
if grep -q wadi_vulkan_copy_output "$library"; then without=shared_device_none.c; else without="shared_device.c vulkan_calls.c"; fi
made=()
for source in "$here"/source/*.c "$here"/source/*/*.c "$output"/generated/*.c; do
    name=$(basename "$source")
    case " $without " in *" $name "*) continue ;; esac
    case $name in system_*) [ "$name" = "system_$kind.c" ] || continue ;; esac
    $compiler "${flags[@]}" -c "$source" -o "$objects/${name%.c}.o"
    made+=("$objects/${name%.c}.o")
done
$compiler -shared -o "$objects/$extension" "${made[@]}" "${import_library:-$library}" "${link[@]}"

# New files each time: an engine that runs keeps those that it has open.
place() { # FILE NAME: on macOS one file has the programs of all processors built so far
    rm -f "$bin/$2"
    if [ "$folder" = macos ]; then
        [ "$1" -ef "$objects/$2" ] || cp "$1" "$objects/$2"
        python3 "$here/universal.py" "$bin/$2" "$output"/objects/macos.*/"$2"
    else
        cp "$1" "$bin/$2"
    fi
}
place "$objects/$extension" "$extension"
place "$library" "$wadi"
cp -r "$here/addons/wadi/." "$output/addons/wadi/"
echo "$output/addons/wadi: $system, for $version"
