#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds, records a level, draws it in three dimensions where it can. Usage: demo.sh [LEVEL]
set -euo pipefail

level=${1:-canyon}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
if [[ ! -f samples/levels/$level/level.json ]]; then
    echo "demo.sh: no level \"$level\"; the levels are: $(cd samples/levels && printf '%s ' */ | tr -d /)" >&2
    exit 2
fi
build=build/demo
out=out/$level
log=$build/demo.log
mkdir -p "$build"

step=0
task() { # TITLE COMMAND...: runs a task and says when it began
    echo "== $((++step))/5 $1 ($SECONDS s)"
    "${@:2}"
}
logged() { # COMMAND...: of what it says each quarter of the files that it makes; the rest is for the log, and for the screen if it fails
    if ! "$@" 2>&1 | tee "$log" |
        awk -F'[][/]' '/^\[[0-9]+\/[0-9][0-9]+\]/ && int(4 * $2 / $3) > shown { shown = int(4 * $2 / $3); print "   " $2 " of " $3; fflush() }'; then
        tail -n 20 "$log"
        echo "demo.sh: that failed; all that it said is in $log" >&2
        exit 1
    fi
}

# A build of its own: without CUDA where there is no GPU for it, since its code for every generation of cards takes minutes to compile.
options=()
[[ -e /dev/nvidiactl ]] || options+=(-DWADI_CUDA=OFF)
task packages samples/install_packages.sh demo
task configure logged cmake --preset demo "${options[@]}"
grep -A 9 "^-- Wadi" "$log" | grep "^   "
targets=(wadi-recorder)
! grep -q "WADI_HAS_VIEWER:INTERNAL=ON" "$build/CMakeCache.txt" || targets+=(wadi-viewer)
task "build ${targets[*]}" logged cmake --build "$build" --target "${targets[@]}"
# The canyon lasts 70 s: a picture every 6.5 s makes twelve, all of them on the contact sheet. On half of its cells it takes a third
# of the time and looks the same on them.
options=()
[[ $level == canyon ]] && options=(--size 144x184 --dt 0.02 --every 6.5)
task "record $level" "$build/bin/wadi-recorder" "$level" "${options[@]}" --out "$out"

# Three moments, where the viewer was built and a Vulkan device (a software one will do) draws them.
draw() {
    rm -rf "$out/viewer" # pictures that are there are not drawn again
    if [[ ${#targets[@]} -eq 1 ]]; then
        echo "left out: see the line \"Viewer\" of the configure report"
    elif [[ -z $("$build/bin/wadi-viewer" --list-gpus) ]]; then
        echo "left out: no Vulkan device"
    elif samples/levels/gallery.py "$build/bin/wadi-viewer" "$level" --only moments --panels "$out/viewer" --quality low --size 640x360 --coarse 2 --backend cpu; then
        pictures="$out/viewer"
    fi
}
pictures=
task "draw $level in three dimensions" draw

echo
echo "Ready in $SECONDS s. Look at"
echo "  $root/$out/contact_sheet.png"
echo "  $root/$out/frame_*.png"
[[ -z $pictures ]] || echo "  $root/$pictures/*.jpg ($build/bin/wadi-viewer $level is a window)"
