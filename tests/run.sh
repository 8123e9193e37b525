#!/usr/bin/env bash
# Tests: installs what is missing, builds, runs. README.md beside it says what each of these runs and how long it takes.
#   tests/run.sh                  presets ci and asan, all but what is labelled long; at its end the lanes that have fallen behind
#   tests/run.sh quick            of preset ci what takes seconds
#   tests/run.sh long [LANE ...]  lanes of tests/lanes.txt, all or some; each that passes is stamped in tests/stamps.csv
#   tests/run.sh PRESET ...       all tests of a preset: release, ci, asan, tsan, dev, cpu-only, vulkan-lavapipe, cuda
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }
failed=()
jobs=$(nproc)
# Clones share what a compiler cache holds, where there is one, precompiled headers included.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS="pch_defines,time_macros${CCACHE_SLOPPINESS:+,$CCACHE_SLOPPINESS}"
# Two tests at once on two processors are done sooner when Mesa's software device starts no threads of its own. The shaders that it has
# compiled are kept here, where a home that cannot be written would mean compiling them for each world anew.
export LP_NUM_THREADS=0 MESA_SHADER_CACHE_DIR="$PWD/build/shader-cache"
options=()
if [ ! -e /dev/nvidiactl ]; then # no GPU to run them on: that CUDA's stages compile, ptxas included, is seen from the smallest one and all effects
    options+=(-DWADI_CUDA_ARCHITECTURES=75 -DWADI_CUDA_MASKS=largest)
fi
if [ "$(uname -m)" = x86_64 ] && ! grep -qw avx512f /proc/cpuinfo; then # preset ci has all masks of the widest set alone: of one that runs here
    options+=("-DWADI_CPU_SETS=base;avx2")
fi

build() { # PRESET CMAKE_OPTION ...
    say "configure $1"
    cmake --preset "$1" "${options[@]}" "${@:2}" && say "build $1" && cmake --build --preset "$1" -j "$jobs"
}
tests() { # PRESET CTEST_OPTION ...
    say "test $1 ${*:2}"
    ctest --preset "$1" -j "$jobs" "${@:2}"
}
failures() { # PRESET: of each of its tests that failed, what says so, or else its last lines
    local name said logs=build/$1/Testing/Temporary
    [ -s "$logs/LastTestsFailed.log" ] || return 0
    cut -d : -f 2 "$logs/LastTestsFailed.log" | while read -r name; do
        said=$(sed -n "\\|Testing: $name\$|,/^Test time =/p" "$logs/LastTest.log")
        printf '\n-- %s, test %s:\n' "$1" "$name"
        { grep -E -B 6 -A 3 'ERROR:|FAILED' <<<"$said" || tail -n 20 <<<"$said"; } | head -n 60 || true
    done
}
preset() { # PRESET CMAKE_OPTION ...: all of it
    build "$@" && tests "$1"
}

