"""What second order (method.sand_transport_order) does for the errors of moving sand, cell by cell: a cap on an incline against its exact
solution, a ridge that falls against a fine grid. By first order, the control, both miss on the same cells."""
import numpy as np

import shapes
from cases import case
from scene import NEUTRAL, level
from table import at_most

ORDER = "method.sand_transport_order"
SECOND = {"method.water_transport_order": 2, ORDER: 2}
ROWS = 4  # cells across
GRAVITY = 9.81


def cell_means(height, count, dx, samples=32):
    """Means over cells of a height along x."""
    x = (np.arange(count * samples) + 0.5) * dx / samples
    return height(x).reshape(count, samples).mean(1)


def elsewhere(row, truth):
    """Share of the sand that lies elsewhere [%]."""
    return 50 * np.abs(row - truth).sum() / truth.sum()


def end_of(row, depth, dx):
    """Where the sand falls below a depth, between cells [m]."""
    last = np.nonzero(row > depth)[0][-1]
    return (last + 0.5 + (row[last] - depth) / (row[last] - row[last + 1])) * dx


def stretched(seconds, height, half, steps=20000):
    """Length over its first of a parabolic cap that spreads: s'' = 2 g h0 / (l s)^2 (Savage and Hutter 1989, earth pressure 1)."""
    step, length, speed = seconds / steps, 1.0, 0.0
    for _ in range(steps):
        speed += step * GRAVITY * height / (half * length) ** 2
        length += step * speed
        speed += step * GRAVITY * height / (half * length) ** 2
    return length


@case("sliding_cap", control={ORDER: 1}, quick=(0.1,))
def sliding_cap(lab, dx):
    """A parabolic cap slides down an incline and spreads, by the laws of level ground without forces within the sand."""
    slope, friction, height, half, start, seconds, size, foot = 0.6, 0.4, 0.15, 2.0, 4.0, 1.5, 12.8, 0.005
    count = round(size / dx)
    centre, stretch = start + GRAVITY * (slope - friction) * seconds**2 / 2, stretched(seconds, height, half)
    cap = lambda middle, s: lambda x: np.maximum(0, height / s * (1 - ((x - middle) / (half * s)) ** 2))
    run = lab.run(level({"nx": count, "ny": ROWS, "dx": dx}, sand=[{"file": np.tile(cell_means(cap(start, 1), count, dx), (ROWS, 1))}],
                        terrain=[{"shape": "plane", "height": size * slope, "slope_x": -slope}],
                        material={"friction": friction, "young_modulus": 0}, method={"bulk_viscosity": 0}), [seconds], values={**NEUTRAL, **SECOND})
    row = run.field("hs", seconds).mean(0)
    front = centre + half * stretch * np.sqrt(1 - foot * stretch / height)
    return [
        at_most("elsewhere", elsewhere(row, cell_means(cap(centre, stretch), count, dx)), 10 * dx, "%", "exact solution, Savage and Hutter 1989"),
        at_most("front, off by", abs(end_of(row, foot, dx) - front), 0.5 * dx, "m", "the same, where it is 5 mm deep"),
    ]


@case("falling_ridge", control={ORDER: 1}, quick=(0.1,))
def falling_ridge(lab, dx):
    """A ridge without cliffs falls; its foot where it comes to rest."""
    half, height, size, times, fine = 2.5, 2.0, 12.8, (0.8, 3), 0.0125

    def scene(dx):
        count = round(size / dx)
        ridge = lambda x: np.where(np.abs(x - size / 2) < half, height * np.cos(np.pi * (x - size / 2) / (2 * half)) ** 2, 0)
        drawn = level({"nx": count, "ny": ROWS, "dx": dx}, sand=[{"file": np.tile(cell_means(ridge, count, dx), (ROWS, 1))}])
        return {**drawn, "dt": drawn["dt"] / 2} if dx == fine else drawn  # for the viscosity, which the step would bound

    # The fine grid's order is the same for a control: only the measured run may differ.
    truth = lab.variant(SECOND).run(scene(fine), times)
    run = lab.run(scene(dx), times, values=SECOND)
    rows = []
    for time, limit in zip(times, (3, 2)):
        row, exact = run.field("hs", time).mean(0), truth.field("hs", time).mean(0)
        rows.append(at_most(f"elsewhere at {time:g} s", elsewhere(row, exact.reshape(len(row), -1).mean(1)), limit * dx, "%", f"cells of {fine} m", 3 * dx if limit == 2 else None))
    foot = end_of(row, 0.02, dx) - end_of(exact, 0.02, fine)
    return [*rows, at_most("foot at rest, off by", abs(foot), 0.6 * dx, "m", "the same, where it is 2 cm deep")]
