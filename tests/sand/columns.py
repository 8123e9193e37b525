"""Columns of dry sand that collapse, against own computations with the material point method (data/README.md) and fitted laws."""
import pathlib

import numpy as np

import shapes
from cases import case
from scene import grid, level
from table import at_most, near

DATA = pathlib.Path(__file__).parent / "data"
RING = 0.1  # of the references' profiles [m]
FOOT = 0.02  # depth at which sand ends [m]


def profile(name):
    """Depths of a reference in rings of 0.1 m."""
    return np.loadtxt(DATA / f"{name}.txt", skiprows=1)[:, 1]


def history(name):
    """Time, centre and toe of a reference."""
    rows = [line.split() for line in (DATA / f"{name}_times.txt").read_text().splitlines() if line]
    return np.array([[float(row[2]), float(row[4]), float(row[6])] for row in rows])


def rings(cells, hs, samples=8):
    """Volume and area of rings of RING about the middle, cells shared out between them by area."""
    x, y = shapes.centres(cells)
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * cells["dx"]
    count = int(np.hypot(x.max() + cells["dx"], y.max() + cells["dx"]) / RING) + 1
    volumes, areas = np.zeros(count), np.zeros(count)
    for oy in offsets:
        for ox in offsets:
            ring = (np.hypot(x + ox, y + oy) / RING).astype(int).ravel()
            volumes += np.bincount(ring, hs.ravel(), count)
            areas += np.bincount(ring, minlength=count)
    return volumes * (cells["dx"] / samples) ** 2, areas * (cells["dx"] / samples) ** 2


def toe(volumes, areas):
    """Outer edge of the outermost ring whose mean depth is above FOOT."""
    deep = np.nonzero(volumes > FOOT * areas)[0]
    return (deep[-1] + 1) * RING if len(deep) else 0.0


def axisymmetric(a):
    @case(f"column_axi_{a:g}", quick=(0.1,))
    def measure(lab, dx):
        cells = grid(16, 16, dx)
        sand = shapes.draw(cells, shapes.disc(2, 2 * a))
        run = lab.run(level(cells, sand=[{"file": sand}]), [4])
        x, y = shapes.centres(cells)
        hs, radius = run.field("hs", 4), np.hypot(x, y)
        volumes, areas = rings(cells, hs)
        reference = profile(f"axi_triaxial_a{a:g}")
        there = np.zeros_like(volumes)
        there[:len(reference)] = reference[:len(there)] * np.pi * (2 * np.arange(len(reference[:len(there)])) + 1) * RING**2
        there *= volumes.sum() / there.sum()
        return [
            near("toe", toe(volumes, areas), history(f"axi_triaxial_a{a:g}")[-1, 2], 0.1, "MPM"),
            near("centre", hs[radius < 0.5].mean(), history(f"axi_triaxial_a{a:g}")[-1, 1], 0.1, "MPM"),
            at_most("elsewhere", 50 * np.abs(volumes - there).sum() / volumes.sum(), 6, "%"),
        ]


for aspect in (0.5, 1, 2):
    axisymmetric(aspect)
