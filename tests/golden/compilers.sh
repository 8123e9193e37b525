#!/usr/bin/env bash
# The golden hashes with g++ and clang++ at -O0 and -O2, each in a build folder of its own under build/golden.
# Usage: tests/golden/compilers.sh [COMPILER ...]; default: g++ clang++.
set -euo pipefail
cd "$(dirname "$0")/../.."

compilers=("$@")
[ ${#compilers[@]} -gt 0 ] || compilers=(g++ clang++)
failed=0
for compiler in "${compilers[@]}"; do
    if ! command -v "$compiler" >/dev/null; then
        echo "$compiler: not installed"
        failed=1
        continue
    fi
    for level in -O0 -O2; do
        folder=build/golden/$compiler$level
        cmake -S . -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=$level \
            -DWADI_BACKENDS=OFF -DWADI_SAMPLES=OFF >/dev/null
        cmake --build "$folder" --target wadi-test-golden >/dev/null
        if "$folder/bin/wadi-test-golden" >"$folder/golden.log" 2>&1; then
            echo "$compiler $level: all hashes as kept"
        else
            echo "$compiler $level: other hashes, see $folder/golden.log"
            failed=1
        fi
    done
done
exit $failed
