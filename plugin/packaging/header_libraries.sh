#!/usr/bin/env bash
# Copies the header libraries that Wadi is compiled with into a folder of their own, for compilers of other systems: /usr/include has this
# machine's C library as well. Usage: header_libraries.sh FOLDER; give CMake the folder as CMAKE_PREFIX_PATH and CMAKE_FIND_ROOT_PATH.
set -euo pipefail
[ $# -eq 1 ] || { echo "Usage: header_libraries.sh FOLDER" >&2; exit 2; }
rm -rf "$1"
mkdir -p "$1/include" "$1/share/cmake" "$1/lib/cmake"
folder=$(cd "$1" && pwd)
cp -rLp /usr/include/{nlohmann,doctest,stb,CLI,glm,vulkan,vk_video,volk.h,volk.c} "$folder/include/"
cp -rp /usr/share/cmake/{nlohmann_json,CLI11,glm} "$folder/share/cmake/"
cp -rp /usr/lib/cmake/doctest "$folder/lib/cmake/"
sed -i "s|\"/usr\"|\"$folder\"|" "$folder"/*/cmake/*/*Targets.cmake
