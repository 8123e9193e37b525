"""Piles, blocks and films of wet sand: no patterns of the grid, no direction of the grid, and the same on a finer grid."""
import numpy as np

import patterns
import shapes
from cases import case
from scene import grid, level
from table import at_least, at_most, shown

FIELD = 11.2  # walled square around a pile, as in level `piles` [m]
RADIUS, HEIGHT = 2, 2  # of a pile
RIPPLE = 1.2  # wavelengths below it are patterns, not shape [m]
STANDING = (0.1, 0.25, 0.33)  # water of piles that keep a rim, as a share of the sand
STILL = 0.01  # mean movement below which two grids are compared by their heights alone [m]


def uneven(amplitude=0.01, shortest=0.8, octaves=3, waves=12):
    """A smooth unevenness that is the same on every grid: plane waves of random directions and phases, the same at each call, none
    shorter than `shortest` [m]."""
    draws = np.random.default_rng(1)
    parts = [(shortest * 2**octave, *draws.uniform(0, 2 * np.pi, 2)) for octave in range(octaves) for _ in range(waves)]

    def height(x, y):
        total = 0
        for wavelength, direction, phase in parts:
            total = total + np.cos(2 * np.pi / wavelength * (np.cos(direction) * x + np.sin(direction) * y) + phase)
        return amplitude / np.sqrt(len(parts)) * total

    return height


def damp(cells, sand, wet, **sections):
    """Sand with water as a share of its depth."""
    return level(cells, sand=[{"file": sand}], water=[{"file": wet * sand}], **sections)


def ripple_limit(name, measured, unit):
    return at_most(name, measured, 10, unit)


def middle(heights, dx, width=0.2):
    """Mean over the square in the middle."""
    half, low = max(1, round(width / dx / 2)), len(heights) // 2
    return heights[low - half : low + half, low - half : low + half].mean()


def pile(wet, control=None, quick=()):
    @case(f"pile_{wet:g}", dx=(0.1,), control=control, quick=quick)
    def measure(lab, dx):
        noise, spacings = uneven(), (dx, dx / 2)
        cells = [grid(FIELD, FIELD, spacing) for spacing in spacings]
        drawn = [shapes.draw(one, lambda x, y: np.where(np.hypot(x, y) < RADIUS, HEIGHT + noise(x, y), 0)) for one in cells]
        runs = lab.runs([(damp(one, sand, wet), [3], ("hs", "W", "us", "vs")) for one, sand in zip(cells, drawn)])
        coarse, fine = [run.field("hs", 3) for run in runs]
        rows = [
            at_most("difference of the two grids / moved", patterns.refinement(fine, coarse, drawn[0], STILL), 0.06),
            shown("mean movement", np.abs(coarse - drawn[0]).mean() * 1e3, "mm"),
        ]
        for name, run, start, spacing in zip(("coarse", "fine"), runs, drawn, spacings):
            hs = run.field("hs", 3)
            ripples = 1e3 * patterns.ripples(hs, spacing, RIPPLE)
            # The drawn rim of a pile that stands, a step of cells, is no ripple.
            rows.append((shown if wet in STANDING else ripple_limit)(f"ripples below {RIPPLE} m, {name}", ripples, unit="mm"))
            ripples = 1e3 * patterns.ripples(hs, spacing, RIPPLE, within=0.75 * RADIUS)
            rows.append(ripple_limit(f"ripples inside {0.75 * RADIUS} m, {name}", ripples, unit="mm"))
            kept = middle(hs, spacing) / middle(start, spacing)
            name_kept = f"centre / drawn, {name}"
            rows.append(at_least(name_kept, kept, 0.97) if wet in (0.25, 0.33) else shown(name_kept, kept))
            radii = patterns.front(hs, spacing, 0.05)
            rows += [
                shown(f"front, {name}", radii.mean(), "m"),
                shown(f"mode 4 of the front, {name}", 1e3 * patterns.lobes(radii, 4), "mm"),
                shown(f"modes 17 to 59 of the front, {name}", 1e3 * patterns.roughness(radii, 17, 59), "mm"),
                shown(f"speed, {name}", max(np.abs(run.field(part, 3)).max() for part in ("us", "vs")), "m/s"),
            ]
        return rows


# Where the neutral laws make no patterns, a time step so long that the speed's clamp holds the finer grid back must show.
pile(0, control={"dt": 0.03})
pile(0.1, control={"dt": 0.018})
pile(0.25)
pile(0.33)
pile(0.45, quick=(0.1,))
pile(1, control={"dt": 0.018})


@case("film")
def film(lab, dx):
    """The front of the water that a soaked pile sheds is round."""
    cells, depth = grid(2 * FIELD, 2 * FIELD, dx), 0.005
    sand = shapes.draw(cells, shapes.disc(RADIUS, HEIGHT))
    run = lab.run(damp(cells, sand, 1), [1.2], ("hs", "W"))
    water, sand = (patterns.front(run.field(name, 1.2), dx, least) for name, least in (("W", depth), ("hs", 0.05)))
    return [
        at_most("mode 4 of the water's front / its radius", abs(patterns.lobes(water, 4)) / water.mean(), 0.02),
        shown("radius of the water", water.mean(), "m"),
        shown("mode 4 of the water's front", 1e3 * patterns.lobes(water, 4), "mm"),
        shown("mode 4 of the sand's front", 1e3 * patterns.lobes(sand, 4), "mm"),
    ]


@case("blocks_turned")
def blocks_turned(lab, dx):
    """A square block turned against the grid does what it does along the grid."""
    cells, turns, shares = grid(FIELD, FIELD, dx), (0, 15, 30, 45), (0.1, 0.45)
    drawn = [shapes.draw(cells, shapes.block(3.2, 3.2, 2), turn) for turn in turns]
    runs = iter(lab.runs([(damp(cells, sand, wet), [3]) for wet in shares for sand in drawn]))
    rows = []
    for wet in shares:
        straight, *turned = [next(runs).field("hs", 3) for _ in turns]
        for turn, heights in zip(turns[1:], turned):
            # Turning back blurs: the drawings differ as well.
            measured = patterns.rotation(heights, straight, drawn[0], dx, turn)
            name = f"W/hs {wet:g}, turned by {turn}: difference / moved"
            rows.append(at_most(name, measured, 0.03, held=0.041 if wet == 0.1 else None) if turn == 45 else shown(name, measured))
    return rows
