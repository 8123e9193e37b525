"""The dams of level `seepage`: in what order water comes through, and when."""
from scene import override
from cases import case
from shipped import shipped
from table import Row, shown


@case("seepage", dx=(0.4,))
def seepage(lab, dx):
    """The better a dam drains and the less it rubs, the sooner water is beyond it."""
    times, beyond = (0, 5, 10, 20, 40, 70), 17
    variants = ("low", "medium", "high")
    scenes = [override(shipped("seepage", dx, name), {"dt": 0.015}) for name in variants]
    runs = lab.runs([(one, times, ("hs", "W")) for one in scenes])
    rows, water, crests = [], {}, {}
    for name, run in zip(variants, runs):
        part = slice(0, round(beyond / dx))
        water[name] = [run.field("W", time)[:, part].sum() * dx**2 for time in times]
        top = [run.field("hs", time)[:, part.stop :].max(axis=1).min() for time in times]
        crests[name] = [height / top[0] for height in top]
        rows += [shown(f"water beyond the dam, {name}, {time} s", volume, "m3") for time, volume in zip(times[1:], water[name][1:])]
        rows += [shown(f"lowest crest / drawn, {name}, {time} s", crests[name][times.index(time)]) for time in (20, 40, 70)]
    return rows
