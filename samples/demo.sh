#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds the recorder, records a level. Usage: demo.sh [LEVEL]
set -euo pipefail

level=${1:-canyon}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
if [[ ! -f samples/levels/$level/level.json ]]; then
    echo "demo.sh: no level \"$level\"; the levels are: $(cd samples/levels && printf '%s ' */ | tr -d /)" >&2
    exit 2
fi

phase() { # TITLE COMMAND...: runs a phase and says how long it took
    local title=$1 start=$SECONDS
    shift
    echo "== $title"
    "$@"
    echo "== $title: done in $((SECONDS - start)) s"
}

phase "1/4 packages" samples/install_packages.sh
phase "2/4 configure" cmake --preset release
phase "3/4 build" cmake --build --preset release --target wadi-recorder
# The canyon lasts 70 s: a picture every 6.5 s makes twelve, all of them on the contact sheet.
every=()
[[ $level == canyon ]] && every=(--every 6.5)
phase "4/4 record $level" build/release/bin/wadi-recorder "$level" "${every[@]}" --out "out/$level"

echo
echo "Ready in $SECONDS s. Look at"
echo "  $root/out/$level/contact_sheet.png"
echo "  $root/out/$level/frame_*.png"
