#!/usr/bin/env python3
"""Which sources the numbers of a page were measured with. The scripts that write pages end them with a stamp: the commit, and a digest of
each part of the sources that decides the numbers. tests/lab/report/tests/page_stamps.py compares it with the sources as they are.

usage: tests/lab/report/stamps.py --update PAGE ...                 its numbers, kept by hand, were measured anew
       tests/lab/report/stamps.py --keep PAGE ... --reason TEXT     what changed does not move its numbers: a row of kept_pages.md
"""
import argparse
import hashlib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
KEPT = "tests/lab/report/kept_pages.md"
STAMP = re.compile(r"<!-- measured at (\S+): (.*) -->")
INCLUDE = re.compile(r'^#include "(\S+\.glsl)"', re.M)
ROW = re.compile(r"\| `([^`]+)` \| `([0-9a-f]+)` \| (.+) \|")

PARTS = {  # what decides the state after a step, whatever runs it
    "stages": tuple(f"shaders/stages/{room}/*.stage" for room in ("boundary", "layer", "published", "sand", "water")) + ("shaders/step_params.h",),
    "step": ("engine/step/plan/step_plan.cpp", "engine/step/plan/world_params.cpp", "engine/step/run/step_inputs.cpp", "engine/step/run/initial_fields.cpp",
             "engine/step/run/prestress.cpp", "engine/step/plan/source_shapes.cpp"),
    "defaults": ("engine/settings/data/settings.hpp", "engine/settings/data/method_presets.cpp"),
    "levels": ("samples/levels/*/level.json",),
}
SAND_LAB = tuple(f"tests/lab/sand/{name}.py" for name in ("columns", "cuts", "scene", "shapes"))
KINDS = {  # a kind of page: the parts, and the scripts and files besides
    "effects": (("stages", "step", "defaults", "levels"), ("tests/lab/report/effects.py", "tests/lab/report/pairs.py")),
    "frontier": (("stages", "step", "defaults"), ("tests/lab/report/frontier.py", "tests/lab/report/frontier_cases.py", "tests/lab/sand/columns.py", "tests/lab/sand/scene.py")),
    "methods": (("stages", "step", "defaults", "levels"), ("tests/lab/report/side_by_side.py", "tests/lab/report/cases.py", "tests/lab/report/exact.py",
                                                           "samples/levels/*/expected.json")),
    "mpm": (("stages", "step", "defaults"), ("tests/lab/report/mpm.py", "tests/lab/report/mpm_solver.py", *SAND_LAB)),
    "prices": (("stages", "step", "defaults"), ("tests/lab/report/prices.py", "tests/lab/report/sand_scenes.py")),
    "timings": (("stages", "step", "defaults", "levels"), ("tests/lab/report/timings.py",)),
    "advice": ((), tuple(f"tests/lab/report/{page}/*.csv" for page in ("frontier", "prices_cpu", "prices_h100", "timings"))),
    "sand": (("stages", "step", "defaults", "levels"), ("tests/lab/sand/*.py",)),
    "matrix": (("stages", "step", "defaults", "levels"), ("tests/lab/sand/matrix/*.py", "tests/lab/sand/piles.py", *SAND_LAB)),
}
PAGES = {
    "tests/lab/report/README.md": "advice",
    "tests/lab/report/effects/README.md": "effects",
    "tests/lab/report/frontier/README.md": "frontier",
    "tests/lab/report/methods/README.md": "methods",
    "tests/lab/report/mpm/README.md": "mpm",
    "tests/lab/report/prices_cpu/README.md": "prices",
    "tests/lab/report/prices_h100/README.md": "prices",
    "tests/lab/report/timings/README.md": "timings",
    "tests/lab/report/timings/two_cores/README.md": "timings",
    "tests/lab/sand/README.md": "sand",
    "tests/lab/sand/matrix/README.md": "matrix",
}


def bare(path):
    """A source's text without comments of whole lines (Python) or of any kind (the rest), and without what only lays it out."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py" or text.startswith("#!"):
        return "\n".join(line.rstrip() for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#"))
    return " ".join(re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S).split())


def with_included(paths):
    """The paths and what stages among them include."""
    found, waiting = set(), list(paths)
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            names = INCLUDE.findall(path.read_text(encoding="utf-8")) if path.suffix in (".stage", ".glsl") else []
            waiting += [(path.parent / name).resolve() for name in names]
    return found


def digest(root, patterns):
    total = hashlib.sha256()
    for path in sorted(with_included(path.resolve() for pattern in patterns for path in root.glob(pattern))):
        total.update(bare(path).encode() + b"\0")
    return total.hexdigest()[:8]


def digests(kind, root=ROOT):
    """{part: digest}; "script": what the page has besides."""
    parts, own = KINDS[kind]
    return {**{part: digest(root, PARTS[part]) for part in parts}, "script": digest(root, own)}


def state(kind, root=ROOT):
    """All of them as one word."""
    return hashlib.sha256(repr(sorted(digests(kind, root).items())).encode()).hexdigest()[:8]


def stamp(kind, root=ROOT):
    """The line for a page whose numbers the sources as they are have just made."""
    head = subprocess.run(["git", "-C", str(root), "describe", "--always", "--dirty=+", "--exclude=*"], capture_output=True, text=True, check=False)
    parts = ", ".join(f"{part} {value}" for part, value in digests(kind, root).items())
    return f"<!-- measured at {head.stdout.strip() or 'unknown'}: {parts} -->"


def stamped(text):
    """(commit, {part: digest}) of a page, None without a stamp or with several."""
    found = STAMP.findall(text)
    return (found[0][0], dict(part.split() for part in found[0][1].split(", "))) if len(found) == 1 else None


def kept_rows(root=ROOT):
    """[(page, state at which it was judged, reason)]"""
    file = root / KEPT
    return ROW.findall(file.read_text(encoding="utf-8")) if file.exists() else []


def update(page):
    file = ROOT / page
    text, found = STAMP.subn(stamp(PAGES[page]), file.read_text(encoding="utf-8"))
    file.write_text(text if found else f"{text.rstrip()}\n\n{stamp(PAGES[page])}\n", encoding="utf-8")


def keep(pages, reason):
    file = ROOT / KEPT
    others = [line for line in file.read_text(encoding="utf-8").rstrip().splitlines() if not any(line.startswith(f"| `{page}` |") for page in pages)]
    file.write_text("\n".join([*others, *(f"| `{page}` | `{state(PAGES[page])}` | {reason} |" for page in pages), ""]), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--update", nargs="+", default=[], choices=PAGES, metavar="PAGE")
    parser.add_argument("--keep", nargs="+", default=[], choices=PAGES, metavar="PAGE")
    parser.add_argument("--reason")
    options = parser.parse_args()
    if bool(options.keep) != bool(options.reason):
        parser.error("--keep and --reason go together")
    for page in options.update:
        update(page)
    if options.keep:
        keep(options.keep, options.reason)
    return 0


if __name__ == "__main__":
    sys.exit(main())
