"""Where method published breaks, and which of its choices starts it: each is put back by itself."""
import math

import pairs
import recordings

BACK = {  # a choice of published that paper_like does not make, and what that has instead
    "mixed_pressure": "in_substeps", "layer_exchange": "convex", "diffusion": "laplacian", "sand_substep": "own", "corner_shear": "least_depth",
    "strain_rim": "one_sided",
}
WITH_IT = {"mixed_pressure": ("layer_exchange",), "sand_substep": ("corner_shear", "strain_rim")}  # go only with it
JOINT = {**BACK, "drag_friction": "joint"}
CAPS = {"gravity_cap": 0.55, "gravity_cap_least": 0.15}  # robust's
CASES = (("dam_break", None, (96, 96), 7.5), ("letters", None, (160, 80), 7), ("seepage", "high", (128, 64), 40))  # level, variant, cells, end [s]
BED_LOAD = (("seepage", "medium", (64, 32), 90), ("seepage", "low", (64, 32), 90))


def rows():
    """(title, {choice of method: value})"""
    yield "published", {}
    for choice in BACK:
        back = (choice, *WITH_IT.get(choice, ()))
        yield f"without {', '.join(f'`{name}`' for name in back)}", {name: BACK[name] for name in back}
    yield "without any of the six", BACK


def chosen(name, variant, bed_shear, **choices):
    level = recordings.read_level(name)
    level = recordings.merged(level, level.get("variants", {}).get(variant, {}))
    return recordings.choose(level if bed_shear else recordings.merged(level, {"effects": {"bed_shear": "off"}}), **{"name": "published", **choices})


def speeds(recorder, case, choices, **options):
    """"faces at the clamp; deepest water [m]" at the end of a run, and its last picture."""
    name, variant, cells, seconds = case
    run, summary = recorder.record(chosen(name, variant, False, **choices), size=cells, seconds=seconds, times=(seconds,), pictures=2, **options)
    print(f"{name}, {choices}: {summary['counts']['clamped_faces']['last']}", flush=True)
    text = f"{summary['counts']['clamped_faces']['last']}; {summary['extremes']['largest_water_m']:.3g}"
    return text, pairs.map_of(run.folder / "frame_00001.png", run.nx, run.ny)


def breaks(recorder, case, choices, bed_shear=True):
    """"finite to the end" or since when it is not, and how much sand came from nowhere until then."""
    name, variant, cells, seconds = case
    run, _ = recorder.record(chosen(name, variant, bed_shear, **choices), size=cells, seconds=seconds, times=range(seconds + 1), fields=("hs", "W"))
    fine = [time for time in range(seconds + 1) if all(math.isfinite(value) for field in ("hs", "W") for value in run.field(field, time))]
    last = next((time for time in range(seconds) if time + 1 not in fine), seconds)
    gained = 100 * (run.volume("hs", last) / run.volume("hs", 0) - 1)
    print(f"{name} {variant}, {choices}: {last} s", flush=True)
    return f"{'all' if last == seconds else f'{last + 1} s'}; {'0' if abs(gained) < 1e-3 else f'{gained:.2g}'}"


def titled(cases):
    return [f"`{name}`{f', {variant}' if variant else ''}, {nx} x {ny}, {seconds} s" for name, variant, (nx, ny), seconds in cases]


def lines(recorder, out, table):
    """A section of the methods page, and literal.png beside it: level seepage, variant high, by published, then by joint drag."""
    ways = [*rows(), ("with `gravity_cap`", CAPS), ("without any of the six, and joint drag", JOINT)]
    found = [[speeds(recorder, case, choices) for case in CASES] for _, choices in ways]
    half = [speeds(recorder, case, {}, dt=recordings.read_level(case[0])["dt"] * recordings.read_level(case[0])["grid"]["nx"] / case[2][0] / 2)
            for case in CASES]
    pairs.write(out / "literal.png", found[0][-1][1], found[-1][-1][1])
    text = ["## Which choice breaks it", "", "`published` without Wadi's bed load: faces at the velocity clamp at the end; deepest water [m].", ""]
    text += table(["", *titled(CASES)], [[title, *(cell for cell, _ in cells)] for (title, _), cells in zip(ways, found)]
                  + [["published, half the time step", *(cell for cell, _ in half)]])
    text += ["", "![Level seepage, variant high, at the end: published; without any of the six and with joint drag](literal.png)", "",
             "`published` with Wadi's bed load: finite for; sand that came from nowhere until then [%].", ""]
    guarded = [*((title, choices, True) for title, choices in rows()), ("with the outflow limiter", {"outflow_limiter": True}, True), ("without bed load", {}, False)]
    text += table(["", *titled(BED_LOAD)], [[title, *(breaks(recorder, case, choices, bed) for case in BED_LOAD)] for title, choices, bed in guarded])
    return [*text, ""]
