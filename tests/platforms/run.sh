#!/usr/bin/env bash
# Builds Wadi for other platforms and runs the golden hashes and the smallest host there; --help says what each lane needs.
set -euo pipefail
cd "$(dirname "$0")/../.."

all=(windows aarch64 swiftshader static wasm)
usage() {
    cat <<EOF
Usage: run.sh [--write] [LANE ...]; all lanes where none is named. Exit status 1 where one fails, 2 for a wrong command line.
  --write      what ran goes into the table of tests/platforms/README.md

lane         installs                          packages, build  runs
windows      g++-mingw-w64-x86-64-posix wine64  1.0 GB, 0.8 GB   golden hashes, smallest host, it again WADI_WINE_RUNS (20) times
aarch64      g++-aarch64-linux-gnu qemu-user    0.3 GB, 0.1 GB   that rows of stages are vectors (NEON), golden hashes, smallest host
wasm         emscripten node-acorn              1.0 GB, 0.1 GB   with threads: golden hashes, smallest host; without: smallest host;
                                                                 both in Chromium where that is installed (package chromium)
swiftshader  chromium-common (for its driver)   0.1 GB, 0.4 GB   conformance, golden hashes, smallest host on Vulkan
static       pkg-config                         0, 0.3 GB        smallest host by CMake and by pkg-config with one archive

Packages are Debian 12's, installed by samples/install_packages.sh; Emscripten's libraries come built, so that it needs no cache.
Builds lie below build/platforms. WADI_NATIVE_BUILD: a build of this machine with Vulkan, whose programs lane swiftshader takes in
place of its own; WADI_SUITES: those of conformance that it runs (step). WADI_JOBS: compilers at once.
EOF
}

here=tests/platforms
work=$PWD/build/platforms
headers=$work/headers
write=
targets=()
for word in "$@"; do
    case $word in
    -h | --help) usage && exit ;;
    --write) write=yes ;;
    *)
        [[ " ${all[*]} " == *" $word "* ]] || { echo "run.sh: no lane \"$word\"; the lanes are: ${all[*]}" >&2; exit 2; }
        targets+=("$word")
        ;;
    esac
