#!/usr/bin/env python3
"""A column of sand that falls on a bed of the same sand, by the material point method of tests/lab/report/mpm_solver.py (a Python with the
packages taichi and numpy): writes the profiles at rest that on_bed.py compares with. Some 15 minutes of one thread.

usage: mpm_on_bed.py [planar] [round]
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "report"), str(HERE.parent)]
import mpm_solver  # noqa: E402

HALF, HIGH, BED, FRICTION, SECONDS, STRIP = 0.8, 1.6, 1.0, 0.5, 4, 0.1  # lengths in metres
KINDS = {"planar": (2, 0.025, 6.4), "round": (3, 0.08, 3.2)}  # dimensions, cell and distance of the walls [m]


def write(kind):
    dimensions, cell, wall = KINDS[kind]
    column = mpm_solver.Column(dimensions, HALF, HIGH, cell, FRICTION, FRICTION, bed=BED, wall=wall)
    column.advance(SECONDS)
    depths = column.depths(STRIP)[: round(wall / STRIP) - 1]  # less the last, which the wall cuts
    lines = [f"# {kind}: half-width or radius {HALF} m, {HIGH} m high, on {BED} m of sand, friction {FRICTION}, after {SECONDS} s; cells of {cell} m",
             "# distance from the middle [m], depth [m]"]
    lines += [f"{(n + 0.5) * STRIP:.2f} {depth:.4f}" for n, depth in enumerate(depths)]
    (HERE / f"{kind}_on_bed.txt").write_text("\n".join([*lines, ""]))


if __name__ == "__main__":
    for kind in sys.argv[1:] or KINDS:
        write(kind)
