#!/usr/bin/env bash
# Builds the site and checks it. Usage: build.sh [--out FOLDER] [--library libwadi.so] [--godot COMMAND] [--update]
# The site goes to build/site. Programs on pages are linked with the library: that of build/release, ci or demo unless one is named. Code
# for Godot is compiled by COMMAND (godot). --update writes anew what a page shows of a program's output. Exit status 77 where a tool is
# missing.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$root/plugin/docs
out=$root/build/site library= more=()
while [[ $# -gt 0 ]]; do
    case $1 in
    --out) out=$(realpath -m "$2") && shift 2 ;;
    --library) library=$2 && shift 2 ;;
    --godot) more+=("--godot=$2") && shift 2 ;;
    --update) more+=(--update) && shift ;;
    *) echo "build.sh: no option \"$1\"; there are --out, --library, --godot and --update" >&2 && exit 2 ;;
    esac
done
for tool in mkdocs doxygen node; do
    if ! command -v "$tool" >/dev/null; then
        echo "build.sh: $tool is not installed; samples/install_packages.sh docs installs all that the site needs" >&2
        exit 77
    fi
done
for file in /usr/share/mkdocs/themes/material /usr/share/javascript/katex/katex.js; do
    if [[ ! -e $file ]]; then
        echo "build.sh: $file is not there; samples/install_packages.sh docs installs it" >&2
        exit 77
    fi
done
if [[ -z $library ]]; then
    for preset in release ci demo; do
        [[ -z $library && -e $root/build/$preset/lib/libwadi.so ]] && library=$root/build/$preset/lib/libwadi.so
    done
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Whatever doxygen has to say is an error.
{
    cat "$here/site/Doxyfile"
    echo "OUTPUT_DIRECTORY = $work"
    echo "INPUT = $root/plugin/include/wadi"
    echo "INPUT_FILTER = \"python3 $here/site/header_filter.py\""
    echo "GENERATE_TAGFILE = $work/tags.xml"
    echo "HTML_EXTRA_STYLESHEET = $here/site/assets/api.css"
    echo "LAYOUT_FILE = $here/site/DoxygenLayout.xml"
    echo "WARN_LOGFILE = $work/doxygen.log"
} >"$work/Doxyfile"
doxygen "$work/Doxyfile"
if [[ -s $work/doxygen.log ]]; then
    cat "$work/doxygen.log"
    echo "build.sh: doxygen warns; see above" >&2
    exit 1
fi
if ! WADI_SITE_WORK=$work mkdocs build --config-file "$here/site/mkdocs.yml" --site-dir "$work/site" >"$work/mkdocs.log" 2>&1; then
    grep -v -e "INFO  " -e "^  - " "$work/mkdocs.log" >&2
    exit 1
fi
rm -rf "$out"
mkdir -p "$(dirname "$out")"
mv "$work/site" "$out"

status=0
"$here/figures/draw.py" --check || status=1
"$here/site/check_site.py" "$out" index.html api/wadi_8h.html plugin/docs/hello.html engine/NUMERICS.html || status=1
"$here/site/check_code.py" ${library:+"$library"} "${more[@]}" || status=1
[[ $status -ne 0 ]] || echo "the site is in $out: open index.html"
exit $status
