"""Cases whose right answer is known, each a level and what is measured of it. A measure is (name, unit, value, right answer or None)."""
import math

import exact


def lake_over_dune(n=96):
    """Still water 1 m deep over a drowned dune and round an island, 20 s: nothing may move."""
    dx = 24 / n
    level = {
        "format_version": 1, "name": "Lake over a dune", "grid": {"nx": n, "ny": n * 3 // 4, "dx": dx}, "dt": 0.1 * dx, "duration": 20,
        "terrain": [{"shape": "cone", "center": [18, 12], "radius": 4, "height": 1.6}],
        "sand": [{"shape": "cone", "center": [8, 9], "radius": 3.5, "height": 0.5}],
        "water": [{"shape": "plane", "surface": 1}],
        "material": {"friction": 0.6, "young_modulus": 0},
    }

    def measure(run, summary):
        surface, water, sand = run.field("surface", 20), run.field("W", 20), run.field("hs", 20)
        pure = [n for n, _, _ in run.cells() if water[n] - sand[n] > 0.01]
        return [("fastest water", "m/s", summary["extremes"]["largest_water_speed_m_per_s"], 0),
                ("surface off by at most", "m", max(abs(surface[n] - 1) for n in pure), 0),
                ("sand moved", "m3", run.moved(0, 20), 0)]

    return level, 20, measure


def static_pile(n=100):
    """A cone of dry sand at nine tenths of its friction slope, 10 s: nothing may move."""
    dx = 10 / n
    level = {
        "format_version": 1, "name": "Static pile", "grid": {"nx": n, "ny": n, "dx": dx}, "dt": 0.09 * dx, "duration": 10,
        "sand": [{"shape": "cone", "center": [5, 5], "radius": 3.6, "height": 1.62}],
        "material": {"friction": 0.5, "young_modulus": 2e5},
    }

    def measure(run, summary):
        before, after = run.field("hs", 0), run.field("hs", 10)
        return [("sand moved of all", "%", 100 * run.moved(0, 10) / run.volume("hs", 0), 0),
                ("a height changed by at most", "m", max(abs(a - b) for a, b in zip(before, after)), 0),
                ("fastest sand", "m/s", summary["extremes"]["largest_sand_speed_m_per_s"], 0)]

    return level, 10, measure


def dam_break(right, n):
    """1 m of water behind a dam in a channel of 50 m, `right` metres before it (0: dry ground), 3 s after the dam is gone."""
    dx, dam, t = 50 / n, 25, 3
    level = {
        "format_version": 1, "name": "Dam break", "grid": {"nx": n, "ny": 3, "dx": dx}, "dt": 0.04 * dx, "duration": t,
        "water": [{"shape": "plane", "height": right}, {"shape": "box", "from": [0, 0], "to": [dam, 3 * dx], "height": 1, "combine": "set"}],
    }
    if right == 0:
        level["water"] = level["water"][1:]

    def measure(run, summary):
        steps = round(t / level["dt"])
        reached = steps * level["dt"]  # a dump is made at the step nearest to its time
        depth = run.field("W", t)
        right_depth = [exact.stoker((i + 0.5) * dx, reached, 1, right, dam) if right else exact.ritter((i + 0.5) * dx, reached, 1, dam)
                       for i in range(n)]
        mean = math.fsum(abs(depth[n + i] - right_depth[i]) for i in range(n)) / n
        # Where the water is deeper than half way up the shock, or than 5 cm on dry ground.
        level_of_front = 0.5 * (right + exact.stoker_middle(1, right)[0]) if right else 0.05
        front = max(i + 1 for i in range(n) if depth[n + i] > level_of_front) * dx - dam
        if right:
            true_front = exact.stoker_middle(1, right)[2] * reached
        else:
            true_front = exact.ritter_front(reached, 1, dam, 0.05) - dam
        return [("mean error of depth", "m", mean, 0), ("front has run", "m", front, true_front)]

    return level, t, measure


EXACT = {
    "lake": ("Lake at rest over a drowned dune", lake_over_dune),
    "pile": ("Pile of dry sand below its friction slope", static_pile),
    "stoker": ("Stoker's dam break, 0.2 m of water ahead", lambda n=400: dam_break(0.2, n)),
    "ritter": ("Ritter's dam break on dry ground", lambda n=400: dam_break(0, n)),
}
SMALL = {"lake": 48, "pile": 50, "stoker": 200, "ritter": 200}
