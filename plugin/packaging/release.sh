#!/usr/bin/env bash
# Makes all that a version consists of and tries each part where nothing of it was built; --help says what, how long, and what it needs.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cd "$root"

systems=(linux-x86_64 linux-aarch64 windows-x86_64 macos-x86_64 macos-arm64)
all=("${systems[@]}" godot unity)
out=$root/build/release-$(sed -nE 's/^project\(wadi VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
tag=
usage() {
    cat <<EOT
Usage: release.sh [--out FOLDER] [--tag] [PART ...]; all parts where none is named: ${all[*]}
  --out FOLDER   where the files of the version go (build/release-VERSION)
  --tag          when all parts are good and nothing is changed in the tree: git tag vVERSION here (nothing is published)

part            what it makes                 tried
linux-*         wadi-VERSION-PART.zip         golden hashes; the smallest host in Debian 11, 12, sid, and beside nothing but glibc 2.31
                                              (ARM under QEMU, with the three Debians' libraries)
windows-x86_64  the same                      golden hashes and the smallest host under Wine
macos-*         the same                      that a host links it, that it is signed for itself: BUILT, NOT RUN
godot           wadi-godot-VERSION.zip        the extension under a stand-in engine, on Windows by Wine; download to moving water in Godot
unity           com.wadi.terrain-VERSION.tgz  compiled and run over a stand-in of Unity: NOT RUN IN UNITY
Beside them SIZES.txt, wadi-VERSION.spdx.json, SHA256SUMS. "godot" and "unity" take the libraries of the systems that are there, and want all
of them unless --partial is given.

Needs Debian 12, root (debootstrap), 6 GB, and of the network Debian's packages and PyPI: requirements.txt is the compiler. Without a compiler cache
all parts take about an hour and a half on two processors.
EOT
}

partial=
parts=()
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) usage && exit ;;
    --tag) tag=yes ;;
    --partial) partial=yes ;;
    --out)
        [ $# -gt 1 ] || { echo "release.sh: --out needs a folder" >&2; exit 2; }
        out=$(realpath -m "$2")
        shift
        ;;
    *)
        [[ " ${all[*]} " == *" $1 "* ]] || { echo "release.sh: no part \"$1\"; the parts are: ${all[*]}" >&2; exit 2; }
        parts+=("$1")
        ;;
    esac
    shift
