#!/usr/bin/env bash
# Installs on Debian 12 what is missing of what a purpose needs, and nothing where all of it is there.
# Usage: install_packages.sh [PURPOSE ...]; the purposes are below, tests unless one is named.
set -euo pipefail

declare -A packages_of
packages_of[demo]="build-essential cmake ninja-build python3 libglm-dev nlohmann-json3-dev libcli11-dev libstb-dev libdeflate-dev
    glslang-tools spirv-tools libvulkan-dev libvulkan-volk-dev mesa-vulkan-drivers libglfw3-dev libimgui-dev" # mesa: a software device
[[ ! -e /dev/nvidiactl ]] || packages_of[demo]+=" libegl1 libglvnd0 libgl1 libopengl0 libglx0 libgles2" # NVIDIA's Vulkan driver loads these
packages_of[viewer]="${packages_of[demo]} ffmpeg" # for its videos
packages_of[import]="${packages_of[demo]} libtiff-dev libtinyexr-dev" # TIFFs and EXRs in wadi-import
packages_of[docs]="mkdocs mkdocs-material python3-pymdownx doxygen nodejs libjs-katex fonts-katex" # the site: plugin/docs
packages_of[python]="python3-numpy python3-pytest python3-matplotlib python3-xarray python3-rasterio python3-tqdm python3-nbclient python3-ipykernel" # plugin/python, all that it can use, and samples/notebooks
# To run all tests: the site, the viewer in a window, validation layers, the C# binding, Python.
packages_of[tests]="${packages_of[viewer]} ${packages_of[docs]} ${packages_of[python]} libtiff-dev libtinyexr-dev doctest-dev pkg-config vulkan-validationlayers xvfb twm xdotool mono-mcs mono-runtime unzip"
packages_of[contributing]="clang-format-14 pre-commit" # beside the tests: CONTRIBUTING.md
# Lanes of tests/platforms, beside the tests.
packages_of[web]="build-essential cmake ninja-build python3 nlohmann-json3-dev libstb-dev libcli11-dev doctest-dev libvulkan-dev
    libvulkan-volk-dev emscripten node-acorn brotli" # the page
packages_of[wasm]="emscripten node-acorn chromium"
packages_of[blender]="python3-venv libgl1 libegl1 libice6 libsm6 libxext6 libxfixes3 libxi6 libxkbcommon0 libxrender1 libxxf86vm1"
packages_of[swiftshader]="chromium-common"
# What plugin/packaging/release.sh makes environments with and runs other systems' programs in, beside the tests.
packages_of[packaging]="python3-venv debootstrap qemu-user wine64 reuse"

[[ $# -ne 0 ]] || set -- tests
packages=()
for purpose in "$@"; do
    if [[ -z $purpose || -z ${packages_of[$purpose]:-} ]]; then
        echo "install_packages.sh: no purpose \"$purpose\"; the purposes are: demo viewer import docs python tests contributing web wasm blender swiftshader packaging" >&2
        exit 2
    fi
    # shellcheck disable=SC2206 # words
    packages+=(${packages_of[$purpose]})
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "install_packages.sh: this is not a Debian system; install the counterparts of: ${packages[*]}" >&2
    exit 1
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    exit 0
fi

echo "${#missing[@]} packages are missing and will be installed with apt-get: ${missing[*]}"
as_root=()
if [[ $EUID -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
        echo "install_packages.sh: not root and no sudo; as root run: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    if [[ ! -t 0 ]]; then
        echo "install_packages.sh: no terminal to ask on; run: sudo apt-get install ${missing[*]}" >&2
        exit 1
    fi
    read -r -p "Install them with sudo? [y/N] " answer
    if [[ ${answer,,} != y && ${answer,,} != yes ]]; then
        echo "install_packages.sh: nothing was installed" >&2
        exit 1
    fi
    as_root=(sudo)
fi
log=$(mktemp /tmp/wadi-packages.XXXXXX.log)
if ! { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 5 "$log" >&2
    echo "install_packages.sh: apt-get failed; all that it said is in $log" >&2
    exit 1
fi
rm "$log"
