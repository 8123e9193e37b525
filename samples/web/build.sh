#!/usr/bin/env bash
# Builds the page into build/web/site: WebAssembly with threads and without, shaders, levels, and each file compressed beside itself.
# Usage: build.sh [KIND ...]; the kinds are single and threads, both unless one is named. WADI_JOBS: compilers at once.
set -euo pipefail
cd "$(dirname "$0")/../.."

work=$PWD/build/web
site=$work/site
jobs=${WADI_JOBS:-$(nproc)}
toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
kinds=("$@")
[ ${#kinds[@]} -ne 0 ] || kinds=(single threads)
# Where Node.js is not Debian's it does not look for Debian's modules; a build's time goes into starting emcc.
export NODE_PATH=/usr/share/nodejs EMSDK_PYTHON=/usr/bin/python3 CCACHE_COMPILERTYPE=clang
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS="pch_defines,time_macros${CCACHE_SLOPPINESS:+,$CCACHE_SLOPPINESS}"

mkdir -p "$site"
[ -e "$work/headers" ] || plugin/packaging/header_libraries.sh "$work/headers"
for kind in "${kinds[@]}"; do
    case $kind in
    single) threads="" link="" ;;
    threads) threads=-pthread link="-pthread -sPTHREAD_POOL_SIZE=8" ;;
    *) echo "build.sh: no kind \"$kind\"; the kinds are: single threads" >&2 && exit 2 ;;
    esac
    echo "$kind: compiling, some minutes the first time; the compiler's words go to $work/$kind.log"
    cmake -S . -B "$work/$kind" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE=$toolchain -DCMAKE_CROSSCOMPILING_EMULATOR= \
        -DCMAKE_PREFIX_PATH="$work/headers" -DCMAKE_FIND_ROOT_PATH="$work/headers" -DWADI_BACKENDS=OFF -DWADI_TESTS=OFF -DWADI_NARROW_MASKS=largest \
        -DCMAKE_UNITY_BUILD=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DWADI_OPTIMISE_BASE=-O2 \
        -DCMAKE_CXX_FLAGS="$threads -fexceptions -msimd128" -DCMAKE_C_FLAGS="$threads" -DCMAKE_EXE_LINKER_FLAGS="-fexceptions $link" >"$work/$kind.log" 2>&1 &&
        ninja -C "$work/$kind" -j "$jobs" wadi-page >>"$work/$kind.log" 2>&1 || { tail -n 20 "$work/$kind.log"; echo "build.sh: $kind cannot be built"; exit 1; }
    mkdir -p "$site/$kind"
    cp "$work/$kind"/bin/wadi.* "$site/$kind/"
done
cp samples/web/page/* "$site/"
python3 samples/web/shaders.py "$site/shaders.js"
python3 samples/web/levels.py "$site"
python3 samples/web/compress.py "$site"
