"""Columns of dry sand that collapse, against own computations with the material point method (data/README.md) and laws fitted to
experiments: Lube, Huppert, Sparks and Hallworth 2004 (axisymmetric) and Lube, Huppert, Sparks and Freundt 2005 (planar)."""
import math
import pathlib

import numpy as np

import shapes
from cases import case
from scene import grid, level
from table import at_most, near, shown

DATA = pathlib.Path(__file__).parent / "data"
STRIP = 0.1  # width of the rings and strips of the references' profiles [m]
FOOT = 0.02  # depth at which sand ends [m]
ASPECTS = (0.5, 1, 2)
HALF = 2.0  # radius or half-width of a column [m]
SLOPE_SHARE = 0.2  # within which a pile's flank is as steep as the reference's
TIMES = (0.4, 0.8, 1.2, 1.6, 2, 2.4, 2.8, 3.2, 3.6, 4)  # of the references
AXIS_BOX, PLANAR_BOX, ROWS = 16, 32, 4  # metres, metres, cells: no wall is met


def profile(name, count):
    """Depths of a reference, 0 beyond its end."""
    depth = np.loadtxt(DATA / f"{name}.txt", skiprows=1)[:, 1]
    return np.pad(depth, (0, max(0, count - len(depth))))[:count]


def history(name):
    """Time: (centre, toe) of a reference."""
    rows = [line.split() for line in (DATA / f"{name}_times.txt").read_text().splitlines() if line]
    return {float(row[2]): (float(row[4]), float(row[6])) for row in rows}


def rings(cells, hs, samples=8):
    """Depth in rings of STRIP about the middle, cells shared out between them by area."""
    x, y = shapes.centres(cells)
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * cells["dx"]
    count = int(np.hypot(x.max() + cells["dx"], y.max() + cells["dx"]) / STRIP) + 1
    volumes, areas = np.zeros(count), np.zeros(count)
    for oy in offsets:
        for ox in offsets:
            ring = (np.hypot(x + ox, y + oy) / STRIP).astype(int).ravel()
            volumes += np.bincount(ring, hs.ravel(), count)
            areas += np.bincount(ring, minlength=count)
    return volumes / np.maximum(areas, 1)


def strips(cells, hs):
    """Depth in strips of STRIP from the west wall."""
    fine = 80  # samples to a strip, a multiple of what a cell of 0.1, 0.05 or 0.025 m has
    x = (np.arange(round(cells["nx"] * cells["dx"] / STRIP) * fine) + 0.5) * STRIP / fine
    column = np.minimum((x / cells["dx"]).astype(int), cells["nx"] - 1)
    return hs.mean(0)[column].reshape(-1, fine).mean(1)


def toe(depth):
    """Outer edge of the outermost strip that is deeper than FOOT."""
    deep = np.nonzero(depth > FOOT)[0]
    return (deep[-1] + 1) * STRIP if len(deep) else 0.0


def elsewhere(depth, reference, weights):
    """Share of the sand that lies elsewhere than in the reference [%]."""
    here, there = depth * weights, reference * weights
    return 50 * np.abs(here / here.sum() - there / there.sum()).sum()


def mean_slope(depth):
    """Of the flank from 75 to 25 % of the pile's height."""
    top = depth[:3].mean()
    inner, outer = (STRIP * (np.nonzero(depth > share * top)[0][-1] + 0.5) for share in (0.75, 0.25))
    return 0.5 * top / (outer - inner)


def end_of(line, spacing):
    """Distance at which depths at 1/2, 3/2 ... spacings pass FOOT, between cells."""
    last = np.nonzero(line > FOOT)[0][-1]
    beyond = line[last + 1] if last + 1 < len(line) else 0.0
    return (last + 0.5 + (line[last] - FOOT) / (line[last] - beyond)) * spacing


def fronts(cells, hs):
    """Where the sand ends along the axes and along the diagonals, from the middle, each the mean of four."""
    half, dx = cells["nx"] // 2, cells["dx"]
    quarters = (hs[half:, half:], hs[half:, :half][:, ::-1], hs[:half, half:][::-1], hs[:half, :half][::-1, ::-1])
    axis = [end_of((quarter[0] + quarter[:, 0]) / 2, dx) for quarter in quarters]
    diagonal = [end_of(np.diag(quarter), math.sqrt(2) * dx) for quarter in quarters]
    return float(np.mean(axis)), float(np.mean(diagonal))


def sides(cells, hs):
    """The same of a planar pile: its two sides."""
    half = cells["nx"] // 2
    return [end_of(line, cells["dx"]) for line in (hs.mean(0)[half:], hs.mean(0)[:half][::-1])]


def front_history(run, reference, reach):
    """Largest deviation of the front's place from the reference's, in the time that this takes to come to rest [%]."""
    past = history(reference)
    return max(100 * abs(reach(run.field("hs", time)) / past[time][1] - 1) for time in TIMES if time in past)


# What columns keep to where they miss limits: the front of the tallest starts early, and along an axis it ends shorter than along a diagonal.
FRONT_HELD = {2: 20}
TURNED_HELD = {2: 5.5}
TOE_HELD = {"axi_triaxial_a2": 0.13}


def collapsed(run, cells, a, name, depth_of, distance, weights):
    """The rows that all columns share; `distance` of the cells from the middle."""
    hs = run.field("hs", TIMES[-1])
    depth = depth_of(hs)
    centre, end = history(name)[TIMES[-1]]
    return [
        near("toe", toe(depth), end, 0.1, "MPM", held=TOE_HELD.get(name)),
        near("centre", hs[distance < 0.5].mean(), centre, 0.1, "MPM"),
        at_most("elsewhere", elsewhere(depth, profile(name, len(depth)), weights), 6, "%", "than in MPM"),
        at_most("front until then", front_history(run, name, lambda field: toe(depth_of(field))), 15, "%", "MPM at 0.4, 0.8 ... s",
                FRONT_HELD.get(a)),
        near("mean slope", mean_slope(depth), mean_slope(profile(name, len(depth))), SLOPE_SHARE, "MPM", ""),
    ]


