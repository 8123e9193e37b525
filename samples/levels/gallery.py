#!/usr/bin/env python3
"""Makes the gallery: of every level three moments side by side (picture.jpg), where it has variants the level and each of them at one
moment (variants.jpg), and where its picture.json asks for one a clip (clip.webp); and the list of them in samples/levels/README.md.

usage: samples/levels/gallery.py VIEWER [LEVEL ...] [--backend auto] [--quality high] [--size 960x540] [--accuracy fine] [--coarse 1] [--panels DIR] [--only moments|panels]
VIEWER (wadi-viewer) draws, ffmpeg puts the panels together. --panels keeps them; what lies there already is not drawn again, so that one
machine may draw and another finish.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LEVELS = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- gallery.py writes from here -->\n", "<!-- to here -->\n"
KEYS = {"time", "camera", "compare", "clip", "variants"}
CLIP_FRAMES, CLIP_RATE = 100, 12.5  # 8 s


def read_level(folder):
    """JSON without its // and /* */ comments, which no string of a level contains."""
    text = (folder / "level.json").read_text()
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or "", text, flags=re.S))


def variants(level):
    return [name for name, patch in sorted(level.get("variants", {}).items()) if patch]  # {} is the level itself


def read_picture(folder, duration, variant=None):
    """Time [s], camera, clip, and when it is compared with its variants: of its picture.json, or what the variant's entry there says."""
    file = folder / "picture.json"
    entry = json.loads(file.read_text()) if file.exists() else {}
    chosen = {**entry, **entry.get("variants", {}).get(variant, {})}
    unknown = (set(entry) | set(chosen)) - KEYS
    if unknown:
        sys.exit(f"{file}: unknown keys {sorted(unknown)}; known: {sorted(KEYS)}")
    camera = chosen.get("camera")
    time = chosen.get("time", duration / 2)
    return time, "overview" if camera is None else ",".join(map(str, camera)), entry.get("clip"), chosen.get("compare", time)


def run(command):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {(done.stderr.splitlines() or ['failed'])[-1]}")


def draw(options, folder, panels, name, camera, start, frames, every, variant=None):
    """The pictures NAME_0, NAME_1, ... of a run, in `panels`."""
    names = [panels / f"{folder.name}_{name}_{n}.jpg" for n in range(frames)]
    if all(file.exists() for file in names):
        return names
    # "--camera=": a value that begins with a minus sign is no option of its own
    command = [options.viewer, folder, "--offscreen", "--jpeg", "--start", start, f"--camera={camera}", "--frames", frames, "--every", every,
               "--backend", options.backend, "--quality", options.quality, "--size", options.size]
    if options.coarse > 1:
        grid = read_level(folder)["grid"]
        command += ["--grid", f"{max(grid['nx'] // options.coarse, 1)}x{max(grid['ny'] // options.coarse, 1)}"]
    else:
        command += ["--accuracy", options.accuracy]
    if variant is not None:
        command += ["--variant", variant]
    with tempfile.TemporaryDirectory() as scratch:
        run([*command, "--out", scratch])
        for n, file in enumerate(names):
            shutil.move(pathlib.Path(scratch) / f"frame_{n:05}.jpg", file)
    return names


def together(files, labels, columns, width, to):
    """Panels in rows, each `width` pixels wide and with its label below on the left."""
    parts, places = [], []
    for n, label in enumerate(labels):
        parts.append(f"[{n}]scale={width}:-2,drawtext=text='{label}':x=12:y=h-th-12:fontsize={width // 28}:fontcolor=white:shadowx=1:shadowy=1[p{n}]")
        column, row = n % columns, n // columns
        places.append("+".join(["w0"] * column or ["0"]) + "_" + "+".join(["h0"] * row or ["0"]))
    stacked = "".join(f"[p{n}]" for n in range(len(files)))
    stack = f"{stacked}xstack=inputs={len(files)}:layout={'|'.join(places)}:fill=white" if len(files) > 1 else "[p0]null"
    inputs = [word for file in files for word in ("-i", file)]
    run(["ffmpeg", "-loglevel", "error", "-y", *inputs, "-filter_complex", ";".join([*parts, stack]), "-frames:v", 1, "-q:v", 4, to])


