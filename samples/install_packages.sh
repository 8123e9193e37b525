#!/usr/bin/env bash
# Installs what Wadi needs to build and run on Debian 12, or the packages named, and nothing if all of it is there.
set -euo pipefail

packages=(
    # build
    build-essential cmake ninja-build python3 python3-numpy pkg-config
    # shaders and Vulkan; mesa-vulkan-drivers brings a software device
    glslang-tools spirv-tools libvulkan-dev libvulkan-volk-dev libvulkan1 mesa-vulkan-drivers vulkan-validationlayers
    # NVIDIA's Vulkan driver loads these
    libegl1 libglvnd0 libgl1 libopengl0 libglx0 libgles2
    # the viewer; xvfb, twm and xdotool for its tests in a window, ffmpeg for its videos
    libglfw3-dev libimgui-dev xvfb twm xdotool ffmpeg
    # tests of the C# binding
    mono-mcs mono-runtime
    # pictures
    libdeflate-dev
    # header libraries
    libglm-dev doctest-dev nlohmann-json3-dev libcli11-dev libstb-dev
)
[[ $# -eq 0 ]] || packages=("$@")

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

echo "These packages are missing and will be installed with apt-get: ${missing[*]}"
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
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
