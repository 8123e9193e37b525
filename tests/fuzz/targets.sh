#!/usr/bin/env bash
# Runs the libFuzzer targets one after the other and prints what each executed and how many lines of its reader it reached.
# Usage: tests/fuzz/targets.sh [SECONDS [TARGET ...]]
# SECONDS per target, default 600. Wants clang and llvm; builds preset fuzz. Inputs that crash lie in build/fuzz/crashes.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-600}
shift || true
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    targets=(level png npy asc r16 snapshot commands calls)
fi
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz
cmake --build build/fuzz --target fuzz-targets -j "${WADI_JOBS:-$(nproc)}"
corpus=build/fuzz/corpus
python3 tests/fuzz/corpus/make.py "$corpus"
mkdir -p build/fuzz/crashes
# What a target is to reach.
readers() {
    case $1 in
    level) ls engine/level/*.cpp ;;
    png | npy | asc | r16) echo "engine/image/$1.cpp" ;;
    snapshot) ls engine/saves/{sealed_bytes,snapshot_format,snapshots}.cpp ;;
    commands) ls engine/edits/command_*.cpp ;;
    calls) ls plugin/*.cpp ;;
    esac
}
# "LINES of ALL lines" of the readers that the profile of a run holds.
coverage() {
    local profile=build/fuzz/$1.profdata object=build/fuzz/bin/fuzz-$1
    [ "$1" = calls ] && object=build/fuzz/lib/libwadi.so
    llvm-profdata merge -sparse "build/fuzz/$1.profraw" -o "$profile" || return 0
    # shellcheck disable=SC2046 # one word per file
    llvm-cov export "$object" -instr-profile="$profile" -summary-only | python3 -c '
import json, sys
lines = [file["summary"]["lines"] for file in json.load(sys.stdin)["data"][0]["files"] if file["filename"].endswith(tuple(sys.argv[1:]))]
print(sum(l["covered"] for l in lines), "of", sum(l["count"] for l in lines), "lines")' $(readers "$1")
}
failed=0
for target in "${targets[@]}"; do
    log=build/fuzz/$target.log
    good=yes
    dictionary=()
    for words in "tests/fuzz/corpus/$target.dict" "$corpus/$target.dict"; do
        [ -f "$words" ] && dictionary=("-dict=$words")
    done
    LLVM_PROFILE_FILE="build/fuzz/$target.profraw" "build/fuzz/bin/fuzz-$target" -max_total_time="$seconds" -max_len=16384 -rss_limit_mb=2048 \
        -timeout=20 -print_final_stats=1 "${dictionary[@]}" -artifact_prefix="build/fuzz/crashes/$target-" "$corpus/$target" > "$log" 2>&1 || good=no
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    echo "$target: ${executed:-?} executions in $seconds s, $(coverage "$target") reached, $good"
    [ "$good" = yes ] || { failed=1; tail -30 "$log"; }
done
exit $failed
