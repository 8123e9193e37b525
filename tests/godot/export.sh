#!/usr/bin/env bash
# Exports samples/godot as a game and runs it where no project is: the extension's libraries and the levels must come with it, and each
# scene must end with the hash that it has in the project. Usage: export.sh WORK, where addons/wadi is as plugin/godot/build.sh makes it.
# Exit status 77 where there is no export template.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=$(realpath "$1")/export
log=$work/log.txt
fail() { echo "export.sh: $1" >&2; tail -n 20 "$log" >&2; exit 1; }

rm -rf "$work"
mkdir -p "$work/project" "$work/game"
template=$("$here/godot.sh" --run sh -c 'command -v godot-template-release || ls ~/.local/share/godot/export_templates/4.*/linux_release.x86_64' \
    2>/dev/null | tail -n 1) || { echo "export.sh: no export template (Debian: godot-template-release)"; exit 77; }
"$root/samples/godot/setup.sh" "$1"
cp -r "$root/samples/godot/." "$here/export.gd" "$work/project"
find "$work/project/.godot" -mindepth 1 ! -name extension_list.cfg -delete # imports anew
sed -i "s|^\[preset.0.options\]|&\ncustom_template/release=\"$template\"|" "$work/project/export_presets.cfg"
"$here/script_scene.sh" Node export.gd >"$work/project/export.tscn"

scenes="beach canyon export"
arguments() {
    case $1 in
    beach) echo -- --script-run --backend=cpu --cells=120x96 --until=3 ;;
    canyon) echo -- --script-run --backend=cpu --cells=100x128 --until=3 ;;
    esac
}
export_to() { timeout 300 "$here/godot.sh" --headless --path "$work/project" --export-release Linux "$1" >"$log" 2>&1 || fail "the export ended with an error"; }
run_game() { # SCENE: an engine's file beside the game says what the main scene is
    printf '[application]\nrun/main_scene="res://%s.tscn"\n' "$1" >"$work/game/override.cfg"
    # From another folder, so that nothing is found by the present one.
    (cd "$work" && timeout 300 "$here/godot.sh" --run "$work/game/wadi.x86_64" --headless --fixed-fps 60 $(arguments "$1")) >"$log" 2>&1
}
hashes() { grep "hash [0-9a-f]\{16\}" "$log" || fail "$1: no hash"; }

export_to "$work/game/wadi.x86_64"
for scene in $scenes; do
    timeout 300 "$here/godot.sh" --headless --path "$work/project" --fixed-fps 60 "res://$scene.tscn" $(arguments $scene) >"$log" 2>&1 ||
        fail "$scene in its project: ended with an error"
    hashes "$scene in its project" >"$work/$scene.txt"
done
mv "$work/project" "$work/away"
for scene in $scenes; do
    run_game $scene || fail "$scene exported: ended with an error"
    ! grep "ERROR" "$log" || fail "$scene exported: errors"
    hashes "$scene exported" | diff "$work/$scene.txt" - || fail "$scene exported: other hashes than in its project"
done

# Control: a pack without levels.
mv "$work/away" "$work/project"
sed -i 's|^exclude_filter=.*|exclude_filter="levels/*"|' "$work/project/export_presets.cfg"
export_to "$work/game/wadi.x86_64"
mv "$work/project" "$work/away"
! run_game beach || fail "without its levels the beach should not start"
grep -q 'there is no file "res://levels/beach/level.json"' "$log" || fail "without levels: the message should name the file"
rm -rf "$work/game"
cat "$work/beach.txt" "$work/canyon.txt" "$work/export.txt"
