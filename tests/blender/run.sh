#!/usr/bin/env bash
# Tests of the extension for Blender, in Blender as a module (PyPI's bpy). Usage: run.sh WHEEL [--store] [PART ...]
#   WHEEL    of wadi, as plugin/python/wheel.sh makes it
#   --store  writes canyon.jpg anew: look at it
#   PART     of check.py, all unless named
# Exit status 77 where there is no Python 3.11, or PyPI cannot be reached.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
[ $# -ge 1 ] || { sed -n '2,6s/^# \?//p' "$0" >&2 && exit 2; }
wheel=$(realpath "$1")
shift
work=$root/build/blender
command -v python3.11 >/dev/null || { echo "run.sh: no python3.11, which bpy is built for" >&2 && exit 77; }
mkdir -p "$work"
if ! cmp -s "$here/requirements.txt" "$work/environment/requirements.txt"; then
    python3.11 -m venv "$work/environment"
    "$work/environment/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt" ||
        { echo "run.sh: bpy cannot be installed" >&2 && exit 77; }
    cp "$here/requirements.txt" "$work/environment/requirements.txt"
fi
package=$("$root/plugin/blender/pack.py" "$wheel" "$work")
cp "$package" "$work/renamed.zip"
! "$root/plugin/blender/pack.py" --check "$work/renamed.zip" 2>"$work/renamed.log" || { echo "pack.py takes a wrong name" >&2 && exit 1; }
# Blender's own validator, which reads the manifest alone, and takes what it is given for good
validator=$(echo "$work"/environment/lib/python3.11/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py)
"$work/environment/bin/python" "$validator" validate --valid-tags="" "$package"
exec "$work/environment/bin/python" "$here/check.py" "$work" "$package" "$@"
