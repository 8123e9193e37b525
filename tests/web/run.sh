#!/usr/bin/env bash
# Builds the page and tries it in headless Chromium. Usage: run.sh BUILD [WORDS OF play.py ...], BUILD being a native build with tests.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$1
shift
samples/web/build.sh
[ -x "$build/bin/wadi-test-page" ] || ninja -C "$build" wadi-test-page
python3 tests/web/play.py build/web/site "$build/bin/wadi-test-page" "$@"
