#!/usr/bin/env bash
# Builds Wadi for platforms that no release is for and runs the golden hashes and the smallest host there; --help says what each lane needs.
set -euo pipefail
cd "$(dirname "$0")/../.."

all=(swiftshader static wasm)
usage() {
    cat <<EOF
Usage: run.sh [--write] [LANE ...]; all lanes where none is named. Exit status 1 where one fails, 2 for a wrong command line.
  --write      lanes that passed are stamped in tests/stamps.csv and the table of tests/platforms/README.md (tests/lanes.py)

lane         installs                          packages, build  runs
wasm         emscripten node-acorn chromium     1.6 GB, 0.1 GB   in Node.js and in headless Chromium, with threads: golden hashes,
                                                                 smallest host; without: smallest host; controls of browser.py
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

# Stages become vector code, quicker to compile and some percent slower than a release's.
build() { # FOLDER TARGETS CMAKE_OPTION ...
    local folder=$1 targets=$2
    shift 2
    [ -e "$headers" ] || plugin/packaging/header_libraries.sh "$headers"
    # shellcheck disable=SC2086
    cmake -S . -B "$work/$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$headers" -DCMAKE_FIND_ROOT_PATH="$headers" -DWADI_BACKENDS=OFF \
        -DWADI_NARROW_MASKS=largest -DWADI_OPTIMISE_BASE="-O1;-ftree-vectorize;-fvect-cost-model=dynamic" \
        -DWADI_OPTIMISE_VECTOR="-O1;-ftree-vectorize;-fvect-cost-model=dynamic" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON "$@" >"$work/$folder.log" 2>&1 &&
        ninja -C "$work/$folder" -j "$jobs" $targets >>"$work/$folder.log" 2>&1 ||
        { tail -n 20 "$work/$folder.log"; echo "$folder: cannot be built, see $work/$folder.log"; return 1; }
}

# What a lane's stamp is to say of a target, once all of the lane has passed.
stamps=()
tell() { # TARGET COMPILER [--golden LOG] [--host HASH] [--ran TEXT]
    echo "$1 ($2) ${*:3}"
    stamps+=("$(printf '%q ' --target "$1" --tools "$2" "${@:3}")")
}

host_hash() { # of what a host prints
    sed -n 's/.*hash \([0-9a-f]*\).*/\1/p' | tr -d '\r'
}

# Sets $found to the hash that a host printed; good where it is the one kept and the host ended, with status 0.
limit=1800
judge() { # WHAT LOG COMMAND ...
    local what=$1 log=$2 status=0
    shift 2
    found=$(timeout "$limit" "$@" 2>"$log" | host_hash) || status=$?
    [ $status -eq 0 ] || found="${found:-none}, status $status"
    [[ $found == "$expected" ]] || { echo "$what: hash ${found:-none}, not $expected; see $log"; return 1; }
}

# RUNNER is a command ahead of a program's name. The golden test says what it found of each scene (-s). `also` is what else ran there.
run() { # TARGET COMPILER FOLDER SUFFIX RUNNER ...
    local target=$1 compiler=$2 folder=$3 suffix=$4
    shift 4
    local bin=$work/$folder/bin good=yes log=$work/${target//[ ,()]/_} found
    timeout "$limit" "$@" "$bin/wadi-test-golden$suffix" -s >"$log.golden.log" 2>&1 || { good=; echo "$target: golden hashes FAILED, see $log.golden.log"; }
    judge "$target: smallest host" "$log.host.log" "$@" "$bin/wadi-minimal-host$suffix" || good=
    [ -n "$good" ] && tell "$target" "$compiler" --golden "$log.golden.log" --host "$found" ${also:+--ran "$also"}
}

version() { "$@" 2>/dev/null | grep -m 1 -oE '[0-9]+\.[0-9]+(\.[0-9]+)*' | head -n 1; }

wasm_compile="-fexceptions -msimd128"
# Emscripten programs end with main() (EXIT_RUNTIME); pages wait for threads only beside their own (PROXY_TO_PTHREAD).
wasm_options=(-fexceptions -msimd128 -sEXIT_RUNTIME)
wasm_threads=(-pthread -sPROXY_TO_PTHREAD -sPTHREAD_POOL_SIZE=8)
in_node=(node --no-experimental-fetch)
in_page=(python3 "$here/browser.py" --limit 1500)

# samples/minimal_host against what was installed, in Node.js and in Chromium; then programs that the same judgement must refuse. Sets $hashes.
wasm_host() { # FOLDER COMPILER_OPTION ...
    local folder=$work/$1 kind=$1 good=yes found
    shift
    cmake --install "$folder" --component plugin --prefix "$folder/installed" >>"$folder.log" 2>&1 &&
        emcc -O1 -DWADI_STATIC -I"$folder/installed/include" samples/minimal_host/main.c "$folder/installed/lib/libwadi.a" -lstdc++ \
            "${wasm_options[@]}" -sINITIAL_MEMORY=256MB "$@" -o "$folder/host.js" >>"$folder.log" 2>&1 &&
        emcc -O1 $here/control.c "${wasm_options[@]}" "$@" -o "$folder/control.js" >>"$folder.log" 2>&1 || { tail -n 5 "$folder.log"; return 1; }
    judge "$kind: installed host in Node.js" "$folder.node.log" "${in_node[@]}" "$folder/host.js" || good=
    hashes=("$found")
    judge "$kind: installed host in Chromium" "$folder.page.log" "${in_page[@]}" "$folder/host.js" || good=
    hashes+=("$found")
    echo "$kind: installed host in Node.js: ${hashes[0]:-no hash}, in Chromium: ${hashes[1]:-no hash}"

    local other=${expected:1}0 words seen=() right
    for words in "$expected 0" "$expected 1" "$expected hang" "$other 0"; do
        # shellcheck disable=SC2086
        if judge control "$folder.control.log" python3 "$here/browser.py" --limit 10 "$folder/control.js" $words >/dev/null; then
            seen+=("taken")
        else
            seen+=("refused: $found")
        fi
    done
    echo "$kind: controls in Chromium: $(printf '%s; ' "${seen[@]}")"
    right=(taken "refused: $expected, status 1" "refused: $expected, status 124" "refused: $other")
    [[ ${seen[*]} == "${right[*]}" ]] || { good=; echo "$kind: controls must be: $(printf '%s; ' "${right[@]}")"; }
    [ -n "$good" ]
}

lane_wasm() {
    samples/install_packages.sh wasm || return 1
    # Where Node.js is not Debian's it does not look for Debian's modules; a build's time goes into starting emcc.
    export NODE_PATH=/usr/share/nodejs EMSDK_PYTHON=/usr/bin/python3
    local toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake good=yes embedded="" file hashes=() emscripten node chromium
    emscripten="Emscripten $(version emcc --version)" node="Node.js $(version node --version)" chromium="Chromium $(version chromium --version)"
    python3 $here/test_browser.py || good=
    # What the golden test reads lies in the programs: a page has no files. They are linked anew, so that it is what the files are now.
    for file in tests/golden/hashes.txt samples/levels/{dam_break,piles,canyon}/level.json samples/levels/canyon/terrain.png; do
        embedded+=" --embed-file $PWD/$file@$PWD/$file"
    done
    rm -f "$work"/wasm/bin/*.js
    local options=("-DCMAKE_TOOLCHAIN_FILE=$toolchain" -DCMAKE_CROSSCOMPILING_EMULATOR= -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" -DWADI_OPTIMISE_BASE=-O2)
    build wasm "wadi wadi-test-golden wadi-minimal-host" "${options[@]}" -DCMAKE_CXX_FLAGS="-pthread $wasm_compile" -DCMAKE_C_FLAGS=-pthread \
        -DCMAKE_EXE_LINKER_FLAGS="${wasm_options[*]} ${wasm_threads[*]} -sINITIAL_MEMORY=1GB$embedded" || return 1
    run "WebAssembly" "$emscripten, $node" wasm .js "${in_node[@]}" || good=
    run "WebAssembly, a page" "$emscripten, $chromium" wasm .js "${in_page[@]}" || good=
    wasm_host wasm "${wasm_threads[@]}" || good=

    build wasm_single wadi "${options[@]}" -DWADI_TESTS=OFF -DWADI_SAMPLES=OFF -DCMAKE_CXX_FLAGS="$wasm_compile" || return 1
    wasm_host wasm_single || good=
    tell "WebAssembly without threads" "$emscripten, $node" --host "${hashes[0]:-}"
    tell "WebAssembly without threads, a page" "$emscripten, $chromium" --host "${hashes[1]:-}"
    [ -n "$good" ]
}

lane_swiftshader() {
    samples/install_packages.sh swiftshader || return 1
    local driver native=${WADI_NATIVE_BUILD:-} suite failed=0
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
    local also="conformance: ${WADI_SUITES:-step}"
    run "SwiftShader (Vulkan)" "Chromium $(dpkg-query --show --showformat='${Version}' chromium-common)" swiftshader "" env || failed=1
    return $failed
}

# The set base alone and nothing optimised: what is tried is the archive, and bits are the same.
lane_static() {
    samples/install_packages.sh tests || return 1
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
    tell "x86-64 Linux, one archive" "g++ $(version c++ -dumpfullversion)" --host "$by_cmake"
    [[ $by_cmake == "$expected" && $by_pkg == "$by_cmake" ]]
}

failed=()
for target in "${targets[@]}"; do
    start=$SECONDS
    stamps=()
    if ! "lane_$target"; then
        failed+=("$target")
    elif [ -n "$write" ]; then
        for stamp in "${stamps[@]}"; do eval "tests/lanes.py passed $target $stamp" || true; done
    fi
    echo "$target: $((SECONDS - start)) s"
done
[ ${#failed[@]} -eq 0 ] || { echo "FAILED: ${failed[*]}"; exit 1; }
