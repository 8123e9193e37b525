"""A terrace of dry sand before a drop, against own computations with the material point method (data/README.md): two rows, the cone of
friction matched to triaxial compression and to plane strain."""
import numpy as np

import shapes
from cases import case
from scene import level
from table import Row, at_most, exactly, shown

LENGTH, DEPTH, DROP, BEYOND, ROWS = 5.0, 1.0, 3.0, 6.0, 4
# Seconds: sand that has fallen [m2], the smaller and the larger of both rows.
FALLEN = {0.4: (0.166, 0.197), 1: (0.382, 0.454), 2: (0.547, 0.684), 3.8: (0.638, 0.846)}
EVERY = 0.1
CONTROL = {"material.slope_normal": 0}


def fall(lab, dx):
    """Time: sand beyond the brink per metre of it [m2]."""
    cells = {"nx": round((LENGTH + BEYOND) / dx), "ny": ROWS, "dx": dx}
    x = shapes.centres(cells)[0] + (LENGTH + BEYOND) / 2
    upon = x < LENGTH
    times = [round(EVERY * n, 3) for n in range(1, 39)]
    run = lab.run(level(cells, terrain=[{"file": np.where(upon, DROP, 0.0)}], sand=[{"file": np.where(upon, DEPTH, 0.0)}]), times)
    return {time: float((run.field("hs", time) * ~upon).sum()) * dx / ROWS for time in times}


def half_time(fallen, amount=0.5):
    times = np.array([0, *fallen])
    return float(np.interp(amount, [0, *fallen.values()], times))


@case("terrace", dx=(0.1, 0.05, 0.025), control=CONTROL, quick=(0.1,))
def terrace(lab, dx):
    found = fall(lab, dx)
    rows = [Row(f"fallen after {time:g} s", found[time], 0.9 * low, 1.1 * high, "m2", f"MPM {low:g} to {high:g}, 10 %")
            for time, (low, high) in FALLEN.items()]
    return [*rows, shown("half of 1 m2 after", half_time(found), "s", "MPM 1.15 to 1.6")]


@case("terrace_refined", dx=(0.025,), control=CONTROL)
def refined(lab, dx):
    """Half times on these cells and on those twice as large."""
    coarse, fine = (half_time(fall(lab, cell)) for cell in (2 * dx, dx))
    return [at_most("half times differ by", 100 * abs(fine / coarse - 1), 7, "%", f"{coarse:.3f} and {fine:.3f} s")]


@case("plateau", dx=(0.1,), control={"material.friction": 0.47}, quick=(0.1,))
def plateau(lab, dx):
    """A cone below its friction on a square plateau keeps every bit, brinks or not."""
    cells = {"nx": round(9.6 / dx), "ny": round(9.6 / dx), "dx": dx}
    x, y = shapes.centres(cells)
    upon = np.maximum(np.abs(x), np.abs(y)) < 2.6
    scene = level(cells, terrain=[{"file": np.where(upon, 2.0, 0.0)}], sand=[{"file": shapes.draw(cells, shapes.cone(0.495, 1.188))}])
    run = lab.run(scene, [0, 3], ("hs", "us", "vs"))
    return [exactly("largest change of height", np.abs(run.field("hs", 3) - run.field("hs", 0)).max(), 0, "m"),
            exactly("fastest sand", max(np.abs(run.field(name, 3)).max() for name in ("us", "vs")), 0, "m/s")]