def axisymmetric(lab, dx, a, material):
    cells = grid(AXIS_BOX, AXIS_BOX, dx)
    column = shapes.draw(cells, shapes.disc(HALF, HALF * a))
    return cells, lab.run(level(cells, sand=[{"file": column}], material=material), TIMES)


def planar(lab, dx, a, material):
    cells = {"nx": round(PLANAR_BOX / dx), "ny": ROWS, "dx": dx}
    column = shapes.draw(cells, shapes.block(2 * HALF, 2 * ROWS * dx, HALF * a))
    return cells, lab.run(level(cells, sand=[{"file": column}], material=material), TIMES)


def halves(cells, hs):
    """Depth in strips from the middle, both sides together."""
    depth = strips(cells, hs)
    middle = len(depth) // 2
    return (depth[middle:] + depth[:middle][::-1]) / 2


def against_mpm(a, suffix, material, quick):
    @case(f"column_axi_{a:g}{suffix}", quick=quick)
    def measure_axisymmetric(lab, dx):
        cells, run = axisymmetric(lab, dx, a, material)
        x, y = shapes.centres(cells)
        count = len(rings(cells, x * 0))
        rows = collapsed(run, cells, a, f"axi_triaxial_a{a:g}", lambda hs: rings(cells, hs), np.hypot(x, y), 2 * np.arange(count) + 1)
        axis, diagonal = fronts(cells, run.field("hs", TIMES[-1]))
        return [*rows, at_most("axis from diagonal", 100 * abs(axis / diagonal - 1), 3, "%", f"toes {axis:.3f} and {diagonal:.3f} m", held=TURNED_HELD.get(a))]

    @case(f"column_planar_{a:g}{suffix}", quick=quick)
    def measure_planar(lab, dx):
        cells, run = planar(lab, dx, a, material)
        return collapsed(run, cells, a, f"planar_triaxial_a{a:g}", lambda hs: halves(cells, hs), np.abs(shapes.centres(cells)[0]), 1)


def against_lube(name, measure, law, source, ends, quick, held):
    @case(name, quick=quick)
    def rows(lab, dx):
        found = []
        for a in ASPECTS:
            cells, run = measure(lab, dx, a, {"friction": 0.6})
            found.append(near(f"toe, a = {a:g}", np.mean(ends(cells, run.field("hs", TIMES[-1]))), law(a), 0.12, source,
                              held=held.get(a)))
        return found


def on_slope(a):
    @case(f"column_slope_{a:g}", quick=(0.1, 0.05))
    def measure(lab, dx):
        cells = {"nx": round(PLANAR_BOX / dx), "ny": ROWS, "dx": dx}
        middle, name = 6.0, f"slope03_a{a:g}"
        x = shapes.centres(cells)[0] + PLANAR_BOX / 2
        column = shapes.draw(cells, lambda x, y: np.where(np.abs(x + PLANAR_BOX / 2 - middle) < HALF, HALF * a, 0.0))
        run = lab.run(level(cells, terrain=[{"file": shapes.incline(cells, 0.3)}], sand=[{"file": column}]), [*TIMES, 5])
        depth = strips(cells, run.field("hs", 5))
        reference = profile(name, len(depth))
        return [
            near("run-out from the middle", toe(depth) - middle, history(name)[5][1] - middle, 0.12, "MPM"),
            shown("upper edge", np.nonzero(depth > FOOT)[0][0] * STRIP - middle, "m", f"MPM {np.nonzero(reference > FOOT)[0][0] * STRIP - middle:.2f}"),
            shown("elsewhere", elsewhere(depth, reference, 1), "%"),
            at_most("front until then", front_history(run, name, lambda hs: toe(strips(cells, hs))), 15, "%", "MPM at 0.4, 0.8 ... s"),
        ]


@case("reservoir", quick=(0.1, 0.05))
def reservoir(lab, dx):
    cells = {"nx": round(PLANAR_BOX / 2 / dx), "ny": ROWS, "dx": dx}
    gate = 6.0
    sand = shapes.draw(cells, lambda x, y: np.where(x + PLANAR_BOX / 4 < gate, 1.0, 0.0))
    run = lab.run(level(cells, sand=[{"file": sand}]), TIMES)
    depth = strips(cells, run.field("hs", TIMES[-1]))
    return [
        near("run-out from the gate", toe(depth) - gate, history("reservoir")[TIMES[-1]][1] - gate, 0.12, "MPM"),
        shown("elsewhere", elsewhere(depth, profile("reservoir", len(depth)), 1), "%"),
        at_most("front until then", front_history(run, "reservoir", lambda hs: toe(strips(cells, hs))), 15, "%", "MPM at 0.4, 0.8 ... s"),
    ]


for aspect in ASPECTS:
    against_mpm(aspect, "", {}, (0.1,))
    against_mpm(aspect, "_friction_only", {"young_modulus": 0}, ())
against_lube("lube_axi", axisymmetric, lambda a: HALF * (1 + (1.24 * a if a < 1.7 else 1.6 * math.sqrt(a))), "Lube et al. 2004", fronts,
             (0.1,), {2: 0.14})
against_lube("lube_planar", planar, lambda a: HALF * (1 + 1.2 * a), "Lube et al. 2005", sides, (0.1, 0.05), {})
for aspect in (0.5, 1):
    on_slope(aspect)
