#!/usr/bin/env bash
# Writes tests/golden/hashes.txt and the smallest host's hash anew from the release build. Say in the commit which stage changed and why.
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --build --preset release --target wadi-test-golden wadi-minimal-host
WADI_UPDATE_GOLDEN=1 build/release/bin/wadi-test-golden
build/release/bin/wadi-minimal-host | sed -n 's/.*hash \([0-9a-f]*\).*/\1/p' >tests/platforms/minimal_host_hash.txt
tests/lanes.py table # rows of earlier stamps say that results have changed
git --no-pager diff --stat tests/golden/hashes.txt tests/platforms/minimal_host_hash.txt
