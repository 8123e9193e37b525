#!/usr/bin/env bash
# What the add-on draws and what the sample project plays, headless: play.sh [folder with addons/wadi as plugin/godot/build.sh makes it].
# Each check has a control that must fail. Exit status 77 where there is no Godot.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
project=$root/samples/godot
log=$(mktemp)
trap 'rm -f "$log"' EXIT

godot() { timeout 600 "$here/godot.sh" --headless --path "$project" "$@" >"$log" 2>&1; }
fail() { echo "play.sh: $1" >&2; tail -n 20 "$log" >&2; exit 1; }

godot --version || { status=$?; cat "$log" >&2; exit $status; }
"$project/setup.sh" ${1:+"$1"}

# The editor loads the add-on with its tool and compiles every script; a fault is said, not returned.
godot --editor --quit-after 60 || fail "the editor ended with an error"
if grep -E "SCRIPT ERROR|SHADER ERROR|Parse Error|Failed to load|plugin.*disabled" "$log"; then fail "the editor found faults"; fi

check() { # NAME CONTROLS...
    local name=$1
    shift
    godot --fixed-fps 60 --script "$here/play_$name.gd" || fail "$name"
    tail -n 1 "$log"
    for control; do
        if godot --fixed-fps 60 --script "$here/play_$name.gd" -- "$control"; then fail "$name $control: passed, and should not"; fi
        grep -q FAILED "$log" || fail "$name $control: ended without a finding"
    done
}
check meshes --unsewn --still
check strokes
check collision --fixed

games() { # [CONTROL]: start and end screens, score, tools and sounds
    WADI_CONTROL=${1:-} godot --fixed-fps 60 --script "$here/play_games.gd" -- --backend=cpu
}
games || fail "games"
if grep -E "ERROR|leaked" "$log"; then fail "games: errors or what is left over"; fi
tail -n 1 "$log"
for control in unkept untold silent hidden; do
    if games $control; then fail "games $control: passed, and should not"; fi
    grep -q FAILED "$log" || fail "games $control: ended without a finding"
done

play() { # SCENE VERDICT ARGUMENTS...
    local scene=$1 verdict=$2
    shift 2
    godot --fixed-fps 60 "res://$scene.tscn" -- --script-run --backend=cpu "$@" || fail "$scene $*: ended with an error"
    grep -q "^verdict $verdict " "$log" || fail "$scene $*: the verdict should be $verdict"
    hash=$(grep "^hash" "$log") || fail "$scene $*: no hash"
    if grep -E "ERROR|leaked" "$log"; then fail "$scene $*: errors or what is left over"; fi
    grep -E "^verdict|^hash" "$log"
}
twice() { # SCENE CELLS: played twice alike and won; left alone another hash, and lost
    play "$1" WON --cells="$2"
    local first=$hash
    play "$1" WON --cells="$2"
    [ "$hash" = "$first" ] || fail "$1: $hash, and before $first"
    play "$1" LOST --cells="$2" --idle
    [ "$hash" != "$first" ] || fail "$1: what the script does leaves no trace in the hash"
}
twice beach 120x96
twice canyon 100x128
# The hardest of each game's choices can be won.
play beach WON --cells=120x96 --choice=2
play canyon WON --cells=100x128 --choice=1
echo "play.sh: right"
