#!/usr/bin/env bash
# Runs the add-on's Windows libraries under Wine: a stand-in for the engine (fake/play_extension.c) loads them, plays scene.txt on the castle,
# and must get the hashes, textures and heights of a C host (host.c) built for Windows, and those of the Linux libraries where the add-on has
# them. Usage: windows.sh ADDON INTERFACE COMPILER [WORK]
#   ADDON      addons/wadi as plugin/godot/build.sh lays it out, with bin/windows.x86_64
#   INTERFACE  the folder with an engine's gdextension_interface.h
#   COMPILER   a C compiler for Windows: what plugin/packaging/zig.sh makes, or x86_64-w64-mingw32-gcc-posix
#   WORK       a folder for what is made (build/godot/windows)
# Exit status 77 and a reason where there is no Wine.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
[ $# -ge 3 ] || { sed -n '2,9s/^# //p' "$0" >&2; exit 2; }
addon=$(realpath "$1") interface=$(realpath "$2") compiler=$3
work=$(realpath -m "${4:-$root/build/godot/windows}")
libraries=$addon/bin/windows.x86_64
fail() { echo "windows.sh: $1" >&2; exit 1; }
[ -e "$libraries/wadi_godot.dll" ] || fail "there is no \"$libraries/wadi_godot.dll\""
wine=$(command -v wine64 || ls /usr/lib/wine/wine64 2>/dev/null) || { echo "windows.sh: no Wine (samples/install_packages.sh packaging)" >&2; exit 77; }
export WINEDEBUG=-all WINEPREFIX=$work/wine
rm -rf "$work"/{play,host,native,other,bare,program}
mkdir -p "$work"/{play,host,native,other,bare,program}

flags=(-O1 -Wall -Wextra -Werror -I"$interface" -I"$root/plugin/godot/source" -I"$root/plugin/include")
player=("$here/fake/stand_in.c" "$here/fake/play_extension.c")
$compiler -std=gnu11 "${flags[@]}" "${player[@]}" "$here/fake/open_extension_windows.c" -o "$work/player.exe"
$compiler -std=gnu99 -D__USE_MINGW_ANSI_STDIO=1 -Wno-format -Wno-format-extra-args "${flags[@]}" "$here/host.c" "$libraries/libwadi.dll" -o "$work/program/host.exe"
cp "$libraries/libwadi.dll" "$work/program"

levels=$root/samples/levels
castle=$levels/castle/level.json
map=$levels/canyon/terrain.png
in_wine() { timeout 600 "$wine" "$@" | tr -d '\r'; }
play() { # FOLDER EXTENSION [FACTOR]
    in_wine "$work/player.exe" "$2" "$castle" "$here/scene.txt" "$1" "$map" ${3:-} >"$1/hashes.txt" 2>"$1/log.txt"
}

in_wine "$work/program/host.exe" "$castle" "$here/scene.txt" "$work/host" >"$work/host/hashes.txt" 2>"$work/host/log.txt" ||
    { cat "$work/host/log.txt" >&2; fail "the C host failed"; }
[ "$(grep -c '^[0-9a-f]\{16\}$' "$work/host/hashes.txt")" = 4 ] || fail "the C host printed no four hashes"
play "$work/play" "$libraries/wadi_godot.dll" || { cat "$work/play/log.txt" >&2; fail "the extension failed"; }
diff -r -x log.txt "$work/host" "$work/play" >&2 || fail "the extension's results are not the host's"

# Controls: other amounts give other hashes, and without libwadi beside it the extension does not start.
play "$work/other" "$libraries/wadi_godot.dll" 1.0625 || { cat "$work/other/log.txt" >&2; fail "the control with other amounts failed"; }
! cmp -s "$work/play/hashes.txt" "$work/other/hashes.txt" || fail "the control with other amounts has the same hashes"
cp "$libraries/wadi_godot.dll" "$work/bare"
! play "$work/bare" "$work/bare/wadi_godot.dll" || fail "the extension started without libwadi.dll"
grep -q "cannot open the extension" "$work/bare/log.txt" || { cat "$work/bare/log.txt" >&2; fail "the control without libwadi.dll failed otherwise"; }

same=""
native=$addon/bin/linux.$(uname -m | sed s/aarch64/arm64/)
if [ -e "$native/libwadi_godot.so" ]; then
    gcc -std=gnu11 "${flags[@]}" "${player[@]}" "$here/fake/open_extension_posix.c" -o "$work/player" -lm -ldl
    "$work/player" "$native/libwadi_godot.so" "$castle" "$here/scene.txt" "$work/native" "$map" >"$work/native/hashes.txt" 2>"$work/native/log.txt" ||
        { cat "$work/native/log.txt" >&2; fail "the extension for Linux failed"; }
    diff -r -x log.txt "$work/native" "$work/play" >&2 || fail "results on Windows are not those on Linux"
    same=", equal to those of Linux"
fi
echo "Windows, under Wine $("$wine" --version | tr -d '\r'): $(tail -n 1 "$work/play/hashes.txt"), $(ls "$work/play" | grep -c 'bin$') textures and heights$same"
