#!/usr/bin/env bash
# Makes the compiler of releases callable as any other. Usage: zig.sh ENVIRONMENT [FOLDER TARGET ...]
#   ENVIRONMENT  a folder for Python's packages: requirements.txt is installed there once, in the version and with the checksum that it names
#   FOLDER       gets TARGET/{cc,c++,ar,ranlib} for each TARGET: a processor, a system and its oldest C library ("x86_64-linux-gnu.2.28")
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 1 ] || { sed -n '2,5s/^# \?//p' "$0" >&2 && exit 2; }
environment=$1
if ! cmp -s "$here/requirements.txt" "$environment/requirements.txt"; then
    python3 -m venv "$environment"
    "$environment/bin/pip" install --quiet --disable-pip-version-check --require-hashes -r "$here/requirements.txt"
    cp "$here/requirements.txt" "$environment/requirements.txt"
fi
environment=$(cd "$environment" && pwd)
zig=$(echo "$environment"/lib/python3*/site-packages/ziglang/zig)
[ -x "$zig" ] || { echo "zig.sh: $environment has no ziglang/zig; delete the folder and begin again" >&2; exit 1; }
for target in "${@:3}"; do
    mkdir -p "$2/$target"
    # Without -fno-sanitize zig checks what is compiled with -O0, as command lines of programs are, and links no sanitizer.
    for tool in cc c++; do printf '#!/bin/sh\nZIG_GLOBAL_CACHE_DIR=%s exec %s %s -target %s -g0 -fno-sanitize=undefined "$@"\n' "$environment/cache" "$zig" $tool "$target" >"$2/$target/$tool"; done
    for tool in ar ranlib; do printf '#!/bin/sh\nexec %s %s "$@"\n' "$zig" $tool >"$2/$target/$tool"; done
    chmod +x "$2/$target"/*
done
