"""Faces of cohesive sand stand to the cohesion that Culmann's plane asks for, upright ones to Rankine's height."""
import math

import numpy as np

import gauges
import laws
import shapes
from beds import strip
from cases import Case
from scene import level
from table import Row

HIGH, TOP, SECONDS = 2.0, 3.0, 2  # of the face, and how far its top reaches [m]
FALLEN = 0.1  # share of the wedge that may go
NO_COHESION = {"material.cohesion_dry": 0}


def needed(lab, dx, slope, friction):
    """Cohesion with which a face stands, as a share of the law's."""
    cells, ground = strip(TOP + 7, dx)
    face = shapes.draw(cells, lambda x, y: np.clip(HIGH - (0 if math.isinf(slope) else slope) * np.maximum(x + 5 - TOP, 0), 0, None)
                       * ((x + 5 < TOP) | np.isfinite(slope)))
    law, wedge = laws.face_cohesion(HIGH, slope, friction), laws.face_wedge(HIGH, slope, friction)

    def stands(share):
        material = {"friction": friction, "yield_friction": friction, "cohesion_dry": share * law, "cohesion_wet": 0, "cohesion_capillary": 0}
        run = lab.run(level(cells, material, sand=[{"file": face}]), [SECONDS])
        return gauges.lost(face, run.field("hs", SECONDS), dx) < FALLEN * wedge
    return gauges.critical_share(stands)


def inclined(degrees, friction):
    def measure(lab, dx):
        slope = math.inf if degrees == 90 else math.tan(math.radians(degrees))
        return [Row("cohesion it needs / law's", needed(lab, dx, slope, friction), 0.8, 1.25, reference="Culmann")]
    return measure


def upright(friction):
    def measure(lab, dx):
        return [Row("height it stands to / law's", 1 / needed(lab, dx, math.inf, friction), 0.9, 1.15, reference="Rankine")]
    return measure


CASES = [
    *(Case(f"face/{degrees}_degrees/friction_{friction:g}", inclined(degrees, friction), (0.1, 0.05), NO_COHESION, (0.1,) if (degrees, friction) == (50, 0.6) else ())
      for degrees in (90, 70, 50, 40) for friction in (0.4, 0.6)),
    *(Case(f"face/cut/friction_{friction:g}", upright(friction), (0.2, 0.1), NO_COHESION, (0.2,) if friction == 0.4 else ()) for friction in (0.2, 0.4, 0.6, 0.8)),
]
