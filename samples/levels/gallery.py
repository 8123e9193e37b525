#!/usr/bin/env python3
"""Makes the gallery: a picture of every level and variant by wadi-viewer, picture.jpg and picture_VARIANT.jpg beside the level,
and the list of them in samples/levels/README.md. Moment and camera are those of the level's picture.json.

usage: samples/levels/gallery.py VIEWER [LEVEL ...] [--backend auto] [--quality high] [--size 960x540] [--accuracy balanced] [--coarse 1] [--moments 1] [--out DIR]
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

LEVELS = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- gallery.py writes from here -->\n", "<!-- to here -->\n"
KEYS = {"time", "camera", "variants"}


def read_level(folder):
    """JSON without its // and /* */ comments, which no string of a level contains."""
    text = (folder / "level.json").read_text()
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or "", text, flags=re.S))


def merged(level, patch):
    """JSON Merge Patch (RFC 7396)."""
    result = dict(level)
    for key, value in patch.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict):
            result[key] = merged(result.get(key, {}) if isinstance(result.get(key), dict) else {}, value)
        else:
            result[key] = value
    return result


def read_picture(folder, variant):
    """Time [s] and camera: of the level's picture.json, or what its entry for the variant says instead."""
    file = folder / "picture.json"
    entry = json.loads(file.read_text()) if file.exists() else {}
    chosen = {**entry, **entry.get("variants", {}).get(variant, {})}
    unknown = (set(entry) | set(chosen)) - KEYS
    if unknown:
        sys.exit(f"{file}: unknown keys {sorted(unknown)}; known: {sorted(KEYS)}")
    camera = chosen.get("camera")
    return chosen.get("time"), "overview" if camera is None else ",".join(map(str, camera))


def shots(folder):
    """(variant or None, level as JSON, picture) of a level."""
    level = read_level(folder)
    yield None, level, folder / "picture.jpg"
    for variant, patch in sorted(level.get("variants", {}).items()):
        if patch:  # {} is the level itself
            yield variant, merged(level, patch), folder / f"picture_{variant}.jpg"


def take(options, folder, variant, level, picture):
    time, camera = read_picture(folder, variant)
    grid, duration = level["grid"], level.get("duration", 10)
    if options.moments > 1:
        time = duration / options.moments
    elif time is None:
        time = duration / 2
    # "--camera=": a value that begins with a minus sign is no option of its own
    command = [options.viewer, str(folder), "--offscreen", "--jpeg", "--start", time, f"--camera={camera}",
               "--frames", options.moments, "--every", duration / options.moments, "--backend", options.backend, "--quality", options.quality, "--size", options.size]
    if options.accuracy != "balanced":
        command += ["--accuracy", options.accuracy]
    if options.coarse > 1:
        command += ["--grid", f"{max(grid['nx'] // options.coarse, 1)}x{max(grid['ny'] // options.coarse, 1)}"]
    if variant is not None:
        command += ["--variant", variant]
    with tempfile.TemporaryDirectory() as scratch:
        done = subprocess.run([*map(str, command), "--out", scratch], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: {done.stderr.splitlines()[-1]}")
        picture.parent.mkdir(parents=True, exist_ok=True)
        for n in range(options.moments):
            to = picture if options.moments == 1 else picture.with_stem(f"{picture.stem}_{n + 1}")
            to.write_bytes((pathlib.Path(scratch) / f"frame_{n:05}.jpg").read_bytes())


def gallery(folders):
    lines = []
    for folder in folders:
        for variant, level, picture in shots(folder):
            title = folder.name if variant is None else f"{folder.name}, `--variant {variant}`"
            lines += [f"**{title}**: {level.get('description', '')}\n", f"![{title}]({folder.name}/{picture.name})\n"]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewer")
    parser.add_argument("levels", nargs="*", help="default: all")
    parser.add_argument("--backend", default="auto", help="of the simulation")
    parser.add_argument("--quality", default="high", help="low, medium, high")
    parser.add_argument("--size", default="960x540")
    parser.add_argument("--accuracy", default="balanced", help="draft, balanced, accurate: half, all or twice the cells along each axis")
    parser.add_argument("--coarse", type=int, default=1, help="cells N times as wide: to try cameras on slow machines")
    parser.add_argument("--moments", type=int, default=1, help="N pictures over the level's length, without its variants; wants --out")
    parser.add_argument("--out", type=pathlib.Path, help="pictures go into this folder, and the README stays as it is")
    options = parser.parse_args()
    if min(options.coarse, options.moments) < 1 or (options.moments > 1 and options.out is None):
        parser.error("--coarse and --moments: allowed are 1 or more; --moments wants --out")
    folders = sorted(path.parent for path in LEVELS.glob("*/level.json"))
    unknown = set(options.levels) - {folder.name for folder in folders}
    if unknown:
        parser.error(f"no level {', '.join(sorted(unknown))}")
    for folder in folders:
        if options.levels and folder.name not in options.levels:
            continue
        for variant, level, picture in shots(folder):
            if variant is not None and options.moments > 1:
                continue
            print(folder.name, variant or "", flush=True)
            take(options, folder, variant, level, options.out / f"{folder.name}_{picture.name}" if options.out else picture)
    if options.out:
        return
    readme = LEVELS / "README.md"
    text = readme.read_text()
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    readme.write_text(text[:start] + gallery(folders) + text[end:])


if __name__ == "__main__":
    main()
