"""Damp sand keeps its water and its shape."""
from functools import partial

import numpy as np

import patterns
from cases import case
from piles import damp
from scene import grid, level
from shapes import block, cone, draw
from shipped import shipped
from streams import TURNS
from table import at_least, at_most, exactly, shown


def speed(run, time):
    return max(np.abs(run.field(part, time)).max() for part in ("us", "vs"))


def damp_block(seconds, quick=()):
    @case(f"damp_block_{seconds}s", dx=(0.1,), quick=quick)
    def measure(lab, dx):
        cells = grid(6.4, 6.4, dx)
        sand = draw(cells, block(2, 2, 1.2))
        run = lab.run(damp(cells, sand, 0.25), [seconds], ("hs", "W", "us", "vs"))
        hs, water = run.field("hs", seconds), run.field("W", seconds)
        return [
            at_least("water in its place", water[sand > 0].sum() / (0.25 * sand.sum()), 0.9),
            at_least("sand in its place", hs[sand > 0].sum() / sand.sum(), 0.9),
            shown("top", hs.max(), "m"),
            exactly("speed", speed(run, seconds), 0, "m/s"),
        ]


damp_block(20, quick=(0.1,))
damp_block(200)


def castle(dx, wave=True, variant=None):
    scene = shipped("castle", dx, variant)
    if not wave:
        scene["water"] = [layer for layer in scene["water"] if layer["shape"] != "box"]
    return scene


def castle_dry(seconds):
    @case(f"castle_without_wave_{seconds}s", dx=(0.2, 0.1))
    def measure(lab, dx):
        run = lab.run(castle(dx, wave=False), [0, seconds], ("hs", "W", "us", "vs"))
        hs, start, water, wet = (run.field(field, time) for field in ("hs", "W") for time in (seconds, 0))
        return [
            at_least("relief kept", patterns.relief(hs, start, dx), 0.95),
            shown("water in its place", patterns.in_place(water, wet, 0)),
            shown("mean movement", 1e3 * np.abs(hs - start)[start > 0].mean(), "mm"),
            at_most("speed", speed(run, seconds), 0, "m/s"),
        ]


castle_dry(3)
castle_dry(60)


def washed(name, scene, seconds, above, least, most, held, control=None):
    """A level's own water takes part of what stood high; how much does not depend on the grid."""
    @case(name, dx=(0.2,), control=control)
    def measure(lab, dx):
        coarse, fine = lab.runs([(scene(spacing), [0, seconds]) for spacing in (dx, dx / 2)])
        start, hs, finer = coarse.field("hs", 0), coarse.field("hs", seconds), fine.field("hs", seconds)
        kept = [patterns.in_place(run.field("hs", seconds), run.field("hs", 0), above) for run in (coarse, fine)]
        apart = np.abs(patterns.restrict(finer, 2) - hs)
        return [
            at_most("difference of the two grids / moved", patterns.refinement(finer, hs, start), most, held=held),
            shown("of it where sand stood", apart[start > above].sum() / apart.sum()),
            *(shown(f"sand that left where it stood, {which}", run.field("hs", seconds)[run.field("hs", 0) <= above].sum() * run.dx**2, "m3")
              for which, run in (("coarse", coarse), ("fine", fine))),
            shown("sand elsewhere on the finer grid", patterns.elsewhere(finer, hs)),
            *(at_least(f"high sand in its place, {which}", share, least) for which, share in zip(("coarse", "fine"), kept)),
        ]


washed("castle_with_wave", castle, 3, above=1, least=0.7, most=0.11, held=0.17)
@case("castle_turned", dx=(0.2, 0.1), control={"dt": 0.03})
def castle_turned(lab, dx):
    """The castle and its wave, on a walled square with room to turn them, do what they do along the grid."""
    own = shipped("castle")
    drawn, side = lab.run(own, [0]).field("hs", 0), own["grid"]["dx"]

    def sand(x, y):  # as the level draws it, in cells of its own
        column, row = (np.floor(place / side + size / 2).astype(int) for place, size in ((x, drawn.shape[1]), (y, drawn.shape[0])))
        inside = (column >= 0) & (column < drawn.shape[1]) & (row >= 0) & (row < drawn.shape[0])
        return np.where(inside, drawn[np.clip(row, 0, drawn.shape[0] - 1), np.clip(column, 0, drawn.shape[1] - 1)], 0.0)

    def wave(x, y):
        return np.where((x > -25.6) & (x < -16) & (np.abs(y) < 12.8), 3.5, 0.0)

    def scene(turn):
        cells = grid(52, 52, dx)
        heights = draw(cells, sand, turn)
        return level(cells, own["material"], own["method"], dt=own["dt"] * dx / side, sand=[{"file": heights}],
                     water=[{"file": draw(cells, wave, turn) + 0.25 * heights}])

    straight, *turned = lab.runs([(scene(turn), [0, 3]) for turn in (0, *TURNS)])
    start, hs = straight.field("hs", 0), straight.field("hs", 3)
    return [at_most(f"turned by {turn}: difference / moved", patterns.rotation(run.field("hs", 3), hs, start, dx, turn), 0.17)
            for turn, run in zip(TURNS, turned)]


# On finer grids soaked letters stand steeper and longer.
washed("letters", partial(shipped, "letters"), 4, above=0.3, least=0.6, most=0.16, held=0.23, control={"material.friction": 0})


@case("cone_at_the_water_line", control={"material.friction": 0.2}, quick=(0.1,))
def cone_at_the_water_line(lab, dx):
    """Water that enters a gentle cone does not push it out of shape."""
    cells, surface = grid(16, 16, dx), 0.75
    sand = draw(cells, cone(slope=0.25, height=1.5))
    lake = np.maximum(surface - sand, 0)
    scenes = [level(cells, {"young_modulus": stiffness}, sand=[{"file": sand}], water=[{"file": lake}]) for stiffness in (0, 2e5)]
    most = [np.abs(run.field("hs", 5) - run.field("hs", 0)).max() for run in lab.runs([(one, [0, 5]) for one in scenes])]
    return [
        at_most("largest change of depth, friction alone", most[0], 0.12, "m"),
        at_most("the same, elastic", most[1], 0.12, "m"),
    ]


# By the paper's method, drag ahead of friction, water heaps sand up.
@case("castle_variants", dx=(0.2, 0.1), control={"method.name": "published"})
def castle_variants(lab, dx):
    """Water that runs into sand of friction alone does not pile it up higher than it was drawn."""
    times = np.arange(0, 4.01, 0.25).round(2).tolist()
    variants = ("low_friction", "high_friction")
    rows = []
    for name, run in zip(variants, lab.runs([(castle(dx, variant=name), times) for name in variants])):
        highest = [run.field("hs", time).max() for time in times]
        rows += [at_most(f"highest sand ever, {name}", max(highest), highest[0], "m"), shown(f"at 4 s, {name}", highest[-1], "m")]
    return rows
