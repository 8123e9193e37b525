#!/usr/bin/env bash
# The fuzzer for a long time (default half an hour), on every backend that has a device. Usage: tests/fuzz/long.sh [SECONDS [SEED]]
# Figures go to fuzz-long.csv, levels of failures to fuzz-failures/. WADI_BUILD: the build folder, default build/release.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${WADI_BUILD:-build/release}
seconds=${1:-1800}
seed=${2:-$(date +%s)}
echo "seed $seed"
"$build/bin/wadi-fuzz" --seconds "$seconds" --seed "$seed" --csv fuzz-long.csv --failures 20
