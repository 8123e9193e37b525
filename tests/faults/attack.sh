#!/usr/bin/env bash
# The attack on the library as a host would see it: a minute of it, or with --full all of it (a quarter of an hour on two cores without a GPU).
# Usage: tests/faults/attack.sh BIN [--full]; BIN: the folder of the programs, such as build/release/bin.
set -uo pipefail
bin=$1
full=${2:-}
if [ -n "$full" ] && [ "$full" != --full ]; then
    echo "usage: tests/faults/attack.sh BIN [--full]" >&2
    exit 2
fi
steps=16000 count=120 edits=150 seconds=5 gpu_steps=2048 gpu_count=8 failing=12 every=97
if [ "$full" = --full ]; then steps=200000 count=1000 edits=5000 seconds=120 gpu_steps=10000 gpu_count=1000 failing=600 every=1; fi
failed=0
run() {
    local begin=$SECONDS
    "$@" || { failed=1; echo "FAILED: $*" >&2; }
    echo "$(basename "$1") ${*:2}: $((SECONDS - begin)) s"
}
attack=$bin/wadi-test-attack
run "$attack" environment
run "$attack" memory
run "$attack" files
run "$attack" cost
run "$attack" numbers
run "$attack" edited "$edits"
run "$attack" jobs
run "$bin/wadi-test-faults" memory "$every" # one allocation of so many fails
run "$bin/wadi-test-faults" load "$every"
run "$attack" hosts "$seconds"
run "$attack" soak cpu "$steps"
run "$attack" cycles cpu "$count"
# A library with the name of Vulkan's loader that is none.
none=$(mktemp -d)
echo | cc -shared -x c - -o "$none/libvulkan.so.1"
LD_LIBRARY_PATH=$none "$attack" has vulkan
[ $? = 1 ] || { failed=1; echo "FAILED: a Vulkan loader without an entry point" >&2; }
# One that hands every call on to the real loader, and lets one fail.
real=$(ldconfig -p | awk '/libvulkan\.so\.1 .*x86-64|libvulkan\.so\.1 .*AArch64/ { print $NF; exit }')
if [ -n "$real" ] && "$attack" has vulkan; then
    if cc -shared -fPIC -Wall -Wextra -Werror -o "$none/libvulkan.so.1" "$(dirname "$0")/attack/failing_vulkan.c" -ldl; then
        FAILING_VULKAN_REAL=$real LD_LIBRARY_PATH=$none run "$attack" failing_vulkan "$failing"
    else
        failed=1
    fi
fi
rm -r "$none"
for backend in vulkan cuda; do
    if ! "$attack" has "$backend"; then
        echo "$backend: no device"
        continue
    fi
    run "$attack" environment "$backend"
    run "$attack" soak "$backend" "$gpu_steps"
    run "$attack" cycles "$backend" "$gpu_count"
done
if [ "$full" = --full ]; then # ctest runs each of these by itself
    for what in save disk; do run "$bin/wadi-test-faults" "$what"; done
    for what in snapshots rights savers memory; do run "$bin/wadi-test-files" "$what"; done
    for what in threads exit fork; do run "$bin/wadi-test-process" "$what"; done
    run "$bin/wadi-test-plugin" -tc='*rounding*,*traps*,*thread*,*handle*,*snapshot*'
fi
exit $failed
