#!/usr/bin/env bash
# Builds Wadi's CPU backend for other platforms and runs the golden hashes and the smallest host there. Usage: run.sh [TARGET ...]
# TARGET: windows (MinGW-w64, Wine), aarch64 (cross compiler, QEMU), wasm (Emscripten, Node.js), swiftshader (a second Vulkan driver,
# tests of conformance), static (this machine, one archive, installed and linked by a host in C). Default: all. Installs what is missing (as root) and builds below build/platforms; a line per target at the end.
set -euo pipefail
cd "$(dirname "$0")/../.."

all=(windows aarch64 wasm swiftshader static)
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")
for target in "${targets[@]}"; do
    [[ " ${all[*]} " == *" $target "* ]] || { echo "run.sh: no target \"$target\"; the targets are: ${all[*]}" >&2; exit 2; }
done

here=tests/platforms
work=$PWD/build/platforms
headers=$work/headers
mkdir -p "$work"

install() { # PACKAGE ...: those that are missing
    local missing=()
    for package in "$@"; do
        [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true) == installed ]] || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] || DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >"$work/apt.log" 2>&1 ||
        { echo "these packages cannot be installed: ${missing[*]} (see $work/apt.log)"; return 1; }
}

# The header libraries in a folder of their own: /usr/include has this machine's C library as well.
copy_headers() {
    rm -rf "$headers"
    mkdir -p "$headers/include" "$headers/share/cmake" "$headers/lib/cmake"
    cp -rL /usr/include/{nlohmann,doctest,stb,CLI} "$headers/include/"
    cp -r /usr/share/cmake/{nlohmann_json,CLI11} "$headers/share/cmake/"
    cp -r /usr/lib/cmake/doctest "$headers/lib/cmake/"
    sed -i "s|\"/usr\"|\"$headers\"|" "$headers"/*/cmake/*/*Targets.cmake
}

build() { # TARGET CMAKE_OPTION ...
    local target=$1
    shift
    cmake -S . -B "$work/$target" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$headers" -DCMAKE_FIND_ROOT_PATH="$headers" -DWADI_BACKENDS=OFF \
        -DWADI_NARROW_MASKS=largest -DWADI_AVX512=OFF -DWADI_OPTIMISE_BASE=-O1 -DWADI_OPTIMISE_VECTOR=-O1 \
        -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON "$@" >"$work/$target.log" 2>&1 &&
        ninja -C "$work/$target" wadi wadi-minimal-host $([[ $target == static ]] || echo wadi-test-golden) >>"$work/$target.log" 2>&1 ||
        { tail -n 20 "$work/$target.log"; echo "$target: cannot be built, see $work/$target.log"; return 1; }
}

# RUNNER is a command ahead of a program's name.
run() { # TARGET SUFFIX RUNNER ...
    local target=$1 suffix=$2
    shift 2
    local bin=$work/$target/bin golden=passed
    "$@" "$bin/wadi-test-golden$suffix" >"$work/$target.golden.log" 2>&1 || golden="FAILED, see $work/$target.golden.log"
    local host
    host=$("$@" "$bin/wadi-minimal-host$suffix" 2>"$work/$target.host.log" | tr -d '\r' | sed -n 's/.*hash //p')
    echo "$target: golden hashes $golden; smallest host: hash ${host:-MISSING}"
    [[ $golden == passed && $host == "$(cat $here/minimal_host_hash.txt)" ]]
}

lane_windows() {
    install g++-mingw-w64-x86-64-posix wine64 && build windows -DCMAKE_TOOLCHAIN_FILE="$PWD/$here/windows.cmake" || return 1
    export WINEDEBUG=-all WINEPREFIX=$work/wine
    run windows .exe "$(command -v wine64 || echo /usr/lib/wine/wine64)" || return 1
    local runs=${WADI_WINE_RUNS:-20}
    for n in $(seq "$runs"); do # waits that lose a wake-up show as runs that hang
        timeout 60 /usr/lib/wine/wine64 "$work/windows/bin/wadi-minimal-host.exe" >/dev/null 2>&1 || { echo "windows: run $n of $runs hung or failed"; return 1; }
    done
    echo "windows: $runs runs of the smallest host, none hung"
}