def clip_of(files, to):
    """An animated picture of less than a megabyte."""
    with tempfile.TemporaryDirectory() as scratch:
        for n, file in enumerate(files):
            (pathlib.Path(scratch) / f"{n:05}.jpg").symlink_to(file.resolve())
        for quality in range(60, 0, -10):
            run(["ffmpeg", "-loglevel", "error", "-y", "-framerate", CLIP_RATE, "-i", f"{scratch}/%05d.jpg", "-vf", "scale=480:-2", "-c:v", "libwebp_anim",
                 "-quality", quality, "-loop", 0, to])
            if to.stat().st_size < 1_000_000:
                return
    sys.exit(f"{to}: more than a megabyte at any quality")


def shoot(options, folder, panels):
    """All panels of a level: {what: [(file, label), ...]}."""
    level = read_level(folder)
    duration = level.get("duration", 10)
    time, camera, clip, _ = read_picture(folder, duration)
    every = min(time / 2, duration - time)
    print(folder.name, flush=True)
    shots = {"picture.jpg": list(zip(draw(options, folder, panels, "moment", camera, time - every, 3, every), [f"{time + n * every:g} s" for n in (-1, 0, 1)]))}
    if options.only == "moments":
        return shots
    if names := variants(level):
        shots["variants.jpg"] = []
        for variant in [None, *names]:
            _, seen_from, _, at = read_picture(folder, duration, variant)
            title = "as it is" if variant is None else variant
            (file,) = draw(options, folder, panels, f"at_{title.replace(' ', '_')}", seen_from, at, 1, 1, variant)
            shots["variants.jpg"].append((file, f"{title}, {at:g} s"))
    if clip:
        files = draw(options, folder, panels, "clip", camera, clip[0], CLIP_FRAMES, (clip[1] - clip[0]) / CLIP_FRAMES)
        shots["clip.webp"] = [(file, "") for file in files]
    return shots


def finish(folder, shots):
    for name, panels in shots.items():
        files, labels = [file for file, _ in panels], [label for _, label in panels]
        if name == "clip.webp":
            clip_of(files, folder / name)
        else:
            together(files, labels, 3 if name == "picture.jpg" else 2, 560, folder / name)


def gallery(folders):
    lines = []
    for folder in folders:
        level = read_level(folder)
        lines += [f"### {folder.name}\n{level.get('description', '')}\n"]
        if (folder / "clip.webp").exists():
            lines += [f"![{folder.name}, moving]({folder.name}/clip.webp)\n"]
        lines += [f"![{folder.name} at three moments]({folder.name}/picture.jpg)\n"]
        if names := variants(level):
            lines += [f"- `--variant {name}`: {level['variants'][name].get('description', '')}" for name in names]
            lines += ["", f"![{folder.name} and its variants]({folder.name}/variants.jpg)\n"]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("viewer")
    parser.add_argument("levels", nargs="*", help="default: all")
    parser.add_argument("--backend", default="auto", help="of the simulation")
    parser.add_argument("--quality", default="high", help="low, medium, high")
    parser.add_argument("--size", default="960x540", help="of a panel as it is drawn")
    parser.add_argument("--accuracy", default="fine", help="level, draft, balanced, accurate, fine")
    parser.add_argument("--coarse", type=int, default=1, help="cells N times as wide as the level's, for slow machines")
    parser.add_argument("--panels", type=pathlib.Path, help="keeps each panel in this folder, and takes from it what is there")
    parser.add_argument("--only", choices=("moments", "panels"), help="panels of three moments of each level, or all panels, and nothing put together; wants --panels")
    options = parser.parse_intermixed_args()
    if options.coarse < 1 or (options.only and options.panels is None):
        parser.error("--coarse: allowed are 1 or more; --only wants --panels")
    folders = sorted(path.parent for path in LEVELS.glob("*/level.json"))
    unknown = set(options.levels) - {folder.name for folder in folders}
    if unknown:
        parser.error(f"no level {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory() as scratch:
        panels = options.panels or pathlib.Path(scratch)
        panels.mkdir(parents=True, exist_ok=True)
        for folder in folders:
            if options.levels and folder.name not in options.levels:
                continue
            shots = shoot(options, folder, panels)
            if not options.only:
                finish(folder, shots)
    if options.only:
        return
    readme = LEVELS / "README.md"
    text = readme.read_text()
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    readme.write_text(text[:start] + gallery(folders) + text[end:])


if __name__ == "__main__":
    main()
