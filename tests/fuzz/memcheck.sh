#!/usr/bin/env bash
# Random worlds on CUDA under compute-sanitizer (of the CUDA toolkit): reads and writes outside buffers, which seldom change a bit or end a
# program. Usage: tests/fuzz/memcheck.sh [SECONDS [SEED ...]], by default two minutes; a process per seed, exit code 1 if one finds something.
# WADI_BUILD: the build folder, default build/release.
set -euo pipefail
cd "$(dirname "$0")/../.."
fuzz=${WADI_BUILD:-build/release}/bin/wadi-fuzz
seconds=${1:-120}
seeds=("${@:2}")
[ ${#seeds[@]} -gt 0 ] || seeds=("$(date +%s)")
sanitizer=$(PATH=$PATH:/usr/local/cuda/bin command -v compute-sanitizer) || { echo "compute-sanitizer is missing: it comes with the CUDA toolkit"; exit 2; }
running=()
for seed in "${seeds[@]}"; do
  echo "seed $seed"
  "$sanitizer" --tool memcheck --print-limit 3 --error-exitcode 3 \
    "$fuzz" --backend cuda --jobs 1 --seed "$seed" --seconds "$seconds" --shrink-seconds 0 &
  running+=($!)
done
failed=0
for process in "${running[@]}"; do wait "$process" || failed=1; done
exit $failed
