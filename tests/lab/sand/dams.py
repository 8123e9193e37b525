"""Dams of the shipped levels: in what order they fail, and when water is beyond them."""
import math

from cases import case
from scene import override
from shipped import shipped
from table import at_least, at_most, shown


def crest(run, time, box):
    """What water must rise to that comes from the north: over the columns of a box (west, east, south, north), the lowest of the highest
    ground [m]."""
    west, east, south, north = (round(side / run.dx) for side in box)
    return (run.field("H", time) + run.field("hs", time))[south:north, west:east].max(axis=0).min()


ALIKE = {"material.friction": 0.5, "material.exchange_rate": 1e4, "material.diffusion_rate": 0.01}


@case("seepage", dx=(0.4,), control=ALIKE)
def seepage(lab, dx):
    """The more freely water seeps through a dam and the less its sand rubs, the sooner it is cut."""
    times, beyond, names = (0, 5, 10, 20, 40, 70), 17, ("low", "medium", "high")
    # As on the level's own cells of 0.2 m: its time step serves these as well.
    runs = lab.runs([(override(shipped("seepage", dx, name), {"dt": 0.015}), times, ("hs", "W")) for name in names])
    rows, crests, column = [], {}, round(beyond / dx)
    for name, run in zip(names, runs):
        drawn = run.field("hs", 0)[:, column:].max(axis=1).min()
        for time in times[1:]:
            crests[name, time] = run.field("hs", time)[:, column:].max(axis=1).min() / drawn
            volume = run.field("W", time)[:, :column].sum() * dx**2
            rows.append(shown(f"{name}, {time} s: water beyond the dam", volume, "m3"))
            rows.append(shown(f"{name}, {time} s: lowest crest / drawn", crests[name, time]))
    for time, weaker, stronger in ((20, "low", "medium"), (40, "medium", "high")):
        rows.append(at_most(f"crest of {weaker} / of {stronger} at {time} s", crests[weaker, time] / crests[stronger, time], 0.8))
    return [*rows, at_most("crest of high at 70 s / drawn", crests["high", 70], 0.6)]


DAMS = {1: (20, 80, 91, 101), 2: (40, 84, 59, 69), 3: (20, 80, 27, 37)}  # boxes around them [m]


@case("canyon", dx=(1, 0.5), control={"sources": []}, quick=(1,))
def canyon(lab, dx):
    """The flood cuts three dams one after the other; cut: the crest has lost a third of 3.8 m somewhere."""
    times = tuple(range(0, 71, 2))
    run = lab.run(shipped("canyon", dx), times, ("H", "hs"))
    heights = {dam: [crest(run, time, box) for time in times] for dam, box in DAMS.items()}
    cut = {dam: next((time for time, now in zip(times, height) if now < height[0] - 3.8 / 3), math.inf) for dam, height in heights.items()}
    return [
        at_most("dam 1 is cut at", cut[1], 24, "s"),
        at_least("dam 2 later by", cut[2] - cut[1], 8, "s"),
        at_least("dam 3 later by", cut[3] - cut[2], 8, "s"),
        *(shown(f"dam {dam} loses", height[0] - height[-1], "m") for dam, height in heights.items()),
    ]
