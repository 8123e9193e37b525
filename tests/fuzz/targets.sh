#!/usr/bin/env bash
# Runs the libFuzzer targets one after the other and prints what each executed. Usage: tests/fuzz/targets.sh [SECONDS [TARGET ...]]
# SECONDS per target, default 600. Wants clang; builds preset fuzz. Inputs that crash lie in build/fuzz/crashes.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-600}
shift || true
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    targets=(level png npy asc r16 snapshot commands calls)
fi
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz
cmake --build build/fuzz --target fuzz-targets
corpus=build/fuzz/corpus
python3 tests/fuzz/corpus/make.py "$corpus"
mkdir -p build/fuzz/crashes
failed=0
for target in "${targets[@]}"; do
    log=build/fuzz/$target.log
    good=yes
    dictionary=()
    for words in "tests/fuzz/corpus/$target.dict" "$corpus/$target.dict"; do
        [ -f "$words" ] && dictionary=("-dict=$words")
    done
    "build/fuzz/bin/fuzz-$target" -max_total_time="$seconds" -max_len=16384 -rss_limit_mb=2048 -timeout=20 -print_final_stats=1 \
        "${dictionary[@]}" -artifact_prefix="build/fuzz/crashes/$target-" "$corpus/$target" > "$log" 2>&1 || good=no
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    echo "$target: ${executed:-?} executions in $seconds s, $good"
    [ "$good" = yes ] || { failed=1; tail -30 "$log"; }
done
exit $failed
