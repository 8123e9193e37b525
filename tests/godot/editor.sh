#!/usr/bin/env bash
# The editor's brush by mouse and keyboard, on a screen of its own: the beach is opened, its World picked, a stroke drawn and saved; it must
# be in the scene's file, and gone from it after undo. Control: with the brush off nothing is drawn. Usage: editor.sh WORK, where addons/wadi
# is as plugin/godot/build.sh makes it; pictures are left in WORK/editor. Exit status 77 where there is no Godot or no xdotool.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)

if [ "${1:-}" != --on-screen ]; then
    work=$(realpath "$1")/editor
    "$here/godot.sh" --run sh -c 'command -v xdotool' >/dev/null 2>&1 || { echo "editor.sh: no xdotool where Godot is"; exit 77; }
    rm -rf "$work"
    mkdir -p "$work/project"
    "$root/samples/godot/setup.sh" "$1"
    cp -r "$root/samples/godot/." "$work/project"
    mkdir "$work/project/addons/probe"
    cp "$here/editor_probe.gd" "$work/project/addons/probe/probe.gd"
    printf '[plugin]\nname="Probe"\ndescription=""\nauthor=""\nversion=""\nscript="probe.gd"\n' >"$work/project/addons/probe/plugin.cfg"
    sed -i 's|"res://addons/wadi/plugin.cfg"|&, "res://addons/probe/plugin.cfg"|' "$work/project/project.godot"
    sed -e '0,/^\[sub_resource/s//[ext_resource type="Script" path="res:\/\/addons\/wadi\/source.gd" id="source"]\n\n&/' \
        -e 's/^\[node name="Flag"/[node name="Spring" type="Node3D" parent="World"]\ntransform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1.8, 0)\nscript = ExtResource("source")\nradius = 0.8\n\n&/' \
        "$root/samples/godot/beach.tscn" >"$work/project/beach.tscn"
    # Imported ahead: an editor that imports as it starts ends now and then by a fault of a thread of its own (Godot 4.6.3).
    "$here/godot.sh" --headless --path "$work/project" --import >"$work/import.log" 2>&1
    exec "$here/godot.sh" --screen --run "$here/editor.sh" --on-screen "$work"
fi

work=$2
project=$work/project
says=$project/probe.txt
fail() { echo "editor.sh: $1"; cat "$says" || true; tail -n 5 "$work/editor.log"; exit 1; }
known() { grep -q "^$1" "$says" 2>/dev/null; }
wait_for() { # LINE: until the probe says so
    for n in $(seq 120); do
        ! known "$1" || return 0
        kill -0 $editor 2>/dev/null || fail "the editor has ended"
        sleep 0.5
    done
    fail "after a minute there is no \"$1\""
}
place() { sed -n "s/^$1 //p" "$says"; }
click() { # NAME LINE: until the probe says LINE; an editor that is busy may miss one
    for n in 1 2 3 4 5; do
        known "$2" || xdotool mousemove $(place "$1") sleep 0.3 mousedown 1 sleep 0.2 mouseup 1 sleep 2
    done
    wait_for "$2"
}
draw() { # from the middle of the view some way down
    local at=($(place View))
    xdotool mousemove "${at[0]}" "${at[1]}" sleep 0.3 mousedown 1 sleep 0.3
    for n in 1 2 3 4; do xdotool mousemove $((at[0] + 12 * n)) $((at[1] + 8 * n)) sleep 0.3; done
    xdotool mouseup 1 sleep 1
}
control() { # KEY, held for a while, with the focus that no window manager gives here
    xdotool search --onlyvisible --name "Godot" windowfocus sleep 0.5
    xdotool keydown ctrl sleep 0.2 keydown "$1" sleep 0.2 keyup "$1" keyup ctrl sleep 3
}
saved() { # after Control+S: numbers of strokes in the scene's file
    touch -d 2000-01-01 "$project/beach.tscn"
    for n in $(seq 40); do # a key that comes with the focus may be lost
        [ $((n % 8)) != 1 ] || control s
        [ ! "$project/beach.tscn" -nt "$work/import.log" ] || break
        sleep 0.5
    done
    [ "$project/beach.tscn" -nt "$work/import.log" ] || { echo "not saved" && return; }
    grep -A 3 'name="Strokes"' "$project/beach.tscn" | sed -n 's/^strokes = PackedFloat32Array(\(.*\))$/\1/p' | tr ',' '\n' | grep -c . || true
}

godot --editor --single-window --resolution 1280x720 --position 0,0 --rendering-method gl_compatibility --rendering-driver opengl3 \
    --audio-driver Dummy --path "$project" res://beach.tscn >"$work/editor.log" 2>&1 &
editor=$!
trap 'kill -9 $editor 2>/dev/null' EXIT
wait_for World
wait_for "gizmo of a source"
sleep 2
click World "pressed 0"
[ "$(saved)" = 0 ] || fail "the scene was not saved without strokes"
draw
[ "$(saved)" = 0 ] || fail "control: with the brush off something was drawn or nothing saved"
wait_for World
click World "pressed 0"
click Brush "pressed 1"
wait_for "picture 0"
ground=($(place Ground))
draw
wait_for "picture [1-9]"
drawn=($(place Ground))
numbers=$(saved)
[ "$numbers" -gt 0 ] 2>/dev/null && [ $((numbers % 7)) = 0 ] || fail "the scene's file has $numbers numbers of strokes; should be a multiple of 7"
bytes=$(stat -c %s "$project/beach.tscn")
[ "$bytes" -lt 10000 ] || fail "the scene's file has $bytes bytes: it holds what a world shows"
rise=$((drawn[0] - ground[0]))
[ $rise -gt 50 ] && [ $rise -le $((100 * numbers / 7)) ] || fail "the ground rose by $rise mm; $((numbers / 7)) dabs of 100 mm at most"
[ $((drawn[0] - drawn[1])) -ge -1 ] && [ $((drawn[0] - drawn[1])) -le 1 ] || fail "drawn is ${drawn[1]} mm, the world has ${drawn[0]} mm"
for n in 1 2 3 4 5; do known "strokes 0" || control z; done
wait_for "picture 0"
undone=($(place Ground))
[ $((undone[0] - ground[0])) -lt 10 ] && [ $((undone[1] - ground[0])) -lt 10 ] || fail "after undo the ground is ${undone[*]} mm, not ${ground[0]}"
[ "$(saved)" = 0 ] || fail "after undo the scene's file still has strokes"
mv "$project"/probe_*.png "$work"
! grep "SCRIPT ERROR" "$work/editor.log" || fail "errors of scripts"
echo "editor.sh: $((numbers / 7)) dabs drawn, the ground ${rise} mm higher, saved ($bytes bytes), undone"
