"""Sand at still water: banks below their friction keep every bit, steeper ones come to rest at it, a cohesive dune in a lake stays."""
import numpy as np

import gauges
import shapes
from beds import ridge, strip
from cases import Case
from scene import grid, level
from table import at_most, exactly, near

FRICTION, SECONDS, LEVEL = 0.5, 10, 1.0  # of the lake over the ground [m]
LOW, HIGH = 0.4, 1.6  # of the bank's foot and top [m]
WAYS = {"": {}, "_friction_only": {"young_modulus": 0}, "_no_retention": {"retention": 0}}
WATER = [{"shape": "plane", "surface": LEVEL, "inside_sand": True}]


def bank(dx, slope, turn):
    height = lambda x, y: np.clip(LEVEL + slope * x, LOW, HIGH)
    cells = grid(9.6, 9.6, dx) if turn else strip(9.6, dx)[0]
    return cells, shapes.draw(cells, height, turn)


def kept(run, fields):
    return [*(exactly(f"largest change of {name}", np.abs(run.field(name, SECONDS) - run.field(name, 0)).max(), 0, "m") for name in fields),
            exactly("fastest sand", gauges.speed(run, SECONDS), 0, "m/s")]


def still(slope, turn, way):
    def measure(lab, dx):
        cells, sand = bank(dx, slope, turn)
        # RECOMMENDED sets a retention, and what a scene's own values say goes on top of it.
        values = {f"material.{key}": value for key, value in {"friction": FRICTION, **WAYS[way]}.items()}
        run = lab.run(level(cells, sand=[{"file": sand}], water=WATER), [0, SECONDS], ("hs", "us", "vs"), values)
        if slope < FRICTION:
            return kept(run, ("hs",))
        within = np.abs(shapes.turned(*shapes.centres(cells), turn)[0]) < 1
        slopes = gauges.face_slopes(np.zeros_like(sand), run.field("hs", SECONDS), dx, within)
        return [near("steep faces (95 %)", np.quantile(slopes, 0.95), FRICTION, 0.05, "friction", ""),
                at_most("fastest sand", gauges.speed(run, SECONDS), 1e-3, "m/s")]
    return measure


def dune(surface):
    """Of 8 kPa where it is dry or damp; soaked sand has none."""
    def measure(lab, dx):
        cells = strip(12.8, dx)[0]
        sand = shapes.draw(cells, ridge(0.3, 1.5))
        material = {"friction": FRICTION, "cohesion_dry": 8e3, "cohesion_wet": 8e3, "cohesion_capillary": 8e3}
        scene = level(cells, material, sand=[{"file": sand}], water=[{"shape": "plane", "surface": surface, "inside_sand": True}])
        return kept(lab.run(scene, [0, SECONDS], ("hs", "W", "us", "vs")), ("hs", "W"))
    return measure


LESS_FRICTION = {"material.friction": 0.2, "material.cohesion_dry": 0, "material.cohesion_wet": 0, "material.cohesion_capillary": 0}
CASES = [
    *(Case(f"bank/slope_{slope:g}{way}/turned_{turn:g}", still(slope, turn, way), (0.1, 0.05) if not turn else (0.1,), LESS_FRICTION,
           (0.1,) if (slope, turn, way) in ((0.4, 0, ""), (0.55, 0, "")) else ())
      for slope in (0.3, 0.4, 0.48, 0.55) for way in WAYS for turn in ((0, 45) if not way else (0,))),
    *(Case(f"bank/cohesive_dune/lake_{surface:g}", dune(surface), (0.1,), LESS_FRICTION, (0.1,) if surface == 0.6 else ()) for surface in (0.3, 0.6, 0.9, 1.2)),
]
