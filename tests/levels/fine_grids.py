#!/usr/bin/env python3
"""Checks every level's claims on its fine grid (level.json, fine_grid), one run after the other, and tells what a step takes there.

usage: fine_grids.py RECORDER [--backend auto] [--update] [LEVEL ...]
--update writes the table of README.md, which wants all levels and a GPU.
"""
import argparse
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LEVELS = HERE.parents[1] / "samples" / "levels"
BEGIN, END = "<!-- fine_grids.py writes from here -->\n", "<!-- to here -->\n"
RUN = re.compile(r"^run (\S+): (\d+) x (\d+) cells of (\S+) m, (\d+) steps of (\S+) s in \S+ s, (\S+) ms each, hash", re.M)


def check(recorder, level, backend):
    """The row of a level, and whether all of its claims hold."""
    done = subprocess.run([sys.executable, str(HERE / "check_claims.py"), recorder, str(LEVELS / level), "--cells", "fine", "--backend", backend],
                          capture_output=True, text=True)
    print(f"== {level}\n{done.stdout}{done.stderr}", end="", flush=True)
    first = RUN.search(done.stdout)
    if first is None:
        return None, False
    _, nx, ny, dx, _, dt, step = first.groups()
    holds = re.search(r"^(\d+) of (\d+) claims hold", done.stdout, re.M)
    return f"| {level} | {nx} x {ny} | {float(dx) * 100:.3g} | {float(dt) * 1000:.3g} | {step} | {float(dt) * 1000 / float(step):.2g} | {holds[1]} of {holds[2]} |", done.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder")
    parser.add_argument("levels", nargs="*", help="default: all")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--update", action="store_true")
    options = parser.parse_intermixed_args()
    levels = options.levels or sorted(file.parent.name for file in LEVELS.glob("*/expected.json"))
    rows, failed = [], []
    for level in levels:
        row, good = check(options.recorder, level, options.backend)
        rows += [row] if row else []
        failed += [] if good else [level]
    print("\n".join(rows))
    if options.update:
        if options.levels:
            parser.error("--update wants all levels")
        readme = HERE / "README.md"
        text = readme.read_text()
        start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
        head = ["| level | cells | of [cm] | dt [ms] | a step takes [ms] | seconds simulated per second | claims that hold |", "| --- | --- | ---: | ---: | ---: | ---: | --- |"]
        readme.write_text(text[:start] + "\n".join([*head, *rows]) + "\n" + text[end:])
    if failed:
        sys.exit(f"fine_grids: claims do not hold: {', '.join(failed)}")


if __name__ == "__main__":
    main()
