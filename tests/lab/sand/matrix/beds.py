"""Shapes of sand and what they lie on. Heights are functions of x and y about the middle, in metres; steep ones scale with the friction, so
that a shape is as far beyond its friction at 0.35 as at 0.7."""
import dataclasses

import numpy as np

import piles
import shapes
from scene import grid, level

SIDE = 6.4  # of the walled square [m]
WITHIN = 2.6  # of the middle: where a turned shape meets the walls askew nothing is measured [m]
NORMAL = 0.5  # friction for which shapes are named
LAKE = 2.6  # over the ground of drowned beds [m]


def ridge(slope, height):
    return lambda x, y: np.maximum(height - slope * np.abs(x), 0.0)


def hollow(slope, depth):
    """A layer of that depth with a cone taken out of it."""
    return lambda x, y: np.minimum(slope * np.hypot(x, y), depth)


def hills(steepness):
    noise = piles.uneven(0.28 * steepness, 1.6)
    return lambda x, y: np.maximum(0.6 + noise(x, y), 0.0)


SHAPES = {  # height(k): k = friction / NORMAL
    "cylinder": lambda k: shapes.disc(0.8, 1.6),
    "box": lambda k: shapes.block(1.4, 1.4, 1.2),
    "cone_0.48": lambda k: shapes.cone(0.48 * k, 0.9),
    "cone_0.7": lambda k: shapes.cone(0.7 * k, 1.2),
    "cone_1.0": lambda k: shapes.cone(1.0 * k, 1.5),
    "dune": lambda k: ridge(0.8 * k, 1.0),
    "step": lambda k: lambda x, y: np.where(x < 0, 1.0, 0.0),
    "hole": lambda k: lambda x, y: np.where(np.hypot(x, y) < 1.2, 0.0, 1.2),
    "pit_0.6": lambda k: hollow(0.6 * k, 0.9),
    "pit_1.0": lambda k: hollow(1.0 * k, 0.9),
    "pit_1.5": lambda k: hollow(1.5 * k, 0.9),
    "hills": lambda k: hills(k),
}


@dataclasses.dataclass(frozen=True)
class Bed:
    depth: float = 0.5  # of the sand under the shape [m]
    wet: float = 0.0  # water in bed and shape, as a share of the sand
    lake: float | None = None  # surface over the ground [m]
    slope: float = 0.0  # of the ground, down the turned x axis
    holds: bool = False  # at that wetness sand is cohesive; dry, soaked and drowned sand never is


BEDS = {
    "none": Bed(0),
    "dry_0.1": Bed(0.1),
    "dry_0.5": Bed(0.5),
    "dry_2": Bed(2),
    "damp": Bed(wet=0.2),
    "held": Bed(wet=0.25, holds=True),
    "soaked": Bed(wet=1),
    "drowned": Bed(lake=LAKE),
    "sloping": Bed(slope=0.2),
}


def scene_of(shape, bed, dx, friction, turn):
    """A level of that shape on that bed."""
    on = BEDS[bed]
    cells = grid(SIDE, SIDE, dx)
    sand = on.depth + shapes.draw(cells, SHAPES[shape](friction / NORMAL), turn)
    # The key for sand wetter than any here stays, so that every world has cohesion, of which nothing may come.
    drawn = level(cells, {"friction": friction, **({} if on.holds else {"cohesion_wet": 0})}, sand=[{"file": sand}])
    if on.slope:
        drawn["terrain"] = [{"file": shapes.incline(cells, on.slope, turn)}]
    if on.lake:
        drawn["water"] = [{"shape": "plane", "surface": on.lake}]
    elif on.wet:
        drawn["water"] = [{"file": on.wet * sand}]
    return drawn


def strip(length, dx, slope=0.0):
    """Four cells wide, on ground that falls along x: cells and ground."""
    cells = {"nx": round(length / dx), "ny": 4, "dx": dx}
    return cells, shapes.incline(cells, slope)
