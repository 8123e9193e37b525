"""Cases on n x n cells whose right answer comes from outside: exact solutions, and sand by the material point method. Needs numpy."""
import dataclasses
import math
import pathlib
import sys

import numpy as np

import exact

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "sand"))
import columns  # noqa: E402
import scene  # noqa: E402  of tests/lab/sand
import shapes  # noqa: E402


@dataclasses.dataclass(frozen=True)
class Case:
    """level(n): without dt; files(n): {name: [y, x]} maps beside it; step: dt/dx [s/m]; error(now, dx, t): of field `field` at the end [%]."""

    title: str
    of: str  # what it shows: "water", "dry sand", "wet sand"
    truth: str
    length: float  # of a side [m]
    seconds: float
    step: float
    field: str
    level: object
    error: object
    files: object = lambda n: {}
    order: dict = dataclasses.field(default_factory=lambda: {"water_transport_order": 2})  # the choice "order 2"


def of_truth(now, truth, scale=None):
    """Mean absolute error in percent of `scale`, or of the truth's mean."""
    return float(100 * np.abs(now - truth).mean() / (scale or truth.mean()))


def square(n, length, **rest):
    return {"format_version": 1, "name": "frontier", "grid": {"nx": n, "ny": n, "dx": length / n}, **rest}


def middles(n, length):
    return (np.arange(n) + 0.5) * length / n


def along_x(values, n):
    return np.repeat(np.asarray(values, "f4")[None, :], n, 0)


def bore():
    length, right = 50.0, 0.2

    def error(now, dx, t):
        truth = np.array([exact.stoker((i + 0.5) * dx, t, 1, right, length / 2) for i in range(now.shape[1])])
        return of_truth(now[now.shape[0] // 2], truth, 1)

    return Case("A dam of 1 m breaks onto 0.2 m of water", "water", "Stoker 1957, exact", length, 3, 0.04, "W", lambda n: square(
        n, length, water=[{"shape": "plane", "height": right}, {"shape": "box", "from": [0, 0], "to": [length / 2, length], "height": 1, "combine": "set"}]), error)


def bowl():
    h0, r0, length = 0.1, 0.8, 4.0
    big = (1 - r0 * r0) / (1 + r0 * r0)
    period = 2 * math.pi / math.sqrt(8 * exact.G * h0)

    def square_radius(n):
        at = middles(n, length) - length / 2
        return at[None, :] ** 2 + at[:, None] ** 2

    def depth(n, t):
        rr, q = square_radius(n), 1 - big * math.cos(2 * math.pi * t / period)
        return np.maximum(0, h0 * (math.sqrt(1 - big * big) / q - 1 - rr * ((1 - big * big) / (q * q) - 1)) + h0 * (1 - rr))

    return Case("Water swings in a round bowl, one period", "water, moving shores", "Thacker 1981, exact", length, period, 0.1, "W",
                lambda n: square(n, length, terrain=[{"file": "bed.npy"}], water=[{"file": "water.npy"}]),
                lambda now, dx, t: of_truth(now, depth(now.shape[0], t)), lambda n: {"bed.npy": h0 * (square_radius(n) - 1), "water.npy": depth(n, 0)})


def column():
    length, aspect = float(columns.AXIS_BOX), 1

    def error(now, dx, t):
        depth = columns.rings({"nx": now.shape[1], "ny": now.shape[0], "dx": dx}, now.astype(float))
        return float(columns.elsewhere(depth, columns.profile(f"axi_triaxial_a{aspect}", len(depth)), 2 * np.arange(len(depth)) + 1))

    return Case("A round column of dry sand, as high as its radius, collapses", "dry sand", "material point method in three dimensions (tests/lab/sand)", length,
                float(columns.TIMES[-1]), scene.STEP, "hs", lambda n: square(n, length, sand=[{"file": "sand.npy"}], material={"friction": 0.5, "young_modulus": 2e5, "cohesion_dry": 0}),
                error, lambda n: {"sand.npy": shapes.draw({"nx": n, "ny": n, "dx": length / n}, shapes.disc(columns.HALF, columns.HALF * aspect))},
                {"sand_transport_order": 2})


def mound():
    exchange, start, end, length = 2e5, 1.0, 1.5, 16.0
    darcy = 1000 * exact.G / exchange  # [m/s]

    def depth(n, s):
        return np.maximum(0, s ** (-1 / 3) * (1 - (middles(n, length) - length / 2) ** 2 / (12 * s ** (2 / 3))))

    def level(n):  # of sand whose water all flows: retention and the laws on slopes are no part of the solution
        plain = square(n, length, sand=[{"shape": "plane", "height": 1.5}], water=[{"file": "water.npy"}],
                       material={"friction": 0.6, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0})
        return scene.override(plain, {key: value for key, value in scene.NEUTRAL.items() if key.startswith("material.")})

    return Case("A mound of water seeps through sand at rest", "water in sand", "Barenblatt 1952, exact", length, round(2 * (end - start) / darcy, 6), 0.15, "W", level,
                lambda now, dx, t: of_truth(now[now.shape[0] // 2], depth(now.shape[1], start + darcy * t / 2)), lambda n: {"water.npy": along_x(depth(n, start), n)})


CASES = {"bore": bore(), "bowl": bowl(), "column": column(), "mound": mound()}
