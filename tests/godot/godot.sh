#!/usr/bin/env bash
# Starts Godot 4.4 or later with the given arguments: the command in WADI_GODOT, or the installed "godot", or the one of a folder with
# Debian sid that this script makes once (WADI_GODOT_FOLDER, /opt/godot-sid; 1.7 GB, needs root and debootstrap). Exit status 77 and a
# reason where there is none. With --installed ahead no folder is made. With --screen ahead the engine gets an X server of its own and a
# software Vulkan driver; with --run COMMAND behind that another command is started where the engine would be: an exported game.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=${WADI_GODOT_FOLDER:-/opt/godot-sid}
packages="godot godot-template-release xdotool mesa-vulkan-drivers libvulkan1 xvfb xauth gcc libc6-dev"

no_godot() { echo "godot.sh: no Godot 4.4: $1" >&2; exit 77; }

new_enough() { # COMMAND
    local version
    version=$($1 --version 2>/dev/null | tail -n 1) || return 1
    [[ $version =~ ^4\.([0-9]+) ]] && [ "${BASH_REMATCH[1]}" -ge 4 ]
}

make_folder() {
    [ "$(id -u)" = 0 ] || no_godot "\"godot\" is not installed, and making $folder needs root"
    command -v debootstrap >/dev/null || no_godot "\"godot\" is not installed, and making $folder needs the package debootstrap"
    mkdir -p "$folder"
    exec 9>"$folder.lock"
    flock 9
    [ ! -e "$folder/.ready" ] || return 0
    echo "godot.sh: making $folder, see $folder.log" >&2
    {
        debootstrap --variant=minbase sid "$folder" &&
            chroot "$folder" apt-get install -qy --no-install-recommends $packages
    } >"$folder.log" 2>&1 || no_godot "making $folder failed, see $folder.log"
    touch "$folder/.ready"
}

mount_folder() {
    mkdir -p "$folder$root"
    [ -e "$folder/proc/self" ] || mount --bind /proc "$folder/proc"
    [ -e "$folder/dev/urandom" ] || mount --rbind /dev "$folder/dev"
    [ -e "$folder$root/plugin" ] || mount --bind "$root" "$folder$root"
}

installed=
if [ "${1:-}" = --installed ]; then
    shift
    installed=yes
fi
screen=()
if [ "${1:-}" = --screen ]; then
    shift
    screen=(xvfb-run -a -s "-screen 0 1280x720x24")
    export LP_NUM_THREADS=${LP_NUM_THREADS:-2}
fi
command=
if [ "${1:-}" = --run ]; then
    command=$2
    shift 2
fi
if [ -n "${WADI_GODOT:-}" ]; then
    new_enough "$WADI_GODOT" || no_godot "WADI_GODOT=\"$WADI_GODOT\" does not start or is older"
    exec "${screen[@]}" ${command:-$WADI_GODOT} "$@"
fi
if new_enough godot; then exec "${screen[@]}" "${command:-godot}" "$@"; fi
[ -e "$folder/.ready" ] || [ -z "$installed" ] || no_godot "\"godot\" is not installed, and there is no $folder"
[ -e "$folder/.ready" ] || make_folder
mount_folder || no_godot "$folder cannot be mounted"
[ ${#screen[@]} -eq 0 ] || export VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json
exec chroot "$folder" sh -c 'cd "$1" && shift && exec "$@"' sh "$PWD" "${screen[@]}" "${command:-godot}" "$@"
