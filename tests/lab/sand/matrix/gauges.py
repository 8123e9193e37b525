"""What is measured: slopes at rest, how hard soaked faces are loaded, cohesion that faces need, sliding, and critical values by bisection.
Heights are arrays [y, x] in metres."""
import math

import numpy as np

import laws
import shapes

FOOT = 0.02  # thinner sand is no slope [m]


def rises(heights):
    """Of every inner face along x: the rise across it, and along it the mean of both cells' rises to their neighbours, both per cell."""
    padded = np.pad(heights, ((1, 1), (0, 0)), mode="edge")
    beside = (padded[2:] - padded[:-2]) / 2
    return np.diff(heights, axis=1), (beside[:, 1:] + beside[:, :-1]) / 2


def along_both(measure, *fields):
    """measure(...) of the faces along x and along y, in one array."""
    return np.concatenate([measure(*fields), measure(*(field.T for field in fields))])


def face_slopes(ground, hs, dx, within=None):
    """Slopes of all faces whose higher cell has sand, of cells for which `within` is true. Bare rock must not rise above sand beside it."""
    def of_faces(surface, hs, within):
        across, along = rises(surface)
        high = np.where(across > 0, hs[:, 1:], hs[:, :-1])
        return np.hypot(across, along)[(high > FOOT) & within[:, 1:] & within[:, :-1]] / dx
    return along_both(of_faces, ground + hs, hs, np.ones(hs.shape, bool) if within is None else within)


def steepest(ground, hs, dx, within=None):
    return float(face_slopes(ground, hs, dx, within).max(initial=0))


def load(ground, hs, water, dx, friction, within=None):
    """Push over what friction bears, of the worst face: grains below the table weigh less by their buoyancy, on both sides, and the table's
    own slope pushes them besides. 1 on the point of sliding; steepest / friction where there is no water or it stands level."""
    ratio = laws.WATER / laws.DENSITY
    wet = np.divide(water, hs, out=np.zeros_like(hs), where=hs > 0)
    full = np.clip((wet - laws.RETENTION) / (1 - laws.RETENTION), 0, 1)
    table = ground + np.where(wet < 1, full * hs, water)

    def of_faces(surface, table, hs, full, within):
        (across, along), (down, beside) = rises(surface), rises(table)
        high = np.where(across > 0, hs[:, 1:], hs[:, :-1])
        both = hs[:, 1:] + hs[:, :-1]
        share = ratio * np.divide(hs[:, 1:] * full[:, 1:] + hs[:, :-1] * full[:, :-1], both, out=np.zeros_like(both), where=both > 0)
        soaked = share > 0
        push = np.hypot((1 - share) * across + np.where(soaked, share * down, 0), (1 - share) * along + np.where(soaked, share * beside, 0))
        return (push / (1 - share))[(high > FOOT) & within[:, 1:] & within[:, :-1]] / (dx * friction)
    within = np.ones(hs.shape, bool) if within is None else within
    return float(along_both(of_faces, ground + hs, table, hs, full, within).max(initial=0))


def needed_cohesion(surface, dx, friction, reach=1.5):
    """The most cohesion that Culmann's faces between any two cells need, along the axes and diagonals, up to `reach` apart [Pa]."""
    most = 0.0
    for step_y, step_x in ((0, 1), (1, 0), (1, 1), (1, -1)):
        for count in range(1, int(reach / (dx * math.hypot(step_y, step_x))) + 1):
            oy, ox = count * step_y, count * step_x
            rows, columns = surface.shape
            here = surface[: rows - oy, max(0, -ox) : columns - max(0, ox)]
            there = surface[oy:, max(0, ox) : columns + min(0, ox)]
            drop = float(np.nanmax(np.abs(there - here)))
            if drop > 0:
                most = max(most, laws.face_cohesion(drop, drop / (dx * math.hypot(oy, ox)), friction))
    return most


def speed(run, time):
    return max(float(np.abs(run.field(part, time)).max()) for part in ("us", "vs"))


def middle_speed(run, time, radius=1.0):
    """Mean speed of the sand around the middle."""
    near = np.hypot(*shapes.centres(run.grid)) < radius
    return float(np.hypot(run.field("us", time), run.field("vs", time))[near].mean())


def lost(before, after, dx):
    """Area of a strip, seen from its side, from which sand has gone."""
    return float(np.maximum(before - after, 0).mean(0).sum() * dx)


def critical(true_at, low, high, steps, middle=lambda a, b: (a + b) / 2):
    """Where true_at(value), false at small and true at large ones, becomes true; `low` or `high` where it does not between them."""
    if true_at(low):
        return low
    if not true_at(high):
        return high
    for _ in range(steps):
        value = middle(low, high)
        low, high = (low, value) if true_at(value) else (value, high)
    return middle(low, high)


def critical_share(stands, low=0.5, high=8.0, steps=7):
    """The least share of a law's cohesion with which something stands, by bisection of its logarithm."""
    return critical(stands, low, high, steps, lambda a, b: math.sqrt(a * b))
