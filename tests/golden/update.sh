#!/usr/bin/env bash
# Writes tests/golden/hashes.txt anew from the release build. Say in the commit which stage changed and why.
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --build --preset release --target wadi-test-golden
WADI_UPDATE_GOLDEN=1 build/release/bin/wadi-test-golden
git --no-pager diff --stat tests/golden/hashes.txt
