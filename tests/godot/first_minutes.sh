#!/usr/bin/env bash
# How long a Godot user waits for water: an empty project, the add-on's zip (plugin/godot/package.py) unpacked into it, the first import, the
# lines of the README in the zip, until their water moves on the screen. Usage: first_minutes.sh ZIP [SECONDS], at most so many (120). Keeps
# build/godot/first_minutes/picture.png. Then it plays the games of the
# zip by script. Exit status 1 where it takes longer, nothing moves, there is no sky or a game does not play; 77 without Godot.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
zip=$(realpath "${1:?first_minutes.sh ZIP [SECONDS]}")
limit=${2:-120}
work=$root/build/godot/first_minutes
project=$work/project
fail() { echo "first_minutes.sh: $1" >&2; exit 1; }
"$here/godot.sh" --version >/dev/null || exit 77
rm -rf "$work"
mkdir -p "$project"
cat >"$project/project.godot" <<END
config_version=5
[application]
config/name="First minutes"
run/main_scene="res://main.tscn"
[autoload]
FirstMinutes="*res://first_minutes.gd"
[editor_plugins]
enabled=PackedStringArray("res://addons/wadi/plugin.cfg")
END
"$here/script_scene.sh" Node3D main.gd >"$project/main.tscn"
cp "$here/first_minutes.gd" "$project"

begin=$(date +%s.%N)
since() { awk -v now="${1:-$(date +%s.%N)}" -v begin="$begin" 'BEGIN { printf "%.1f", now - begin }'; }
cp "$zip" "$work/download.zip"
python3 -m zipfile -e "$work/download.zip" "$project"
awk '/^```gdscript/ { inside = 1; next } inside && /^```/ { exit } inside' "$project/addons/wadi/README.md" >"$project/main.gd"
[ -s "$project/main.gd" ] || fail "the README has no lines of GDScript"
echo "unpacked after $(since) s"
# Without a screen, which the editor of a user has: there the run that first finds an extension crashes as it ends (godotengine/godot 123511).
mkdir "$project/.godot"
echo "res://addons/wadi/wadi.gdextension" >"$project/.godot/extension_list.cfg"
timeout 300 "$here/godot.sh" --headless --path "$project" --import >"$work/import.log" 2>&1 || { tail -n 20 "$work/import.log" >&2; fail "the import failed"; }
! grep "ERROR" "$work/import.log" | grep -v X509 >&2 || fail "the import has errors"
echo "imported after $(since) s"
run() { # PICTURE SECONDS; a small window, since software draws it
    timeout 600 "$here/godot.sh" --screen --audio-driver Dummy --resolution 640x360 --path "$project" -- "$1" "$2" >"$work/run.log" 2>&1
}
run "$work/picture.png" "$limit" && status=0 || status=$?
moved=$(sed -n 's/^water moves at //p' "$work/run.log")
[ -n "$moved" ] || { tail -n 20 "$work/run.log" >&2; fail "the water does not move within $limit s"; }
[ $status -ne 2 ] || fail "there is no sky: $(grep top "$work/run.log"), see $work/picture.png"
[ $status -eq 0 ] || { tail -n 20 "$work/run.log" >&2; fail "the scene ended with status $status"; }
! grep "ERROR" "$work/run.log" | grep -v X509 >&2 || fail "the scene has errors" # X509: this engine's system has no certificates
seconds=$(since "$moved")
times >"$work/times.txt" # of a subshell there would be none
echo "water moves after $seconds s; user and system time with what follows up to $work/picture.png: $(tail -n 1 "$work/times.txt")"
awk -v took="$seconds" -v limit="$limit" 'BEGIN { exit took > limit }' || fail "that is more than $limit s"

# Control: water that stands does not count.
sed -i 's/^\( *\)add_child(terrain).*/\1terrain.running = false\n&/' "$project/main.gd"
! run "$work/control.png" 15 || fail "water that stands counts as moving"
grep -q "the water stands" "$work/run.log" || { tail -n 20 "$work/run.log" >&2; fail "the control failed otherwise"; }

# The games in the zip, by script, a second each.
sed -i '/^\[autoload\]/,/^FirstMinutes/d' "$project/project.godot"
for game in beach:120x96 canyon:100x128; do
    timeout 300 "$here/godot.sh" --headless --path "$project" --fixed-fps 60 "res://demo/${game%:*}.tscn" -- --script-run --backend=cpu --cells="${game#*:}" --until=1 \
        >"$work/${game%:*}.log" 2>&1 && grep -q "hash [0-9a-f]\{16\}" "$work/${game%:*}.log" || { tail -n 20 "$work/${game%:*}.log" >&2; fail "demo/${game%:*}.tscn does not play"; }
done
echo "the demo plays"
