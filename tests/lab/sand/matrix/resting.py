"""What is poured, dug or washed comes to rest at its friction, whatever it lies on: shapes x beds x cells x frictions x directions."""
import numpy as np

import gauges
import shapes
from beds import BEDS, SHAPES, WITHIN, scene_of
from cases import Case
from scene import override
from shipped import shipped
from table import Row, at_least, at_most, exactly, shown

FIELDS = ("H", "hs", "W", "us", "vs")
SECONDS = 8
STEEP, FLAT = 1.03, 0.8  # of the friction, at rest
ROUND = ("cylinder", "cone_0.48", "cone_0.7", "cone_1.0", "hole", "pit_0.6", "pit_1.0", "pit_1.5")  # turned they are the same
LONG = tuple(name for name in SHAPES if name not in ROUND)
SOME = ("cylinder", "cone_0.48", "cone_1.0", "dune", "step", "pit_1.0")

# shapes, beds, cells [m], frictions, degrees to the grid: all of each with all of the others.
TABLE = (
    (tuple(SHAPES), tuple(BEDS), (0.1,), (0.5,), (0,)),
    (SOME, ("none", "dry_0.5", "dry_2", "soaked", "drowned", "sloping"), (0.2, 0.05), (0.5,), (0,)),
    (SOME, ("none", "dry_0.5", "damp", "soaked", "sloping"), (0.1,), (0.35, 0.7), (0,)),
    (LONG, ("none", "dry_0.5", "damp", "soaked", "drowned", "sloping"), (0.1,), (0.5,), (22.5, 45)),
    (ROUND[:4], ("sloping",), (0.1,), (0.5,), (22.5, 45)),
)
QUICK = {(shape, bed, 0.5, 0) for shape, bed in (
    ("cylinder", "none"), ("cylinder", "dry_0.5"), ("cylinder", "soaked"), ("cylinder", "sloping"), ("cone_0.48", "dry_0.5"), ("cone_1.0", "dry_0.1"),
    ("step", "dry_2"), ("hole", "dry_0.5"), ("pit_1.0", "drowned"), ("hills", "damp"), ("box", "held"))}
QUICK_CELLS = 0.2

WALL = {"material.cohesion_dry": 2e4, "material.cohesion_wet": 2e4, "material.cohesion_capillary": 2e4}  # holds all of it upright
WALL_UNDER_WATER = {"material.friction": 10}  # soaked sand has no cohesion
LESS_FRICTION = {"material.friction": 0.2}


def stands(shape, bed):
    """Drawn below its friction: nothing moves."""
    return BEDS[bed].holds or (shape == "cone_0.48" and bed not in ("soaked", "sloping"))


def standing(run):
    start, end = (run.field("hs", time) for time in (0, SECONDS))
    return [exactly("largest change of depth", np.abs(end - start).max(), 0, "m"), exactly("fastest sand", gauges.speed(run, SECONDS), 0, "m/s")]


def holding(run):
    """Cohesion enough for an upright wall: what little it gives is none of a slope that runs."""
    start, end = (run.field("hs", time) for time in (0, SECONDS))
    return [at_most("sand elsewhere", np.abs(end - start).sum() / (2 * start.sum()), 0.005), at_most("fastest sand", gauges.speed(run, SECONDS), 1e-4, "m/s")]


def settled(run, bed, friction):
    dx, wet = run.dx, BEDS[bed].wet > 0 or BEDS[bed].lake is not None
    ground, hs, water, past = run.field("H", SECONDS), run.field("hs", SECONDS), run.field("W", SECONDS), run.field("hs", SECONDS - 1)
    within = np.hypot(*shapes.centres(run.grid)) < WITHIN
    slope = gauges.steepest(ground, hs, dx, within) / friction
    rows = []
    if bed == "soaked":
        rows.append(at_most("steepest / friction", slope, STEEP))
        rows.append(at_most("load on its friction", gauges.load(ground, hs, water, dx, friction, within), STEEP, "", "(S (1 - r f) + S_w r f) / (mu (1 - r f))"))
    else:
        rows.append(Row("steepest / friction", slope, FLAT, STEEP))
    rows.append(at_most("change of depth in the last second", np.abs(hs - past).max(), 1e-3 if wet else 0, "m"))
    return [*rows, at_most("fastest sand", gauges.speed(run, SECONDS), 1e-3 if wet else 1e-4, "m/s")]


