"""From which slope layers slide, and how much cohesion holds slabs on steeper ones, at any direction to the grid."""
import numpy as np

import gauges
import laws
import shapes
from beds import strip
from cases import Case
from scene import grid, level
from table import Row, at_most, near

FRICTION, SECONDS, SLIDES = 0.5, 0.5, 0.01  # [m/s]
LAYER = 0.3  # depth [m]
TURNS = (0, 22.5, 45)
LESS_FRICTION = {"material.friction": 0.4}  # sand of less friction than the law knows
NO_RETENTION = {"material.retention": 0}  # its pores float the sand
NO_COHESION = {"material.cohesion_dry": 0, "material.cohesion_wet": 0, "material.cohesion_capillary": 0}


def incline(dx, slope, turn, sand, wet, material):
    """A level of sand(x, y), all over where it is a number, on ground that falls along the turned x axis; along the grid a strip does."""
    if turn == 0 and not callable(sand):
        cells, ground = strip(25.6, dx, slope)
    else:
        cells = grid(12.8, 12.8, dx)
        ground = shapes.incline(cells, slope, turn)
    depth = shapes.draw(cells, sand) if callable(sand) else np.full(ground.shape, float(sand))
    return level(cells, material, {"largest_height": 32}, terrain=[{"file": ground}], sand=[{"file": depth}], water=[{"file": wet * depth}] if wet else [])


def moves(lab, *scene, seconds=SECONDS):
    return gauges.middle_speed(lab.run(incline(*scene), [seconds], ("hs", "us", "vs")), seconds)


def layer(wet, share):
    """A layer without cohesion, as wide as the ground."""
    material = {"friction": FRICTION, "cohesion_wet": 0, "cohesion_capillary": 0}

    def measure(lab, dx):
        law = laws.sliding_slope(FRICTION, wet)
        rows = []
        for turn in TURNS:
            found = gauges.critical(lambda slope: moves(lab, dx, slope, turn, LAYER, wet, material) > SLIDES, 0.05, 0.85, 7)
            rows.append(near(f"slides from, turned {turn:g}", found, law, share, "infinite slope", ""))
        return rows
    return measure


def slab(kind, slope, depth):
    """A slab across the ground or a disc 12 m wide, of dry and of damp sand of one cohesion: it slides with 0.85 and stands with 1.15 of what
    the law wants."""
    def measure(lab, dx):
        # The disc's edge is a slope, since an upright one needs as much cohesion as the slab itself.
        sand = (lambda x, y: np.minimum(shapes.cone(0.5, 3)(x, y), depth)) if kind == "disc" else depth
        rows = []
        for wet in (0, 0.25):
            law = laws.slab_cohesion(slope, depth, FRICTION, wet)
            for turn in TURNS:
                def stands(share):
                    cohesion = dict.fromkeys(("cohesion_dry", "cohesion_wet", "cohesion_capillary"), share * law)
                    return moves(lab, dx, slope, turn, sand, wet, {"friction": FRICTION, **cohesion}) <= SLIDES
                rows.append(Row(f"cohesion it needs / law's, W/hs {wet:g}, turned {turn:g}", gauges.critical_share(stands), 0.85, 1.15, reference="Mohr-Coulomb"))
        return rows
    return measure


def damp_is_no_faster(slope):
    """With the levels' cohesion or with none: water that the pores hold does not make a slope faster."""
    def measure(lab, dx):
        def fastest(wet, cohesion):
            return moves(lab, dx, slope, 0, LAYER, wet, {"friction": FRICTION, "cohesion_wet": cohesion, "cohesion_capillary": cohesion}, seconds=1)
        dry = fastest(0, 0)
        return [near("dry", dry, laws.block_speed(slope, FRICTION, 1), 0.05, "g (S - mu) t/(1 + S^2)", "m/s"),
                *(at_most(f"W/hs {wet:g}, {cohesion:g} Pa", fastest(wet, cohesion), 1.01 * dry, "m/s", "no faster than dry")
                  for wet in (0.1, 0.25, 0.33, 0.45) for cohesion in (0, 8.5e3))]
    return measure


def soaked_speed(slope):
    def measure(lab, dx):
        law = laws.block_speed(slope, laws.sliding_slope(FRICTION, 1), 1)
        material = {"friction": FRICTION, "cohesion_wet": 0, "cohesion_capillary": 0}
        return [near("soaked after 1 s", moves(lab, dx, slope, 0, LAYER, 1, material, seconds=1), law, 0.25, "g (S - mu (1 - r)) t/(1 + S^2)", "m/s")]
    return measure


WETNESS = {0: 0.03, 0.1: 0.03, 0.25: 0.03, 0.6: 0.05, 0.75: 0.05, 1: 0.03}  # W/hs: share of the law
QUICK = (0.2,)
CASES = [
    *(Case(f"incline/layer/wet_{wet:g}", layer(wet, share), (0.2, 0.1), LESS_FRICTION, QUICK if wet in (0, 0.25, 1) else ()) for wet, share in WETNESS.items()),
    *(Case(f"incline/{kind}/slope_{slope:g}/depth_{depth:g}", slab(kind, slope, depth), (0.2, 0.1), NO_COHESION,
           QUICK if (kind, slope, depth) == ("disc", 1.0, 0.3) else ())
      for kind in ("slab", "disc") for slope in (0.7, 1.0, 1.2) for depth in (0.3, 1.0)),
    *(Case(f"incline/damp/slope_{slope:g}", damp_is_no_faster(slope), (0.1,), NO_RETENTION, (0.1,) if slope == 0.7 else ()) for slope in (0.3, 0.45, 0.7, 1.0, 1.2)),
    *(Case(f"incline/soaked/slope_{slope:g}", soaked_speed(slope), (0.1,), {"material.friction": 0}, ()) for slope in (0.3, 0.45, 0.7, 1.0)),
]