done
if [ ${#targets[@]} -eq 0 ]; then
    targets=("${all[@]}")
fi
mkdir -p "$work"
jobs=${WADI_JOBS:-$(nproc)}
expected=$(cat $here/minimal_host_hash.txt)

# The header libraries in a folder of their own: /usr/include has this machine's C library as well. Once.
copy_headers() {
    [ -z "${headers_copied:-}" ] || return 0
    headers_copied=yes
    rm -rf "$headers"
    mkdir -p "$headers/include" "$headers/share/cmake" "$headers/lib/cmake"
    cp -rLp /usr/include/{nlohmann,doctest,stb,CLI} "$headers/include/"
    cp -rp /usr/share/cmake/{nlohmann_json,CLI11} "$headers/share/cmake/"
    cp -rp /usr/lib/cmake/doctest "$headers/lib/cmake/"
    sed -i "s|\"/usr\"|\"$headers\"|" "$headers"/*/cmake/*/*Targets.cmake
}

# Stages become vector code, quicker to compile and some percent slower than a release's.
build() { # FOLDER TARGETS CMAKE_OPTION ...
    local folder=$1 targets=$2
    shift 2
    copy_headers
    # shellcheck disable=SC2086
    cmake -S . -B "$work/$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$headers" -DCMAKE_FIND_ROOT_PATH="$headers" -DWADI_BACKENDS=OFF \
        -DWADI_NARROW_MASKS=largest -DWADI_AVX512=OFF -DWADI_OPTIMISE_BASE="-O1;-ftree-vectorize;-fvect-cost-model=dynamic" \
        -DWADI_OPTIMISE_VECTOR="-O1;-ftree-vectorize;-fvect-cost-model=dynamic" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON "$@" >"$work/$folder.log" 2>&1 &&
        ninja -C "$work/$folder" -j "$jobs" $targets >>"$work/$folder.log" 2>&1 ||
        { tail -n 20 "$work/$folder.log"; echo "$folder: cannot be built, see $work/$folder.log"; return 1; }
}

# A row of the page's table: that of the same target is replaced, a new one comes last.
tell() { # TARGET COMPILER CELL ...
    local row="| $1 | $2"
    for cell in "${@:3}"; do row+=" | $cell"; done
    row+=" | $(git rev-parse --short HEAD)$(git diff --quiet HEAD -- . ":!$here/README.md" || echo ", changed") |"
    echo "$row"
    [ -n "$write" ] || return 0
    awk -v target="| $1 |" -v row="$row" '
        index($0, target) == 1 { print row; told = 1; next }
        table && !/^\|/ { if (!told) print row; told = 1; table = 0 }
        /^\| target \|/ { table = 1 }
        { print }
        END { if (!told) print row }' $here/README.md >"$work/README.md" && cp "$work/README.md" $here/README.md
}

cell() { # TARGET HASH EXPECTED: the reference has its hashes in the table, what is equal says so
    if [[ $2 == "$3" && $1 != "x86-64 Linux" ]]; then echo equal; else echo "\`${2:-none}\`"; fi
}

host_hash() { sed -n 's/.*hash \([0-9a-f]*\).*/\1/p' | tr -d '\r'; }

# RUNNER is a command ahead of a program's name. The golden test says what it found of each scene (-s), whether it is right or wrong.
run() { # TARGET COMPILER FOLDER SUFFIX RUNNER ...
    local target=$1 compiler=$2 folder=$3 suffix=$4
    shift 4
    local bin=$work/$folder/bin good=yes host
    "$@" "$bin/wadi-test-golden$suffix" -s >"$work/$folder.golden.log" 2>&1 || { good=; echo "$target: golden hashes FAILED, see $work/$folder.golden.log"; }
    host=$("$@" "$bin/wadi-minimal-host$suffix" 2>"$work/$folder.host.log" | host_hash)
    [[ $host == "$expected" ]] || { good=; echo "$target: smallest host: hash ${host:-MISSING}, not $expected"; }
    local found=()
    for scene in dam_break piles canyon; do
        found+=("$(cell "$target" "$(sed -n "s/.*${scene}_50 is \([0-9a-f]*\), golden.*/\1/p" "$work/$folder.golden.log" | head -n 1)" \
            "$(sed -n "s/^${scene}_50 //p" tests/golden/hashes.txt)")")
    done
    tell "$target" "$compiler" "${found[@]}" "$(cell "$target" "$host" "$expected")"
    [ -n "$good" ]
}

version() { "$@" 2>/dev/null | grep -m 1 -oE '[0-9]+\.[0-9]+(\.[0-9]+)*' | head -n 1; }

lane_windows() {
    samples/install_packages.sh g++-mingw-w64-x86-64-posix wine64 && build windows "wadi wadi-minimal-host wadi-test-golden" -DCMAKE_TOOLCHAIN_FILE="$PWD/$here/windows.cmake" || return 1
    local wine
    wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
    export WINEDEBUG=-all WINEPREFIX=$work/wine
    run "x86-64 Windows" "MinGW-w64 g++ $(version dpkg-query -W -f '${Version}' g++-mingw-w64-x86-64-posix), Wine $(version "$wine" --version)" windows .exe "$wine" || return 1
    local runs=${WADI_WINE_RUNS:-20}
    for n in $(seq "$runs"); do # waits that lose a wake-up show as runs that hang
        timeout 60 "$wine" "$work/windows/bin/wadi-minimal-host.exe" >/dev/null 2>&1 || { echo "windows: run $n of $runs hung or failed"; return 1; }
    done
    echo "windows: $runs runs of the smallest host, none hung"
}

# NEON belongs to the base set of this processor: what base is compiled to is the vector code.
lane_aarch64() {
    samples/install_packages.sh g++-aarch64-linux-gnu qemu-user && build aarch64 "wadi wadi-minimal-host wadi-test-golden" -DCMAKE_TOOLCHAIN_FILE="$PWD/$here/aarch64.cmake" || return 1
    python3 tests/unit/vectorised.py "$work/aarch64/tools/stagec_of_builder" . aarch64-linux-gnu-g++ || return 1
    run "aarch64 Linux" "g++ $(version aarch64-linux-gnu-g++ -dumpfullversion), QEMU $(version qemu-aarch64 --version)" aarch64 "" qemu-aarch64 -L /usr/aarch64-linux-gnu
}

# A page needs a host without Node.js's files: samples/minimal_host against what was installed, in Node.js and in Chromium.
wasm_host() { # FOLDER COMPILER_OPTION ...: prints the hashes that were found, "node HASH" and "Chromium HASH"
    local folder=$work/$1
    shift
    cmake --install "$folder" --component plugin --prefix "$folder/installed" >>"$folder.log" 2>&1 &&
        emcc -O1 -DWADI_STATIC -I"$folder/installed/include" samples/minimal_host/main.c "$folder/installed/lib/libwadi.a" -lstdc++ -fexceptions -msimd128 \
            -sINITIAL_MEMORY=256MB "$@" -o "$folder/host.js" >>"$folder.log" 2>&1 || { tail -n 5 "$folder.log"; return 1; }
    echo "node $(node --no-experimental-fetch "$folder/host.js" 2>>"$folder.host.log" | host_hash)"
    if command -v chromium >/dev/null; then
        echo "Chromium $(python3 $here/browser.py "$folder/host.js" 2>>"$folder.host.log" | host_hash)"
    fi
}

lane_wasm() {
    samples/install_packages.sh emscripten node-acorn || return 1
    # Where Node.js is not Debian's it does not look for Debian's modules; a build's time goes into starting emcc.
    export NODE_PATH=/usr/share/nodejs EMSDK_PYTHON=/usr/bin/python3
    local toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake good=yes kind hashes
    local options=("-DCMAKE_TOOLCHAIN_FILE=$toolchain" -DCMAKE_CROSSCOMPILING_EMULATOR= -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" -DWADI_OPTIMISE_BASE=-O2)
    build wasm "wadi wadi-test-golden wadi-minimal-host" "${options[@]}" -DCMAKE_CXX_FLAGS="-pthread -fexceptions -msimd128" -DCMAKE_C_FLAGS=-pthread \
        -DCMAKE_EXE_LINKER_FLAGS="-sPROXY_TO_PTHREAD -sPTHREAD_POOL_SIZE=8 -sINITIAL_MEMORY=1GB -sEXIT_RUNTIME -sNODERAWFS" &&
        run "WebAssembly" "Emscripten $(version emcc --version), Node.js $(version node --version)" wasm .js node --no-experimental-fetch || return 1
    build wasm_single wadi "${options[@]}" -DWADI_TESTS=OFF -DWADI_SAMPLES=OFF -DCMAKE_CXX_FLAGS="-fexceptions -msimd128" || return 1
    for kind in wasm wasm_single; do
        local threads=()
        [ $kind != wasm ] || threads=(-pthread -sPROXY_TO_PTHREAD -sPTHREAD_POOL_SIZE=8 -sEXIT_RUNTIME)
        hashes=$(wasm_host $kind "${threads[@]}") || { echo "$hashes"; return 1; }
        while read -r where hash; do
            echo "$kind: smallest host in $where: hash ${hash:-MISSING}"
            [[ $hash == "$expected" ]] || good=
        done <<<"$hashes"
        [ $kind != wasm_single ] || tell "WebAssembly without threads" "the same" "-" "-" "-" "$(cell wasm "${hashes##* }" "$expected")"
    done
    [ -n "$good" ]
}

lane_swiftshader() {
    samples/install_packages.sh chromium-common || return 1
    local driver native=${WADI_NATIVE_BUILD:-} suite failed=0 host
    driver=$(dpkg -L chromium-common | grep vk_swiftshader_icd.json) || { echo "swiftshader: chromium-common has no vk_swiftshader_icd.json"; return 1; }
    if [ -z "$native" ]; then
        native=$work/native
        cmake --preset ci -B "$native" -DWADI_CUDA=OFF >"$work/native.log" 2>&1 &&
            ninja -C "$native" -j "$jobs" conformance wadi-minimal-host wadi-test-golden >>"$work/native.log" 2>&1 || { tail -n 5 "$work/native.log"; return 1; }
    fi
    ln -sfn "$(realpath "$native")" "$work/swiftshader"
    run "x86-64 Linux" "g++ $(version c++ -dumpfullversion)" swiftshader "" env || failed=1 # beside it the CPU's, of the same build
    export VK_DRIVER_FILES=$driver WADI_BACKEND=vulkan
    for suite in ${WADI_SUITES:-step}; do
        "$native/bin/conformance" test --backend vulkan --suite "$suite" --max-masks 2 --max-steps 30 --max-cells 600 >"$work/swiftshader.$suite.log" 2>&1 || failed=1
        echo "swiftshader: $suite: $(tail -n 2 "$work/swiftshader.$suite.log" | tr '\n' ' ')"
    done
    run "SwiftShader (Vulkan)" "Chromium $(dpkg-query --show --showformat='${Version}' chromium-common)" swiftshader "" env || failed=1
    return $failed
}

# The set base alone and nothing optimised: what is tried is the archive, and bits are the same.
lane_static() {
    samples/install_packages.sh pkg-config || return 1
    build static "wadi wadi-minimal-host" -DWADI_STATIC=ON -DWADI_TESTS=OFF -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_UNITY_BUILD=ON \
        -DWADI_CHECK_INDICES=ON || return 1
    local prefix=$work/static/installed
    cmake --install "$work/static" --component plugin --prefix "$prefix" >>"$work/static.log" 2>&1 &&
        cmake -S "$prefix/share/wadi/examples" -B "$work/static/example" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >>"$work/static.log" 2>&1 &&
        ninja -C "$work/static/example" >>"$work/static.log" 2>&1 || { tail -n 20 "$work/static.log"; echo "static: see $work/static.log"; return 1; }
    local by_cmake by_pkg=
    by_cmake=$("$work/static/example/minimal_host" | host_hash)
    # shellcheck disable=SC2046
    cc -std=c99 samples/minimal_host/main.c -o "$work/static/host" $(PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config --cflags --libs wadi) &&
        by_pkg=$("$work/static/host" | host_hash)
    echo "static: smallest host by CMake $by_cmake, by pkg-config ${by_pkg:-MISSING}"
    tell "x86-64 Linux, one archive" "g++ $(version c++ -dumpfullversion)" "-" "-" "-" "$(cell static "$by_cmake" "$expected")"
    [[ $by_cmake == "$expected" && $by_pkg == "$by_cmake" ]]
}

failed=()
for target in "${targets[@]}"; do
    start=$SECONDS
    "lane_$target" || failed+=("$target")
    echo "$target: $((SECONDS - start)) s"
done
[ ${#failed[@]} -eq 0 ] || { echo "FAILED: ${failed[*]}"; exit 1; }
