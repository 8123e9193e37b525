#!/usr/bin/env bash
# The page from a fresh clone: installs what is missing, builds it and serves it to this machine. Usage: serve.sh [--port N]
set -euo pipefail
cd "$(dirname "$0")/../.."
samples/install_packages.sh web
samples/web/build.sh
exec python3 samples/web/serve.py build/web/site "$@"
