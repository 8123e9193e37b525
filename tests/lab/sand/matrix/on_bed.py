"""A column that falls on a bed of the same sand, against the material point method on the same bed (mpm_on_bed.py)."""
import pathlib

import numpy as np

import columns
import shapes
from cases import Case
from resting import WALL
from scene import grid, level
from table import at_most, near

HALF, HIGH, BED, SECONDS = 0.8, 1.6, 1.0, 4  # [m], [s]
SHARE = 0.1  # of the column
FOOT = 0.05  # over the bed, where the heap ends [m]


def reference(kind):
    return np.loadtxt(pathlib.Path(__file__).parent / f"{kind}_on_bed.txt")[:, 1]


def end(heap):
    """Where the heap falls below FOOT, between strips."""
    last = np.nonzero(heap > FOOT)[0][-1]
    return (last + 0.5 + (heap[last] - FOOT) / (heap[last] - heap[last + 1])) * columns.STRIP


def profile(lab, kind, dx, seconds=SECONDS):
    """Depths in strips or rings from the middle."""
    if kind == "round":
        cells = grid(6.4, 6.4, dx)
        sand, depths = shapes.draw(cells, shapes.disc(HALF, HIGH)), columns.rings
    else:
        cells = {"nx": round(12.8 / dx), "ny": 4, "dx": dx}
        sand, depths = shapes.draw(cells, shapes.block(2 * HALF, 8 * dx, HIGH)), columns.halves
    run = lab.run(level(cells, sand=[{"file": BED + sand}]), [seconds])
    return depths(cells, run.field("hs", seconds))


def column(kind):
    def measure(lab, dx):
        truth = reference(kind)
        heap, true_heap = profile(lab, kind, dx)[: len(truth)] - BED, truth - BED
        area = 2 * np.arange(len(truth)) + 1 if kind == "round" else np.ones(len(truth))
        whole = HIGH * (HALF / columns.STRIP) ** (2 if kind == "round" else 1)
        return [
            at_most("sand elsewhere / the column", (np.abs(heap - true_heap) * area).sum() / 2 / whole, SHARE, "", "MPM"),
            near("middle over the bed", heap[:3].mean(), true_heap[:3].mean(), SHARE, "MPM"),
            near("foot", end(heap), end(true_heap), SHARE, "MPM"),
        ]
    return measure


CASES = [Case(f"on_bed/{kind}", column(kind), (0.2, 0.1, 0.05), WALL, (0.1,) if kind == "planar" else ()) for kind in ("planar", "round")]