lane_aarch64() {
    install g++-aarch64-linux-gnu qemu-user && build aarch64 -DCMAKE_TOOLCHAIN_FILE="$PWD/$here/aarch64.cmake" &&
        run aarch64 "" qemu-aarch64 -L /usr/aarch64-linux-gnu
}

lane_wasm() {
    install emscripten nodejs || return 1
    export EM_CACHE=$work/emscripten
    build wasm -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake -DCMAKE_CROSSCOMPILING_EMULATOR= \
        -DCMAKE_CXX_FLAGS="-pthread -fexceptions -msimd128" -DCMAKE_C_FLAGS=-pthread \
        -DCMAKE_EXE_LINKER_FLAGS="-sPROXY_TO_PTHREAD -sPTHREAD_POOL_SIZE=8 -sINITIAL_MEMORY=1GB -sEXIT_RUNTIME -sNODERAWFS" &&
        run wasm .js node
}

lane_swiftshader() {
    install chromium-common
    local driver
    driver=$(dpkg -L chromium-common | grep vk_swiftshader_icd.json) || { echo "swiftshader: chromium-common has no vk_swiftshader_icd.json"; return 1; }
    cmake -S . -B "$work/native" -G Ninja -DCMAKE_BUILD_TYPE=Release -DWADI_CUDA=OFF -DWADI_SAMPLES=OFF -DWADI_NARROW_MASKS=largest -DWADI_AVX512=OFF \
        -DWADI_OPTIMISE_BASE=-O1 -DWADI_OPTIMISE_VECTOR=-O1 >"$work/native.log" 2>&1 && ninja -C "$work/native" conformance >>"$work/native.log" 2>&1 || return 1
    local suite failed=0
    for suite in contract stage step; do
        VK_DRIVER_FILES=$driver "$work/native/bin/conformance" test --backend vulkan --suite $suite --max-masks 2 --max-steps 30 --max-cells 600 \
            >"$work/swiftshader.$suite.log" 2>&1 || failed=1
        echo "swiftshader: $suite: $(tail -n 1 "$work/swiftshader.$suite.log")"
    done
    return $failed
}

lane_static() {
    build static -DWADI_STATIC=ON -DWADI_TESTS=OFF || return 1
    local prefix=$work/static/installed
    cmake --install "$work/static" --component plugin --prefix "$prefix" >>"$work/static.log" 2>&1 &&
        cmake -S "$prefix/share/wadi/examples" -B "$work/static/example" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >>"$work/static.log" 2>&1 &&
        ninja -C "$work/static/example" >>"$work/static.log" 2>&1 || { echo "static: see $work/static.log"; return 1; }
    local by_cmake by_pkg
    by_cmake=$("$work/static/example/minimal_host" | sed -n 's/.*hash //p')
    export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
    # shellcheck disable=SC2046
    cc -std=c99 samples/minimal_host/main.c -o "$work/static/host" $(pkg-config --cflags --libs wadi) && by_pkg=$("$work/static/host" | sed -n 's/.*hash //p')
    echo "static: smallest host by CMake $by_cmake, by pkg-config ${by_pkg:-MISSING}"
    [[ $by_cmake == "$(cat $here/minimal_host_hash.txt)" && $by_pkg == "$by_cmake" ]]
}

copy_headers
failed=()
for target in "${targets[@]}"; do
    start=$SECONDS
    "lane_$target" || failed+=("$target")
    echo "$target: $((SECONDS - start)) s"
done
[ ${#failed[@]} -eq 0 ] || { echo "FAILED: ${failed[*]}"; exit 1; }
