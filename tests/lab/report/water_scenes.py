"""Water whose right answer is a formula."""
import math

import cases
import exact
from scene import G, Scene, base, middle_row, norms


def exact_dam_break(key, title, right):
    def make(n):
        level, _, _ = cases.dam_break(right, n)
        level.pop("dt")
        return level

    def measure(run, summary, level):
        dx, depth, t = run.dx, middle_row(run, "W", 3), summary["simulated_seconds"]
        truth = [exact.stoker((i + 0.5) * dx, t, 1, right, 25) if right else exact.ritter((i + 0.5) * dx, t, 1, 25) for i in range(run.nx)]
        level_of_front = 0.5 * (right + exact.stoker_middle(1, right)[0]) if right else 0.05
        front = max(i + 1 for i in range(run.nx) if depth[i] > level_of_front) * dx - 25
        true_front = exact.stoker_middle(1, right)[2] * t if right else exact.ritter_front(t, 1, 25, 0.05) - 25
        return [*norms(depth, truth, 1), ("front has run", "m", front, true_front)]

    return Scene(key, "water", title, 400, 3, make, measure, step=lambda dx: 0.04 * dx)


def thacker():
    h0, a, r0, size = 0.1, 1.0, 0.8, 4.0
    big = (a * a - r0 * r0) / (a * a + r0 * r0)
    period = 2 * math.pi / (math.sqrt(8 * G * h0) / a)

    def depth(x, y, t):
        rr = ((x - size / 2) ** 2 + (y - size / 2) ** 2) / (a * a)
        q = 1 - big * math.cos(2 * math.pi * t / period)
        return max(0.0, h0 * (math.sqrt(1 - big * big) / q - 1 - rr * ((1 - big * big) / (q * q) - 1)) + h0 * (1 - rr))

    def bed(x, y):
        return -h0 * (1 - ((x - size / 2) ** 2 + (y - size / 2) ** 2) / (a * a))

    def make(n):
        return base("Thacker's bowl", n, n, size / n, terrain=[{"file": "bed.npy"}], water=[{"file": "water.npy"}])

    def files(n):
        dx = size / n
        centres = [((i + 0.5) * dx, (j + 0.5) * dx) for j in range(n) for i in range(n)]
        return {"bed.npy": (n, n, [bed(x, y) for x, y in centres]), "water.npy": (n, n, [depth(x, y, 0) for x, y in centres])}

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        now, middle = run.field("W", period), (run.ny // 2) * run.nx + run.nx // 2
        truth = [depth(x, y, t) for _, x, y in run.cells()]
        return [*norms(now, truth),
                ("amplitude kept after a period", "%", 100 * (now[middle] - h0) / (truth[middle] - h0), 100)]

    return Scene("thacker", "water", "Thacker's radial bowl, one period", 96, period, make, measure, step=lambda dx: 0.1 * dx, fields=("W",),
                 files=files)


def smooth_wave():
    length, seconds = 60.0, 2

    def make(n):
        dx = length / n
        cells = [{"of": "water", "shape": "box", "from": [i * dx, 0], "to": [(i + 1) * dx, 3 * dx],
                  "velocity": [2 * (math.sqrt(G * exact.simple_wave((i + 0.5) * dx, 0)) - math.sqrt(G)), 0]} for i in range(n) if abs((i + 0.5) * dx - 20) < 16]
        return base("Smooth wave", n, 3, dx, water=[{"file": "water.npy"}], velocities=cells)

    def files(n):
        return {"water.npy": (n, 3, [exact.simple_wave((i + 0.5) * length / n, 0) for i in range(n)] * 3)}

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        now, truth = middle_row(run, "W", seconds), [exact.simple_wave((i + 0.5) * run.dx, t) for i in range(run.nx)]
        return [*norms(now, truth, 0.3), ("crest", "m", max(now), 1.3)]  # of the wave's height

    return Scene("wave", "water", "Smooth wave, 0.3 m high on 1 m of water, in percent of its height", 480, seconds, make, measure,
                 step=lambda dx: 0.04 * dx, fields=("W",), files=files)


def planar_bowl():
    bowl = exact.PlanarBowl

    def make(n):
        return base("Planar bowl", n, 3, bowl.length / n, terrain=[{"file": "bed.npy"}], water=[{"file": "water.npy"}])

    def files(n):
        dx = bowl.length / n
        return {"bed.npy": (n, 3, [bowl.bed((i + 0.5) * dx) for i in range(n)] * 3), "water.npy": (n, 3, [bowl.depth((i + 0.5) * dx, 0) for i in range(n)] * 3)}

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        now, truth = middle_row(run, "W", bowl.period), [bowl.depth((i + 0.5) * run.dx, t) for i in range(run.nx)]
        places = [(i + 0.5) * run.dx for i in range(run.nx) if truth[i] > 0.1 * bowl.h0]
        surface = [bowl.bed((i + 0.5) * run.dx) + now[i] for i in range(run.nx) if truth[i] > 0.1 * bowl.h0]
        x0, s0 = math.fsum(places) / len(places), math.fsum(surface) / len(surface)
        tilt = math.fsum((x - x0) * (s - s0) for x, s in zip(places, surface)) / math.fsum((x - x0) ** 2 for x in places)
        bent = max(abs(s - s0 - tilt * (x - x0)) for x, s in zip(places, surface))
        return [*norms(now, truth), ("tilt kept after a period", "%", 100 * tilt / bowl.tilt(t), 100), ("surface bent by at most, of the depth", "%", 100 * bent / bowl.h0, 0)]

    return Scene("planar", "water", "Plane surface tilting in a parabolic valley (Thacker), one period", 200, bowl.period, make, measure,
                 step=lambda dx: 0.04 * dx, fields=("W",), files=files)


def over_bump(key, title, q, right, through_critical, seconds):
    """Steady flow of q [m2/s] over a bump, `right` deep downstream (None: free outflow), which starts from still water as deep, or from a
    lake before the crest: an open end keeps a slow stream as deep as it finds it."""
    length = 25.0
    start = {"shape": "box", "from": [0, 0], "to": [exact.BUMP_AT, length], "surface": 0.66} if right is None else {"shape": "plane", "surface": right}

    def make(n):
        dx = length / n
        east = {"kind": "outflow"} if right is None else {"kind": "waves", "value": right}
        return base(title, n, 3, dx, terrain=[{"file": "bed.npy"}], water=[start],
                    sides={"west": {"kind": "discharge", "value": q * 3 * dx}, "east": east})

    def files(n):
        return {"bed.npy": (n, 3, [exact.bump((i + 0.5) * length / n) for i in range(n)] * 3)}

    def measure(run, summary, level):
        truth = [exact.steady_over_bump((i + 0.5) * run.dx, q, right, through_critical) for i in range(run.nx)]
        result = norms(middle_row(run, "W", seconds), truth)
        if right is not None and through_critical:
            now = middle_row(run, "W", seconds)
            behind = [i for i in range(run.nx - 1) if (i + 0.5) * run.dx > exact.BUMP_AT + 0.5]
            steepest = max(behind, key=lambda i: now[i + 1] - now[i])
            above = exact.BUMP_CREST + 1.5 * (q * q / G) ** (1 / 3)
            result.append(("jump stands at", "m", (steepest + 1) * run.dx, exact.jump_behind_bump(q, right, above)))
        return result

    return Scene(key, "water", title, 100, seconds, make, measure, step=lambda dx: 0.04 * dx, fields=("W",), files=files)


def all_scenes():
    return [exact_dam_break("stoker", cases.EXACT["stoker"][0], 0.2), exact_dam_break("ritter", cases.EXACT["ritter"][0], 0), smooth_wave(),
            thacker(), planar_bowl(), over_bump("bump", "Steady subcritical flow over a bump, after 400 s", 4.42, 2.0, False, 400),
            over_bump("transcritical", "Steady flow that turns fast over a bump, after 100 s", 1.53, None, True, 100),
            over_bump("jump", "Steady flow over a bump with a jump behind it, after 200 s", 0.18, 0.33, True, 200)]
