#!/usr/bin/env bash
# All tests: installs what is missing, builds, runs. Usage: tests/run.sh [PRESET ...], default: o3 ci asan.
# o3: no tests; warnings that g++ has at -O3 alone, which are errors.
# ci: every backend that this machine has, as preset release but quicker to build; then two lanes of tests/platforms. asan: the CPU
# backend under the address and undefined-behaviour sanitizers with every stage index checked. release, tsan, dev, cpu-only,
# vulkan-lavapipe and cuda work as well.
set -euo pipefail
cd "$(dirname "$0")/.."

presets=("$@")
if [ ${#presets[@]} -eq 0 ]; then
    presets=(o3 ci asan)
fi
say() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

say "packages"
./samples/install_packages.sh
jobs=$(nproc)
options=()
if [ ! -e /dev/nvidiactl ]; then # no GPU to run them on: that CUDA's stages compile, ptxas included, is seen from the smallest one and all effects
    options+=(-DWADI_CUDA_ARCHITECTURES=75 -DWADI_CUDA_MASKS=largest)
fi
if [ "$(uname -m)" = x86_64 ] && ! grep -qw avx512f /proc/cpuinfo; then # preset ci has all masks of the widest set alone: of one that runs here
    options+=("-DWADI_CPU_SETS=base;avx2")
fi
# Two tests at once on two processors are done sooner when Mesa's software device starts no threads of its own. The shaders that it has
# compiled are kept here, where a home that cannot be written would mean compiling them for each world anew.
export LP_NUM_THREADS=0 MESA_SHADER_CACHE_DIR="$PWD/build/shader-cache"
failed=()
for preset in "${presets[@]}"; do
    say "configure $preset"
    cmake --preset "$preset" "${options[@]}"
    say "build $preset"
    if [ "$preset" = o3 ]; then # engine, backends and plugin compiled, not linked: the stages would take most of the time
        ninja -C build/o3 -t targets all | sed -nE 's/^((engine|backends|plugin)\/.*\.o): .*/\1/p' | xargs ninja -C build/o3 -j "$jobs"
        continue
    fi
    cmake --build --preset "$preset" -j "$jobs"
    say "test $preset"
    ctest --preset "$preset" -j "$jobs" || failed+=("$preset")
    if [ "$preset" = ci ]; then
        say "other platforms, those that cost least"
        WADI_NATIVE_BUILD=build/ci WADI_JOBS=$jobs tests/platforms/run.sh static swiftshader || failed+=(platforms)
    fi
done
say "done"
if [ ${#failed[@]} -ne 0 ]; then
    echo "FAILED: ${failed[*]}"
    exit 1
fi
echo "all tests passed: ${presets[*]}"
