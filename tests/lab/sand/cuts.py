"""Vertical cuts in damp sand: how high one stands, by Rankine (1857)."""
import concurrent.futures
import math

import numpy as np

from cases import case
from piles import damp
from scene import grid
from table import at_least, at_most, near

HIGH, LONG = 2, 3  # of the sand behind the cut [m]
GRAVITY, DENSITY, WET = 9.81, 2000, 0.28  # [m/s2], [kg/m3], water as a share of the sand, where cohesion is full
FRICTIONS = (0.2, 0.4, 0.6, 0.8)
SECONDS = 2


def passive(friction):
    """tan(45 deg + phi/2), tan phi = friction; a cut stands to 4 of it cohesion / weight (W. J. M. Rankine 1857)."""
    return friction + math.sqrt(1 + friction**2)


def lost(lab, dx, friction, cohesion):
    """Share of Rankine's wedge, from the foot of the cut up at 45 deg + phi/2, that leaves its place."""
    cells = grid(8, 4 * dx, dx)
    sand = np.zeros((cells["ny"], cells["nx"]))
    sand[:, : round(LONG / dx)] = HIGH
    material = {"friction": friction, "yield_friction": friction, "sand_density": DENSITY, "cohesion_wet": cohesion, "cohesion_capillary": cohesion}
    hs = lab.run(damp(cells, sand, WET, material=material), [SECONDS]).field("hs", SECONDS)
    wedge = HIGH**2 / 2 / passive(friction) * cells["ny"] * dx
    return (sand - hs)[sand > 0].sum() * dx**2 / wedge


def critical(lab, dx, friction, share=1.0):
    """Height at which a cut loses a tenth of its wedge, in cohesion / weight, by bisection from half to twice Rankine's; `share` of the
    cohesion is there. It is the cohesion that changes, not the height, so that the grid stays what it is."""
    rankine = 4 * passive(friction)
    low, high = 0.5, 2.0
    for _ in range(5):
        ratio = math.sqrt(low * high)
        if lost(lab, dx, friction, share * DENSITY * GRAVITY * HIGH / (ratio * rankine)) < 0.1:
            low = ratio
        else:
            high = ratio
    return math.sqrt(low * high) * rankine


# The friction within the sand is that of its yield surface: with one for all the height is the same for all.
@case("vertical_cut", control={"material.yield_friction": 0.4}, quick=(0.1,))
def vertical_cut(lab, dx):
    with concurrent.futures.ThreadPoolExecutor(len(FRICTIONS)) as pool:
        heights = list(pool.map(lambda friction: critical(lab, dx, friction), FRICTIONS))
    rows = [near(f"height it stands to, friction {friction:g}", height, 4 * passive(friction), 0.3, "Rankine", "c/w")
            for friction, height in zip(FRICTIONS, heights)]
    # The paper's yield surface, whose c is the cohesion itself: its tip bears less. Half is the least that is looked for.
    steep = FRICTIONS[-1]
    bare = critical(lab, dx, steep, 1 / (4 * steep * passive(steep)))
    return [*rows, at_least("least rise from friction to friction", np.diff(heights).min(), 0.5, "c/w"),
            at_most(f"with the paper's yield surface / Rankine's, friction {steep:g}", bare / (4 * passive(steep)), 0.7)]