def resting(shape, bed, friction, turn):
    def measure(lab, dx):
        # The friction is part of the law: a control that sets another is held to this one.
        run = lab.run(scene_of(shape, bed, dx, friction, turn), [0, SECONDS - 1, SECONDS], FIELDS)
        if stands(shape, bed):
            return holding(run) if BEDS[bed].holds else standing(run)
        return settled(run, bed, friction)
    return measure


def control(shape, bed):
    if stands(shape, bed):
        return {**LESS_FRICTION, **dict.fromkeys(WALL, 0)}
    return WALL_UNDER_WATER if bed in ("soaked", "drowned") else WALL


def name_of(shape, bed, friction, turn):
    return f"rest/{shape}/{bed}/friction_{friction:g}/turned_{turn:g}"


def combinations():
    """{(shape, bed, friction, turn): cells}"""
    found = {}
    for names, beds, spacings, frictions, turns in TABLE:
        for key in ((shape, bed, friction, turn) for shape in names for bed in beds for friction in frictions for turn in turns):
            found.setdefault(key, set()).update(spacings)
    return found


# Brushes on the shipped beach, dry and of 210 Pa there: a heap and a hole by the level's own edits, on a piece of it away from its rocks.
CORNER, PIECE, BRUSHED = (20.0, 16.4), 8.0, 1.5  # [m], [m], seconds of brushing
BRUSHES = {"heap": {"radius": 0.6, "amount": 0.08}, "hole": {"radius": 1.0, "amount": -0.05}}


def brushed(what):
    def measure(lab, dx):
        beach = override(shipped("beach", dx), {"edits": []})
        whole = lab.run(beach, [0], ("H", "hs", "W"))
        west, south, count = (round(length / dx) for length in (*CORNER, PIECE))
        terrain, sand, water = (whole.field(name, 0)[south : south + count, west : west + count] for name in ("H", "hs", "W"))
        edit = {"time": 0, "until": BRUSHED, "every": 0.1, "layer": "sand", "shape": "disc", "center": [PIECE / 2, PIECE / 2], **BRUSHES[what]}
        piece = {**{key: beach[key] for key in ("format_version", "name", "dt", "material", "method")}, "grid": {"nx": count, "ny": count, "dx": beach["grid"]["dx"]},
                 "terrain": [{"file": terrain}], "sand": [{"file": sand}], "water": [{"file": water}], "edits": [edit]}
        run = lab.run(piece, [SECONDS - 1, SECONDS], FIELDS)
        ground, hs = run.field("H", SECONDS), run.field("hs", SECONDS)
        material = beach["material"]
        within = np.hypot(*shapes.centres(run.grid)) < PIECE / 2 - 0.5
        # Heights outside do not count: they are the beach's own.
        surface = np.where(within, ground + hs, np.nan)
        needed = gauges.needed_cohesion(surface, dx, material["friction"]) / material["cohesion_dry"]
        return [
            at_most("cohesion that its faces need / have", needed, 1.25, "", "Culmann"),
            shown("steepest / friction", gauges.steepest(ground, hs, dx, within) / material["friction"]),
            shown("relief", np.nanmax(surface) - np.nanmin(surface), "m"),
            at_least("sand moved", np.abs(hs - sand).sum() * dx**2, 0.1, "m3"),
            at_most("change of depth in the last second", np.abs(hs - run.field("hs", SECONDS - 1)).max(), 0, "m"),
            at_most("fastest sand", gauges.speed(run, SECONDS), 1e-4, "m/s"),
        ]
    return measure


CASES = [
    *(Case(name_of(*key), resting(*key), tuple(sorted(cells, reverse=True)), control(*key[:2]), (QUICK_CELLS,) if key in QUICK else ())
      for key, cells in combinations().items()),
    *(Case(f"rest/beach/{what}", brushed(what), (0.2, 0.1), WALL, ()) for what in BRUSHES),
]