done
[ ${#parts[@]} -ne 0 ] || parts=("${all[@]}")
version=$(sed -nE 's/^project\(wadi VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
work=$root/build/packaging
tools=$work/tools
headers=$work/headers
expected=$(cat tests/platforms/minimal_host_hash.txt)
mkdir -p "$work" "$out"
ziglang=
say() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

declare -A zig_target=([linux-x86_64]=x86_64-linux-gnu.2.28 [linux-aarch64]=aarch64-linux-gnu.2.28 [windows-x86_64]=x86_64-windows-gnu
    [macos-x86_64]=x86_64-macos.13.0 [macos-arm64]=aarch64-macos.13.0)
declare -A library_of=([linux-x86_64]=libwadi.so.1 [linux-aarch64]=libwadi.so.1 [windows-x86_64]=libwadi.dll [macos-x86_64]=libwadi.1.dylib [macos-arm64]=libwadi.1.dylib)
zip_of() { echo "$out/wadi-$version-$1.zip"; }

prepare() {
    samples/install_packages.sh tests packaging
    "$here/zig.sh" "$work/zig" "$tools" "${zig_target[@]}"
    ziglang=$(echo "$work"/zig/lib/python3*/site-packages/ziglang)
    "$here/header_libraries.sh" "$headers"
    python3 "$here/third_party.py" texts --zig "$ziglang" "$work/THIRD_PARTY.txt"
    python3 "$here/third_party.py" texts --zig "$ziglang" --windows "$work/THIRD_PARTY.windows.txt"
}

# The library with all masks, the smallest host and the golden test beside it, and its zip.
build() { # PART
    local folder=$work/$1 texts=$work/THIRD_PARTY.txt sets=all tests=ON targets="wadi wadi-hello wadi-minimal-host wadi-test-golden"
    [[ $1 != windows* ]] || texts=$work/THIRD_PARTY.windows.txt
    [[ $1 != macos-x86_64 ]] || sets="base;avx2" # few of Apple's computers had AVX-512
    [[ $1 != macos* ]] || tests=OFF targets="wadi wadi-hello" # nothing runs them
    # ccache guesses a compiler's kind from its name
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_COMPILERTYPE=clang CCACHE_COMPILERCHECK="string:$(cat "$here/requirements.txt") ${zig_target[$1]}"
    cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$here/zig.cmake" -DWADI_ZIG_TOOLS="$tools" \
        -DWADI_ZIG_TARGET="${zig_target[$1]}" -DCMAKE_PREFIX_PATH="$headers" -DCMAKE_FIND_ROOT_PATH="$headers" -DWADI_CUDA=OFF \
        -DWADI_TESTS=$tests "-DWADI_CPU_SETS=$sets" -DWADI_OPTIMISE_VECTOR=-O2 -DWADI_THIRD_PARTY="$texts" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
        -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 >"$folder.log" 2>&1 &&
        ninja -C "$folder" $targets >>"$folder.log" 2>&1 &&
        (cd "$folder" && cpack -G ZIP -B "$folder/zip" >>"$folder.log" 2>&1) ||
        { tail -n 20 "$folder.log"; echo "$1: cannot be built, see $folder.log"; return 1; }
    local made=("$folder"/zip/wadi-*.zip)
    cp "${made[0]}" "$(zip_of "$1")"
    # What a user unpacks, and a host compiled against that alone.
    rm -rf "$folder/unpacked"
    mkdir "$folder/unpacked"
    python3 -m zipfile -e "$(zip_of "$1")" "$folder/unpacked"
    mv "$folder"/unpacked/wadi-*/plugin "$folder/unpacked/plugin"
    local plugin=$folder/unpacked/plugin link=${library_of[$1]}
    [[ $1 != windows* ]] || link=libwadi.dll.a
    # Optimised as the library is: zig makes C libraries anew for each kind.
    "$tools/${zig_target[$1]}/cc" -std=c99 -O3 -DNDEBUG -Wall -Wextra -Werror "$plugin/examples/main.c" -I"$plugin/include" "$plugin/lib/$link" -o "$folder/unpacked/host" &&
        local bytes most=10000000 && bytes=$(stat -c %s "$(zip_of "$1")") && echo "$1: $bytes bytes" &&
        { [ "$bytes" -lt $most ] || { echo "$1: the zip has $bytes bytes, $most are allowed"; return 1; }; }
}

# What a part's stamp is to say (tests/lanes.py): `tell`, set by what tried it.
compiler="clang of $(grep -o 'ziglang==[0-9.]*' "$here/requirements.txt")"
told() { # PART WHAT RUNNER
    tell=(--target "$2" --tools "$compiler${3:+, $3}" --golden "$work/$1.golden.log" --host "$expected" "${@:4}")
}

same() { # WHERE COMMAND ...: the smallest host gives its hash there
    local found
    found=$(timeout 600 "${@:2}" 2>&1) || { echo "$1: the smallest host failed: $found"; return 1; }
    found=$(sed -n 's/.*hash \([0-9a-f]*\).*/\1/p' <<<"$found" | tr -d '\r')
    [ "$found" = "$expected" ] || { echo "$1: hash ${found:-none}, not $expected"; return 1; }
    echo "$1: hash $found"
}

golden() { # PART COMMAND ...: all of the golden test
    timeout 1800 "${@:2}" -s >"$work/$1.golden.log" 2>&1 || { tail -n 20 "$work/$1.golden.log"; echo "$1: golden hashes FAILED"; return 1; }
    echo "$1: golden hashes equal"
}

# A system's own libraries as they are unpacked, nothing else of it: that is what a program that needs no more finds.
environment() { # SUITE ARCHITECTURE; prints its folder
    local folder=$work/environments/$1-$2
    if [ ! -e "$folder/.ready" ]; then
        rm -rf "$folder"
        mkdir -p "$folder"
        debootstrap --foreign --variant=minbase --arch="$2" "$1" "$folder" >"$folder.log" 2>&1 || { tail -n 5 "$folder.log" >&2; return 1; }
        touch "$folder/.ready"
    fi
    echo "$folder"
}

in_environment() { # PART SUITE
    local folder
    folder=$(environment "$2" amd64) || return 1
    rm -rf "$folder/wadi" && cp -r "$work/$1/unpacked" "$folder/wadi" && same "$1, Debian $2" chroot "$folder" /usr/bin/env LD_LIBRARY_PATH=/wadi/plugin/lib /wadi/host
}

# glibc of Debian 11 alone: no C++ library, no shell. A program's loader is asked for by its path.
beside_glibc() { # PART
    local from folder=$work/environments/glibc
    from=$(environment bullseye amd64) || return 1
    rm -rf "$folder" && mkdir -p "$folder/lib64" "$folder/lib" && cp -r "$work/$1/unpacked" "$folder/wadi"
    cp -L "$from"/lib/x86_64-linux-gnu/{libc.so.6,libm.so.6,libdl.so.2,libpthread.so.0,librt.so.1} "$folder/lib/" && cp -L "$from"/lib/x86_64-linux-gnu/ld-2.*.so "$folder/lib64/ld-linux-x86-64.so.2"
    same "$1, glibc 2.31 alone" chroot "$folder" /lib64/ld-linux-x86-64.so.2 --library-path /lib:/wadi/plugin/lib /wadi/host
}

# The widest set that this processor has, not the one that runs everywhere.
fast() { # PART
    ! grep -qw avx2 /proc/cpuinfo || "$work/$1/bin/wadi-minimal-host" | grep -q "(avx" || { echo "$1: runs the base set where AVX2 is there"; return 1; }
}

# A host that closes the library ends well: at the end nothing of it may be called that is gone.
closes() { # PART
    cc -std=gnu99 -O1 tests/packaging/open_and_close.c -Iplugin/include -o "$work/$1/unpacked/open_and_close" -ldl &&
        "$work/$1/unpacked/open_and_close" "$work/$1/unpacked/plugin/lib/${library_of[$1]}" samples/levels/dam_break/level.json || { echo "$1: a host that closes the library crashes"; return 1; }
}

# What the site's first page says, word for word.
first_steps() { python3 "$here/first_steps.py" plugin/docs/hello.md "$(zip_of "$1")" "${@:2}"; } # PART [OPTION ...]

try_linux-x86_64() {
    fast linux-x86_64 && closes linux-x86_64 && first_steps linux-x86_64 && golden linux-x86_64 "$work/linux-x86_64/bin/wadi-test-golden" && in_environment linux-x86_64 bullseye && in_environment linux-x86_64 bookworm &&
        in_environment linux-x86_64 sid && beside_glibc linux-x86_64 &&
        told linux-x86_64 "release, x86-64 Linux" "" --ran "the first page's steps, Debian 11, 12, sid, glibc 2.31 alone"
}
try_linux-aarch64() {
    local suite folder
    # NEON belongs to this processor's base set: that the stages' rows are vectors is seen nowhere else.
    python3 tests/unit/vectorised.py --clang "$work/linux-aarch64/tools/stagec_of_builder" . "$tools/${zig_target[linux-aarch64]}/c++" -O3 || return 1
    for suite in bullseye bookworm sid; do
        folder=$(environment $suite arm64) && rm -rf "$folder/wadi" && cp -r "$work/linux-aarch64/unpacked" "$folder/wadi" &&
            same "linux-aarch64, Debian $suite (QEMU)" qemu-aarch64 -L "$folder" -E LD_LIBRARY_PATH=/wadi/plugin/lib "$folder/wadi/host" || return 1
    done
    golden linux-aarch64 qemu-aarch64 -L "$(environment bullseye arm64)" "$work/linux-aarch64/bin/wadi-test-golden" &&
        told linux-aarch64 "release, aarch64 Linux" "QEMU $(qemu-aarch64 --version | sed -n '1s/.*version \([0-9.]*\).*/\1/p')" --ran "Debian 11, 12, sid"
}
no_hang() { # COMMAND ...: waits that lose a wake-up show as runs that hang, 1 to 6 of 60 once
    for n in $(seq 20); do timeout 60 "$@" >/dev/null 2>&1 || { echo "run $n of 20 of the smallest host hung or failed"; return 1; }; done
}
try_windows-x86_64() {
    local wine folder=$work/windows-x86_64
    wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
    export WINEDEBUG=-all WINEPREFIX=$work/wine
    cp "$folder/unpacked/plugin/bin/libwadi.dll" "$folder/unpacked/" && cp "$folder/unpacked/host" "$folder/unpacked/host.exe" &&
        golden windows-x86_64 "$wine" "$folder/bin/wadi-test-golden.exe" && no_hang "$wine" "$folder/unpacked/host.exe" && same "windows-x86_64, Wine" "$wine" "$folder/unpacked/host.exe" &&
        first_steps windows-x86_64 --wine "$wine" && told windows-x86_64 "release, x86-64 Windows" "$("$wine" --version)" --ran "the first page's steps"
}
try_macos() { "$work/zig/bin/python3" "$here/mach_o.py" "$work/$1/unpacked/plugin/lib/${library_of[$1]}" "$work/$1/unpacked/host" && echo "$1: built, linked, NOT RUN" && tell=(--target "release, $1" --tools "$compiler"); }
try_macos-x86_64() { try_macos macos-x86_64; }
try_macos-arm64() { try_macos macos-arm64; }

# Which systems' libraries are there; all of them unless --partial.
present() { # PART; prints them
    local part found=()
    for part in "${systems[@]}"; do
        if [ -e "$work/$part/unpacked/plugin" ]; then found+=("$part"); elif [ -z "$partial" ]; then
            echo "$1: there is no library of $part: make that part first, or say --partial" >&2
            return 1
        fi
    done
    [ ${#found[@]} -ne 0 ] || { echo "$1: no library of any system is there" >&2; return 1; }
    echo "${found[*]}"
}
library() { find "$work/$1/unpacked/plugin" -name "${library_of[$1]}"; } # PART

# The extension for each system, against the interface of the Godot that is here.
make_godot() {
    local names part name folder=$work/godot interface=() godot=tests/godot/godot.sh
    names=$(present godot) || return 1
    "$godot" --version >/dev/null || return 1
    rm -rf "$folder/addons"
    local of_godot=()
    for part in $names; do
        name=${part/-/.}
        name=${name/aarch64/arm64}
        of_godot+=("$name")
        plugin/godot/build.sh --system "$name" --cc "$tools/${zig_target[$part]}/cc" --library "$(library "$part")" --headers "$headers/include" \
            --godot "$root/$godot" "${interface[@]}" --output "$folder" || return 1
        interface=(--interface "$folder/interface")
    done
    python3 plugin/godot/package.py --addon "$folder/addons/wadi" --third-party "$work/THIRD_PARTY.windows.txt" --systems "${of_godot[@]}" --out "$out" &&
        tests/godot/first_minutes.sh "$out/wadi-godot-$version.zip" || return 1
    tell=(--target "Godot add-on" --tools "Godot $("$godot" --version | tail -n 1), clang of zig" --ran "download to moving water on Linux")
    if [[ " $names " == *" windows-x86_64 "* ]]; then
        tests/godot/windows.sh "$folder/addons/wadi" "$folder/interface" "$tools/${zig_target[windows-x86_64]}/cc" "$work/godot_windows" || return 1
        tell[5]+=", a stand-in engine under Wine"
    fi
}

make_unity() {
    local names part libraries=()
    names=$(present unity) || return 1
    for part in $names; do libraries+=("--$part" "$(library "$part")"); done
    python3 plugin/csharp/unity/make_package.py "${libraries[@]}" --notices "$work/THIRD_PARTY.windows.txt" ${partial:+--partial} --archive "$out" "$work/unity" || return 1
    if [[ " $names " == *" linux-x86_64 "* ]]; then
        python3 tests/csharp/check.py "$out/com.wadi.terrain-$version.tgz" "$root" || return 1
        tell=(--target "Unity package" --tools "$(mono --version | head -n 1 | cut -d" " -f1-5)" --ran "over a stand-in of Unity, not in Unity")
    fi
}

# Every file of the tree has an author and a licence, if only that none has been chosen (REUSE 3.0). The tool wants LICENSES at the top.
licences() {
    local folder=$work/reuse
    rm -rf "$folder" && mkdir -p "$folder" && git ls-files -z | xargs -0 cp --parents -t "$folder" && cp -r .reuse/licences "$folder/LICENSES" &&
        reuse --root "$folder" lint >"$work/reuse.log" 2>&1 || { tail -n 20 "$work/reuse.log"; echo "licences: reuse lint FAILED"; return 1; }
    echo "licences: every file has one (REUSE 3.0)"
}

# What is beside the parts: of all that lie there.
finish() {
    local files=()
    mapfile -t files < <(find "$out" -maxdepth 1 \( -name '*.zip' -o -name '*.tgz' \) -printf '%p\n' | sort)
    python3 "$here/sizes.py" "${files[@]}" >"$out/SIZES.txt"
    local options=()
    for file in "${files[@]}"; do options+=(--file "$file"); done
    python3 "$here/third_party.py" sbom --version "$version" --commit "$commit" --zig "$ziglang" --windows "${options[@]}" "$out/wadi-$version.spdx.json"
    (cd "$out" && find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%P\n' | sort | xargs sha256sum >SHA256SUMS)
    cat "$out/SIZES.txt"
}

commit=$(git rev-parse --short HEAD)$(git diff --quiet HEAD || echo "-changed")
[ -z "$tag" ] || [ ${#parts[@]} -eq ${#all[@]} ] || { echo "release.sh: --tag is for all parts" >&2; exit 2; }
[ -z "$tag" ] || [ -z "$(git status --porcelain)" ] || { echo "release.sh: --tag: the tree has changes; commit them, or take a clean clone" >&2; exit 2; }
[ -z "$tag" ] || ! git rev-parse -q --verify "refs/tags/v$version" >/dev/null || { echo "release.sh: --tag: there is a tag v$version" >&2; exit 2; }
say packages
prepare
failed=()
for part in licences "${parts[@]}"; do
    say "$part"
    start=$SECONDS
    tell=()
    good=yes
    case $part in
    licences) licences || good= ;;
    godot | unity) "make_$part" || good= ;;
    *) { build "$part" && "try_$part"; } || good= ;;
    esac
    [ -n "$good" ] || failed+=("$part")
    if [ -n "$good" ] && [ ${#tell[@]} -ne 0 ]; then tests/lanes.py passed "release:$part" "${tell[@]}" || true; fi
    echo "$part: $((SECONDS - start)) s"
done
say "sizes and checksums"
finish
[ ${#failed[@]} -eq 0 ] || { echo "FAILED: ${failed[*]}"; exit 1; }
if [ -n "$tag" ]; then
    git tag -a "v$version" -m "Wadi $version" && echo "tagged v$version"
fi
echo "good: ${parts[*]}, in $out"
