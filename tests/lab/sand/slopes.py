"""What a slope of dry sand holds and how fast sand slides on one: cones, ridges, poured heaps, a slab on an incline. Closed forms."""
import math

import numpy as np

import shapes
from cases import case
from scene import grid, level
from table import at_most, exactly, near

FORCES = (("", {}), ("_friction_only", {"young_modulus": 0}))


def gradients(hs, dx):
    """Sizes of the surface's gradient on flat ground, where a cell and the four around it hold sand."""
    inner = hs[1:-1, 1:-1]
    around = (hs[1:-1, 2:], hs[1:-1, :-2], hs[2:, 1:-1], hs[:-2, 1:-1])
    size = np.hypot(around[0] - around[1], around[2] - around[3]) / (2 * dx)
    return np.where((inner > 0.05) & (np.minimum.reduce(around) > 0.02), size, np.nan)


def fastest(run, time):
    return max(np.abs(run.field(name, time)).max() for name in ("us", "vs"))


def cone(lab, dx, slope, seconds, material, lake):
    cells = grid(12, 12, dx)
    drawn = level(cells, sand=[{"file": shapes.draw(cells, shapes.cone(slope, 2))}], material=material)
    if lake > 0:
        drawn["water"] = [{"shape": "plane", "surface": lake}]
    return lab.run(drawn, [0, seconds], ("hs", "us", "vs"))


def standing_cone(name, material, lake):
    """A slope below the friction is at rest, bit by bit; under water as well, whose weight the sand does not feel."""
    # Grid by grid it is the same arithmetic.
    @case(name, dx=(0.1,), control={"material.friction": 0.48}, quick=(0.1,) if not lake else ())
    def measure(lab, dx):
        run = cone(lab, dx, 0.495, 3, {"friction": 0.5, **material}, lake)
        return [
            exactly("largest change of height", np.abs(run.field("hs", 3) - run.field("hs", 0)).max(), 0, "m"),
            exactly("fastest sand", fastest(run, 3), 0, "m/s"),
        ]


def settling_cone(name, slope, material, lake, share, control):
    """A slope above the friction moves until it is as steep as the friction."""
    @case(name, dx=(0.1,), control={"material.friction": control})
    def measure(lab, dx):
        run = cone(lab, dx, slope, 6, {"friction": 0.5, **material}, lake)
        steep = np.nanquantile(gradients(run.field("hs", 6), dx), 0.95)
        return [near("steep slopes (95 %)", steep, 0.5, share, "friction", ""), at_most("fastest sand", fastest(run, 6), 1e-3, "m/s")]


def sliding_slab(name, material, quick):
    """A thin disc on an incline that is steeper than its friction: a block."""
    slope, friction, seconds = 0.6, 0.4, 0.5

    @case(name, quick=quick)
    def measure(lab, dx):
        cells = grid(24, 24, dx)
        angles = (0, 22.5, 45)
        disc = shapes.draw(cells, lambda x, y: np.where(np.hypot(x, y) < 5, 0.2, 0.0))
        found = lab.runs([(level(cells, terrain=[{"file": shapes.incline(cells, slope, angle)}], sand=[{"file": disc}],
                                 material={"friction": friction, **material}), [seconds], ("hs", "us", "vs")) for angle in angles])
        rows = []
        for angle, run in zip(angles, found):
            hs, u, v = (run.field(field, seconds) for field in ("hs", "us", "vs"))
            law = 9.81 * (slope - friction) / (1 + slope**2) * seconds
            rows.append(near(f"speed at {angle:g} degrees", np.median(np.hypot(u, v)[hs > 0.1]), law, 0.02, "g (S - mu)/(1 + S^2) t", "m/s"))
            direction = math.degrees(math.atan2((hs * v).sum(), (hs * u).sum()))
            rows.append(at_most(f"direction at {angle:g} degrees, off by", abs(direction - angle), 0.3, "deg", "straight down"))
        return rows


def poured_heap(rate, control, held=None):
    """Sand poured onto a disc for 3.6 s stands at its friction."""
    @case(f"poured_heap_{rate:g}", control=control, quick=(0.1,))
    def measure(lab, dx):
        cells, seconds = grid(8, 8, dx), 6
        source = {"shape": "disc", "center": [4, 4], "radius": 0.5, "material": "sand", "rate": [[0, rate], [3.6, rate], [3.61, 0]]}
        run = lab.run(level(cells, sources=[source]), [seconds], ("hs", "us", "vs"))
        steep = np.nanmedian(gradients(run.field("hs", seconds), dx))
        return [near("median slope", steep, 0.5, 0.08, "friction", "", held), at_most("fastest sand", fastest(run, seconds), 1e-3, "m/s")]


@case("ridges", control={"material.friction": 0.53})
def ridges(lab, dx):
    """A ridge that is too steep comes to rest at its friction, however it lies to the grid."""
    cells = grid(20, 20, dx)
    angles, seconds = (0, 15, 30, 45), 4
    found = lab.runs([(level(cells, sand=[{"file": shapes.draw(cells, lambda x, y: np.maximum(2 - 0.8 * np.abs(x), 0), angle)}]), [seconds],
                       ("hs", "us", "vs")) for angle in angles])
    near_middle = np.hypot(*shapes.centres(cells))[1:-1, 1:-1] < 6  # away from where a ridge meets the walls askew
    steep = [np.nanquantile(gradients(run.field("hs", seconds), dx)[near_middle], 0.95) for run in found]
    rows = [near(f"steep slopes (95 %) at {angle} degrees", value, 0.5, 0.03, "friction", "") for angle, value in zip(angles, steep)]
    return [*rows, at_most("largest difference of these", max(steep) - min(steep), 0.01),
            at_most("fastest sand", max(fastest(run, seconds) for run in found), 1e-3, "m/s")]


for suffix, force in FORCES:
    standing_cone(f"cone_0.495{suffix}", force, 0)
    standing_cone(f"cone_0.495_drowned{suffix}", force, 4)
    sliding_slab(f"slab{suffix}", force, (0.1,) if not suffix else ())
    # The elastoplastic force bears a little of what slides down.
    settling_cone(f"cone_0.6{suffix}", 0.6, force, 0, 0.03, 0.53)
settling_cone("cone_0.505_friction_only", 0.505, {"young_modulus": 0}, 0, 0.006, 0.52)
settling_cone("cone_0.52_drowned_friction_only", 0.52, {"young_modulus": 0}, 4, 0.01, 0.52)
poured_heap(0.1, {"material.friction": 0.45})
poured_heap(0.6, None, held=0.1)
