#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds the recorder, records a level, shows it in 3D where it can. Usage: demo.sh [LEVEL]
set -euo pipefail

level=${1:-canyon}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
if [[ ! -f samples/levels/$level/level.json ]]; then
    echo "demo.sh: no level \"$level\"; the levels are: $(cd samples/levels && printf '%s ' */ | tr -d /)" >&2
    exit 2
fi

task() { # TITLE COMMAND...: runs a task and says how long it took
    local title=$1 start=$SECONDS
    shift
    echo "== $title"
    "$@"
    echo "== $title: done in $((SECONDS - start)) s"
}

# A build of its own: without CUDA where there is no GPU for it, since its code for every generation of cards takes minutes to compile.
build=build/demo
options=(-DWADI_TESTS=OFF)
[[ -e /dev/nvidiactl ]] || options+=(-DWADI_CUDA=OFF)
task "1/4 packages" samples/install_packages.sh
task "2/4 configure" cmake --preset release -B "$build" "${options[@]}"
task "3/4 build" cmake --build "$build" --target wadi-recorder
# The canyon lasts 70 s: a picture every 6.5 s makes twelve, all of them on the contact sheet.
every=()
[[ $level == canyon ]] && every=(--every 6.5)
task "4/4 record $level" "$build/bin/wadi-recorder" "$level" "${every[@]}" --out "out/$level"

# Three moments in three dimensions, where the viewer can be built and a Vulkan device (a software one will do) draws them.
viewer=$build/bin/wadi-viewer
draw() {
    cmake --build "$build" --target wadi-viewer && [[ -n $("$viewer" --list-gpus) ]] &&
        samples/levels/gallery.py "$viewer" "$level" --moments 3 --quality low --size 640x360 --coarse 2 --backend cpu --out "out/$level/viewer"
}
pictures=
if grep -q "WADI_HAS_VIEWER:INTERNAL=ON" "$build/CMakeCache.txt"; then
    start=$SECONDS
    echo "== viewer"
    draw && pictures="out/$level/viewer"
    echo "== viewer: ended after $((SECONDS - start)) s"
fi

echo
echo "Ready in $SECONDS s. Look at"
echo "  $root/out/$level/contact_sheet.png"
echo "  $root/out/$level/frame_*.png"
if [[ -n $pictures ]]; then
    echo "  $root/$pictures/*.png ($build/bin/wadi-viewer $level is a window)"
else
    echo "(no pictures in three dimensions: see the line \"Viewer\" of the configure report, or the viewer's message above)"
fi
