#!/usr/bin/env bash
# Runs the libFuzzer targets and prints what each executed and how many lines of its reader it reached.
# Usage: tests/fuzz/targets.sh [OPTION ...] [SECONDS [TARGET ...]]; SECONDS per target, default 600.
#   --no-build       runs what build/fuzz/{bin,lib,corpus} hold: no compiler, no sources, no python3
#   --jobs N         so many processes at once, default 1
#   --each N         so many processes per target, which share their inputs, default 1
#   --out DIR        logs, profiles, crashes/ and new inputs go there, default build/fuzz
#   --pack FILE      builds, and packs stripped what another machine needs into FILE (tar.xz); runs nothing
#   --coverage-only  runs nothing; reads the logs and profiles (*.profraw) that a run left in DIR
# Building wants clang, reading the coverage llvm-cov, llvm-profdata, python3, and the programs that ran, unstripped.
set -euo pipefail
usage() {
    sed -n '3,10s/^# //p' "$0" >&2
    exit 2
}
whole() { # NAME VALUE: a whole number from 1 to 999999
    [[ $2 =~ ^[1-9][0-9]{0,5}$ ]] || { echo "targets.sh: $1 is '$2', not a whole number from 1 to 999999" >&2; usage; }
}
absolute() { case $1 in /*) echo "$1" ;; *) echo "$PWD/$1" ;; esac; }
build=yes run=yes jobs=1 each=1 out='' pack=''
while [[ ${1:-} == --* ]]; do
    case $1 in
    --no-build) build=no ;;
    --coverage-only) build=no run=no ;;
    --jobs | --each | --out | --pack)
        [ -n "${2:-}" ] || { echo "targets.sh: $1 wants a value" >&2; usage; }
        case $1 in
        --jobs) jobs=$2 ;;
        --each) each=$2 ;;
        --out) out=$(absolute "$2") ;;
        --pack) pack=$(absolute "$2") ;;
        esac
        shift
        ;;
    *) echo "targets.sh: unknown option $1" >&2; usage ;;
    esac
    shift
done
seconds=${1:-600}
shift || true
whole SECONDS "$seconds"
whole --jobs "$jobs"
whole --each "$each"
all=(level png npy asc r16 snapshot commands calls)
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")
for target in "${targets[@]}"; do
    [[ " ${all[*]} " == *" $target "* ]] || { echo "targets.sh: target '$target' is none of ${all[*]}" >&2; usage; }
done
cd "$(dirname "$0")/../.."
out=${out:-$PWD/build/fuzz}
seeds=$PWD/build/fuzz/corpus
if [ $build = yes ]; then
    [ -f build/fuzz/build.ninja ] || cmake --preset fuzz
    cmake --build build/fuzz --target fuzz-targets -j "${WADI_JOBS:-$(nproc)}"
    python3 tests/fuzz/corpus/make.py "$seeds"
    cp tests/fuzz/corpus/*.dict "$seeds"
fi
if [ -n "$pack" ]; then
    [ $build = yes ] || { echo "targets.sh: --pack builds" >&2; usage; }
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    mkdir -p "$folder"/build/fuzz "$folder"/tests/fuzz
    cp -a build/fuzz/bin build/fuzz/lib build/fuzz/corpus "$folder/build/fuzz"
    cp tests/fuzz/targets.sh "$folder/tests/fuzz"
    find "$folder/build/fuzz/bin" -type f ! -name 'fuzz-*' -delete
    find "$folder"/build/fuzz/{bin,lib} -type f -exec strip {} +
    tar -C "$folder" -cJf "$pack" build tests
    ls -l "$pack"
    exit
fi
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
# "LINES of ALL lines reached" of the readers that the profiles of a run hold.
coverage() {
    local tool object=build/fuzz/bin/fuzz-$1
    for tool in llvm-profdata llvm-cov python3; do
        command -v $tool > /dev/null || { echo "coverage not read, no $tool here"; return; }
    done
    [ -d engine ] || { echo "coverage not read, no sources here"; return; }
    [ "$1" = calls ] && object=build/fuzz/lib/libwadi.so
    llvm-profdata merge -sparse "$out/$1".*.profraw -o "$out/$1.profdata" 2> /dev/null || { echo "no profile"; return; }
    # shellcheck disable=SC2046 # one word per file
    llvm-cov export "$object" -instr-profile="$out/$1.profdata" -summary-only | python3 -c '
import json, sys
lines = [file["summary"]["lines"] for file in json.load(sys.stdin)["data"][0]["files"] if file["filename"].endswith(tuple(sys.argv[1:]))]
print(sum(l["covered"] for l in lines), "of", sum(l["count"] for l in lines), "lines reached")' $(readers "$1")
}
fuzz() { # TARGET NUMBER
    local log=$out/$1.$2.log words=() inputs=("$out/corpus/$1")
    [ -f "$seeds/$1.dict" ] && words=("-dict=$seeds/$1.dict")
    [ "$out/corpus" = "$seeds" ] || inputs+=("$seeds/$1")
    local code=0
    # %m: the program's profile and the library's are two files.
    LLVM_PROFILE_FILE="$out/$1.$2.%m.profraw" LD_LIBRARY_PATH="$PWD/build/fuzz/lib" "build/fuzz/bin/fuzz-$1" \
        -max_total_time="$seconds" -max_len=16384 -rss_limit_mb=2048 -timeout=20 -print_final_stats=1 "${words[@]}" \
        -artifact_prefix="$out/crashes/$1-" "${inputs[@]}" > "$log" 2>&1 || code=$?
    echo "ended with $code" >> "$log"
}
if [ $run = yes ]; then
    mkdir -p "$out/crashes"
    for target in "${targets[@]}"; do
        mkdir -p "$out/corpus/$target"
        rm -f "$out/$target".*.{log,profraw}
    done
    for target in "${targets[@]}"; do
        for number in $(seq "$each"); do
            while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
            fuzz "$target" "$number" &
        done
    done
    wait
fi
sum() { awk '{ n += $1 } END { print n + 0 }'; }
failed=0
for target in "${targets[@]}"; do
    logs=("$out/$target".*.log)
    [ -f "${logs[0]}" ] || { echo "$target: no log in $out"; failed=1; continue; }
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "${logs[@]}" | sum)
    spent=$(sed -n 's/^Done [0-9]* runs in \([0-9]*\) second.*/\1/p' "${logs[@]}" | sum)
    mapfile -t bad < <(grep -L '^ended with 0$' "${logs[@]}")
    good=$([ ${#bad[@]} -eq 0 ] && echo yes || echo no)
    echo "$target: $executed executions in $spent s of ${#logs[@]} processes, $(coverage "$target"), $good"
    for log in "${bad[@]}"; do
        failed=1
        tail -n 30 "$log"
    done
done
exit $failed
