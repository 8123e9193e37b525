#!/usr/bin/env bash
# Makes the wheel that is handed on: built by the compiler of releases against an old glibc, checked by auditwheel.
# Usage: wheel.sh [FOLDER]; it goes to FOLDER, build/wheel unless one is named. Needs Debian 12, Debian's packages and PyPI.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(realpath -m "${1:-$root/build/wheel}")
cd "$root"
work=$root/build/packaging
target=x86_64-linux-gnu.2.28
samples/install_packages.sh python packaging demo
plugin/packaging/zig.sh "$work/zig" "$work/tools" "$target"
plugin/packaging/header_libraries.sh "$work/headers"
# Beside the headers, which other systems' builds use as well: the one library that is linked into the programs.
mkdir -p "$work/deflate/include" "$work/deflate/lib"
cp /usr/include/libdeflate.h "$work/deflate/include/"
cp "/usr/lib/$(gcc -print-multiarch)/libdeflate.a" "$work/deflate/lib/"
python3 plugin/packaging/third_party.py texts --zig "$(echo "$work"/zig/lib/python3*/site-packages/ziglang)" --programs "$work/THIRD_PARTY.wheel.txt"
if ! cmp -s plugin/python/requirements.txt "$work/wheel_tools/requirements.txt"; then
    /usr/bin/python3 -m venv "$work/wheel_tools"
    "$work/wheel_tools/bin/pip" install --quiet --disable-pip-version-check -r plugin/python/requirements.txt
    cp plugin/python/requirements.txt "$work/wheel_tools/"
fi
# ccache guesses a compiler's kind from its name
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_COMPILERTYPE=clang
export CCACHE_COMPILERCHECK="string:$(cat plugin/packaging/requirements.txt) $target"
both="$work/headers;$work/deflate"
rm -rf "$work/wheels" && mkdir -p "$work/wheels" "$out"
"$work/wheel_tools/bin/python" -m build --wheel --no-isolation --outdir "$work/wheels" plugin/python \
    -C build-dir="$work/wheel" -C cmake.define.CMAKE_TOOLCHAIN_FILE="$root/plugin/packaging/zig.cmake" -C cmake.define.WADI_ZIG_TOOLS="$work/tools" \
    -C cmake.define.WADI_ZIG_TARGET="$target" -C cmake.define.CMAKE_PREFIX_PATH="$both" -C cmake.define.CMAKE_FIND_ROOT_PATH="$both" \
    -C cmake.define.WADI_OPTIMISE_VECTOR=-O2 -C cmake.define.WADI_THIRD_PARTY="$work/THIRD_PARTY.wheel.txt" -C cmake.define.CMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
    -C cmake.define.CMAKE_UNITY_BUILD=ON -C cmake.define.CMAKE_UNITY_BUILD_BATCH_SIZE=16 >"$work/wheel.log" 2>&1 ||
    { tail -n 30 "$work/wheel.log"; echo "the wheel cannot be built, see $work/wheel.log"; exit 1; }
rm -f "$out"/wadi-*.whl
PATH="$work/wheel_tools/bin:$PATH" "$work/wheel_tools/bin/auditwheel" repair --plat manylinux_2_28_x86_64 --wheel-dir "$out" "$work"/wheels/wadi-*.whl
"$work/wheel_tools/bin/auditwheel" show "$out"/wadi-*.whl
for file in "$out"/wadi-*.whl; do echo "$file: $(stat -c %s "$file") bytes"; done