# A lane returns 0 where it has passed and 77 where this machine lacks what it needs. In `stamp` it leaves what is to be said of it.
lane_o3() { # engine, backends and plugin compiled, not linked: g++ warns of more at -O3, file by file
    say "configure o3"
    cmake --preset o3 && say "build o3" &&
        ninja -C build/o3 -t targets all | sed -nE 's/^((engine|backends|plugin)\/.*\.o): .*/\1/p' | xargs ninja -C build/o3 -j "$jobs"
}
lane_asan() { build asan -DWADI_BASE_STAGES_OF= && cmake --build --preset asan --target wadi-test-stability -j "$jobs" && tests asan; }
lane_tsan() { preset tsan; }
lane_release() { preset release; }
lane_reports() { build ci && tests ci -L long; }
lane_godot() {
    build ci && tests/godot/run.sh build/ci &&
        stamp=(--target "Godot add-on, x86-64 Linux" --tools "Godot $(tests/godot/godot.sh --version)" --ran "all of tests/godot")
}
lane_wheel() { # the wheel as it is handed on, in environments of its own
    plugin/python/wheel.sh build/wheel && tests/python/wheel.py build/wheel/wadi-*.whl &&
        stamp=(--target "Python wheel, x86-64 Linux" --tools "$(grep -o 'ziglang==[0-9.]*' plugin/packaging/requirements.txt)" --host "$(cat tests/platforms/minimal_host_hash.txt)")
}
lane_blender() { # the extension in Blender as a module, with the wheel inside
    samples/install_packages.sh blender && plugin/python/wheel.sh build/wheel && tests/blender/run.sh build/wheel/wadi-*.whl &&
        stamp=(--target "Blender extension, x86-64 Linux" --tools "$(grep '^bpy' tests/blender/requirements.txt)" --ran "all of tests/blender")
}
lane_web() {
    ./samples/install_packages.sh web wasm && build ci && tests/web/run.sh build/ci &&
        stamp=(--target "The page" --tools "Emscripten $(emcc --version | grep -m 1 -oE '[0-9]+\.[0-9]+\.[0-9]+'), $(chromium --version 2>/dev/null | cut -d ' ' -f 1,2)"
            --ran "all of tests/web")
}
lane_fine() { # every level's claims on its fine grid
    [ -e /dev/nvidiactl ] || { echo "no NVIDIA device" && return 77; }
    build release && tests/levels/fine_grids.py build/release/bin/wadi-recorder &&
        stamp=(--target "NVIDIA, levels on fine grids" --tools "$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader | head -n 1)" --ran "every level's claims")
}
lane_gpu() {
    [ -e /dev/nvidiactl ] || { echo "no NVIDIA device" && return 77; }
    build release && build/release/bin/conformance test --require cuda,vulkan &&
        stamp=(--target "NVIDIA, CUDA and Vulkan" --tools "$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader | head -n 1)" --ran conformance)
}

long() { # LANE ...
    local lanes known lane status stamp
    known=$(tests/lanes.py list)
    lanes=("$@")
    [ ${#lanes[@]} -ne 0 ] || read -r -a lanes <<<"$known"
    for lane in "${lanes[@]}"; do
        [[ " $known " == *" $lane "* ]] || { echo "run.sh: no lane \"$lane\"; the lanes are: $known" >&2 && exit 2; }
    done
    for lane in "${lanes[@]}"; do
        say "lane $lane"
        status=0
        if [ "$(type -t "lane_$lane")" = function ]; then
            stamp=(--tools "$(c++ --version | head -n 1)")
            "lane_$lane" || status=$?
            [ $status -ne 0 ] || tests/lanes.py passed "$lane" "${stamp[@]}" || true
        else
            WADI_JOBS=$jobs tests/platforms/run.sh --write "$lane" || status=$?
        fi
        case $status in
        0) ;;
        77) echo "lane $lane: not run here" ;;
        *) failed+=("$lane") ;;
        esac
    done
}

say "packages"
./samples/install_packages.sh
case ${1:-} in
quick)
    ran=quick
    build ci
    tests ci -L quick || failed+=(quick)
    ;;
long)
    ran=$*
    long "${@:2}"
    ;;
"")
    ran="ci asan"
    build ci
    tests ci -LE long || failed+=(ci)
    build asan -DWADI_BASE_STAGES_OF="$PWD/build/ci"
    tests asan -LE long || failed+=(asan)
    ;;
*)
    ran=$*
    for name in "$@"; do
        preset "$name" -DWADI_BASE_STAGES_OF= || failed+=("$name")
    done
    ;;
esac
say "done"
behind=$(tests/lanes.py stale)
[ -z "$behind" ] || printf 'lanes that are older than the code that they guard ("tests/run.sh long LANE"):\n%s\n' "$behind"
if [ ${#failed[@]} -ne 0 ]; then
    for name in "${failed[@]}"; do failures "${name/quick/ci}"; done
    echo "FAILED: ${failed[*]}"
    exit 1
fi
echo "passed: $ran"
