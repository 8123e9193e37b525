#!/usr/bin/env bash
# The stage, step and fused suites on the CUDA backend under compute-sanitizer, on grids small enough for its pace (--max-cells, default 700).
# Usage: tests/conformance/sanitize.sh [--binary FILE] [--limit SECONDS] [--max-cells N] [--suite S[,S]] [TOOL ...]; tools: memcheck racecheck initcheck synccheck.
set -euo pipefail
cd "$(dirname "$0")/../.."

binary=build/release/bin/conformance
limit=600
cells=700
suites=fused,stage,step
tools=()
while [ $# -gt 0 ]; do
    case $1 in
    --binary) binary=${2:?--binary needs a file}; shift 2 ;;
    --max-cells) cells=${2:?--max-cells needs a number}; shift 2 ;;
    --suite | --layer) suites=${2:?--suite needs names}; shift 2 ;;
    --limit) limit=${2:?--limit needs seconds}; shift 2 ;;
    memcheck | racecheck | initcheck | synccheck) tools+=("$1"); shift ;;
    *) echo "sanitize.sh: '$1' is neither an option nor a tool; see the head of this file" >&2; exit 2 ;;
    esac
done
[ ${#tools[@]} -gt 0 ] || tools=(memcheck racecheck initcheck synccheck)

if ! command -v compute-sanitizer >/dev/null; then
    echo "sanitize.sh: compute-sanitizer is not installed (it comes with the CUDA toolkit)" >&2
    exit 77
fi
if ! "$binary" list --backend cuda 2>/dev/null | grep -q '^# cuda'; then
    echo "sanitize.sh: $binary sees no CUDA device" >&2
    exit 77
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
for tool in "${tools[@]}"; do
    status=0
    timeout "$limit" compute-sanitizer --tool "$tool" --error-exitcode 9 \
        "$binary" test --backend cuda --suite "$suites" --max-cells "$cells" >"$log" 2>&1 || status=$?
    cases=$(grep -c '^OK' "$log" || true)
    errors=$(grep -o 'ERROR SUMMARY: .*\|RACECHECK SUMMARY: .*' "$log" | tail -1 || true)
    case $status in
    0) echo "$tool: $cases cases OK; ${errors:-no summary}" ;;
    124) echo "$tool: stopped after $limit s; $cases cases OK until then" ; failed=1 ;;
    *) echo "$tool: exit status $status; $cases cases OK; ${errors:-no summary}"; grep -m 20 -E '=========|^FAIL' "$log" || true; failed=1 ;;
    esac
done
exit $failed
