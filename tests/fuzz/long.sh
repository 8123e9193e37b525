#!/usr/bin/env bash
# The fuzzer for a long time (default half an hour), on every backend that has a device. Usage: tests/fuzz/long.sh [SECONDS [SEED]]
# Figures go to fuzz-long-SEED.csv, a line per scene as it ends, levels of failures to fuzz-failures/. Without SEED it goes on after
# the last seed of earlier runs, broken off or not. WADI_BUILD: the build folder, default build/release.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${WADI_BUILD:-build/release}
seconds=${1:-1800}
last=$(cat fuzz-long-*.csv 2>/dev/null | cut -d, -f1 | sort -n | tail -n 1 || true)
seed=${2:-$((${last:-$(date +%s)} + 1))}
echo "seed $seed"
"$build/bin/wadi-fuzz" --seconds "$seconds" --seed "$seed" --csv "fuzz-long-$seed.csv" --failures 20
