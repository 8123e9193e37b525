#!/usr/bin/env python3
"""What effects, guards, choices of method and parts of the water's laws cost: runs with a setting and without in turn, so that what else the machine
does falls on both; the median of their ratios. Writes README.md and prices.csv.

usage: tests/lab/report/prices.py BIN_FOLDER [--quick] [--backend cpu] [--rounds 3] [--relaxed BIN_FOLDER] [--out out/prices]
"""
import argparse
import csv
import math
import pathlib
import statistics
import sys
import time

import recordings
import stamps
from sand_scenes import AS_EQUATIONS

SIZES = {True: (128, 0.1), False: (1024, 0.25)}  # quick or full: cells along x, seconds of stepping in a run
CHOICES = {  # what `method` is changed by
    "second_order": {"water_transport_order": 2},
    "second_order_sand": {"water_transport_order": 2, "sand_transport_order": 2},
}
GUARDS = {
    "no_limiter": {"outflow_limiter": False},
    "no_quantum": {"quantum": 0},
    "no_gravity_caps": {"gravity_cap": 0, "sand_gravity_cap": 0},
    "no_elastic_cap": {"elastic_cap": 0},
    "no_rest_rule": {"rest_rule": False},
    "no_shock_viscosity": {"shock_viscosity": 0},
    "no_passive_pressure": {"passive_pressure": 0},
    "no_smoothing": {"saturation_smoothing": 0},
}
EFFECTS = ("elastoplastic", "cohesion", "drag", "diffusion", "mixture")
NEEDED_BY = {"elastoplastic": "cohesion", "mixture": "diffusion"}  # what needs an effect goes with it

LEDGER_LEVEL, LEDGER_PASSES = "spring", ("account_sides",)  # open sides and a source; the passes that nothing but the ledger needs
LEDGER_STEPS = 100
WATER_LEVEL = "beach"  # what parts of the water's laws are priced on: without those it has of them, with its sand and without
MANNING = {"material": {"manning": 0.03}}
WATER_LAWS = {  # part of the laws: what the level is changed by
    "outflow on all sides": {"sides": {side: {"kind": "outflow"} for side in ("west", "east", "south", "north")}},
    "level on all sides": {"sides": {side: {"kind": "level", "value": 1.05} for side in ("west", "east", "south", "north")}},
    "Manning's law": MANNING,
    "Manning's law and a roughness map": {**MANNING, "roughness": [{"shape": "box", "from": [0, 0], "to": [16, 26], "manning": 0.06}]},
    "shock viscosity": {"method": {"shock_viscosity": 0.25}},
    "second order": {"method": {"water_transport_order": 2}},
}
FUSED = ("always", "never")  # of a level's `fused_stages`; "everything" has auto
WALL_SECONDS = 2


def wall(n):
    """The level on which effects, guards and choices are priced: a wave meets a wall of damp sand and a dry heap, on n x n/2 cells."""
    return {"format_version": 1, "name": "A wave meets a wall of damp sand and a dry heap", "grid": {"nx": n, "ny": n // 2, "dx": 12.8 / n}, "dt": 0.08 * 12.8 / n,
            "sand": [{"shape": "box", "from": [5, 1], "to": [6.2, 3.6], "height": 0.9, "side_slope": 3}, {"shape": "cone", "center": [8.5, 4.4], "radius": 1.6, "height": 0.7}],
            "water": [{"shape": "box", "from": [0, 0], "to": [3, 6.4], "height": 1}, {"shape": "box", "from": [4.6, 0.6], "to": [6.6, 4], "wet": 0.22}],
            "material": {"friction": 0.5, "young_modulus": 1.5e5, "cohesion_wet": 3.4e3, "cohesion_capillary": 3.4e3, "cohesion_dry": 85, "exchange_rate": 2e4, "diffusion_rate": 0.01,
                         **AS_EQUATIONS},
            "method": {"prestress": False}}


class Price:
    """ratio: time of a step over the base's, median of `rounds`; low and high: its quartiles; base_ms: of a step, median; summary: of the
    last run."""

    def __init__(self, ratios, base_ms, summary):
        self.rounds = len(ratios)
        self.low, self.ratio, self.high = quartiles(ratios)
        self.base_ms, self.summary = base_ms, summary


def quartiles(values):
    """Lower quartile, median, upper quartile."""
    return statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3


def paired(base, variants, rounds, until=math.inf):
    """{name: Price} of `variants`, {name: function that runs and gives the summary}, over `base`, a function of the same kind. Base and
    variant run one after the other, in either order by turns. No round but the first begins after `until`, in seconds of time.monotonic()."""
    ratios, bases, last = {name: [] for name in variants}, [], {}
    for count in range(rounds):
        if count > 0 and time.monotonic() > until:
            break
        for name, variant in variants.items():
            pair = (base, variant) if count % 2 == 0 else (variant, base)
            runs = [run() for run in pair]
            one, other = runs if count % 2 == 0 else reversed(runs)
            bases.append(one["ms_per_step"])
            ratios[name].append(other["ms_per_step"] / one["ms_per_step"])
            last[name] = other
    return {name: Price(ratios[name], statistics.median(bases), last[name]) for name in variants}


def ledger_share(recorder, n, seconds, rounds):
    """Shares [%] of the ledger's own passes in the time of all stages, of a level with open sides and a source on n x n cells; by round."""
    shares = []
    for _ in range(rounds):
        _, summary = recorder.record(LEDGER_LEVEL, size=(n, n), seconds=seconds, profile=True, benchmark=True)
        stages = {stage["name"]: stage["ms"] for stage in summary["stages"]}
        shares.append(100 * math.fsum(stages[name] for name in LEDGER_PASSES) / math.fsum(stages.values()))
    return shares


def water_prices(recorder, n, rounds, run_seconds, until):
    """Rows of what each part of the water's laws costs, on n x n cells; `costs` is a share [%] of a step without it."""
    whole = recordings.read_level(WATER_LEVEL)
    bare = recordings.merged({key: value for key, value in whole.items() if key not in ("sides", "edits")},
                             {"material": {"bed_friction": 0}, "method": {"shock_viscosity": 0}})
    rows = []
    for kept, level in (("all effects", bare), ("water alone", {key: value for key, value in bare.items() if key != "sand"})):
        dt = level["dt"] * level["grid"]["nx"] / n

        def run(changes, steps, level=level, dt=dt):
            return recorder.record(recordings.merged(level, changes), size=(n, n), seconds=steps * dt, benchmark=True)[1]

        steps = max(20, min(round(1000 * run_seconds / run({}, 20)["ms_per_step"]), int(level["duration"] / dt)))
        for part, price in paired(lambda: run({}, steps), {part: lambda changes=changes: run(changes, steps) for part, changes in WATER_LAWS.items()}, rounds, until).items():
            rows.append({"point": f"price: {part}, {kept}", "n": n, "rounds": price.rounds, "steps": steps, "ms_per_step": price.base_ms, "costs": 100 * (price.ratio - 1),
                         "costs_low": 100 * (price.low - 1), "costs_high": 100 * (price.high - 1)})
    return rows


def forced_off(effect):
    """A level's `effects` without this one."""
    return {name: "off" for name in (effect, NEEDED_BY.get(effect)) if name}


def price_list(recorder, relaxed, n, rounds, run_seconds, until):
    """Rows of what each effect and each guard costs on `wall` with n cells along x. A run steps for about `run_seconds`, at most its time.
    relaxed: a recorder built without strict floats, or None."""
    level = wall(n)

    def run(changed, by=recorder, **options):
        return by.record(changed, seconds=seconds, benchmark=True, **options)[1]

    seconds = 20 * level["dt"]
    first = run(level)
    seconds = min(max(seconds, 1000 * run_seconds / first["ms_per_step"] * level["dt"]), WALL_SECONDS)
    variants = {f"effect {off} off": lambda off=off: run({**level, "effects": forced_off(off)}) for off in EFFECTS}
    for name, changes in {**CHOICES, **GUARDS}.items():
        variants[name] = lambda changes=changes: run(recordings.choose(level, **changes))
    for fused in FUSED:
        variants[f"fused stages: {fused}"] = lambda fused=fused: run({**level, "fused_stages": fused})
    variants["timestamps of every stage"] = lambda: run(level, profile=True)
    if relaxed:
        variants["strict floats off"] = lambda: run(level, relaxed)
    prices = paired(lambda: run(level), variants, rounds, until)
    rounds = next(iter(prices.values())).rounds
    base = next(iter(prices.values())).base_ms
    rows = [{"point": "price: everything", "n": n, "rounds": rounds, "steps": round(seconds / level["dt"]), "ms_per_step": base, "passes": first["passes"]["per_step"],
             "bytes_per_cell": first["bytes_per_cell"], "backend": first["device"]["backend"], "device": first["device"]["name"]}]
    for what, price in prices.items():
        rows.append({"point": f"price: {what}", "n": n, "rounds": rounds, "steps": rows[0]["steps"], "ms_per_step": base * price.ratio, "saved": 100 * (1 - price.ratio),
                     "saved_low": 100 * (1 - price.high), "saved_high": 100 * (1 - price.low), "passes": price.summary["passes"]["per_step"],
                     "bytes_per_cell": price.summary["bytes_per_cell"]})
    own = recordings.read_level(LEDGER_LEVEL)
    low, share, high = quartiles(ledger_share(recorder, n, min(LEDGER_STEPS * own["dt"] * own["grid"]["nx"] / n, own["duration"]), rounds))
    rows.append({"point": "price: ledger", "n": n, "rounds": rounds, "steps": LEDGER_STEPS, "saved": share, "saved_low": low, "saved_high": high})
    return rows


def share(row, kind="saved"):
    """Median and quartiles [%]."""
    return f"{row[kind]:.1f} ({row[kind + '_low']:.1f} to {row[kind + '_high']:.1f})"


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|", *("| " + " | ".join(row) + " |" for row in rows), ""]


def page(rows, processor_time):
    laws, rows = [row for row in rows if "costs" in row], [row for row in rows if "costs" not in row]
    base, named = rows[0], [(row["point"].removeprefix("price: "), row) for row in rows]
    ms = lambda row: f"{row['ms_per_step']:.4g}" if "ms_per_step" in row else ""
    apart = lambda what: what in CHOICES or what.startswith("fused")
    return "\n".join([
        "# What effects, guards and choices cost", "",
        f"On {base['backend']}: {base['device']}; time of stepping alone{', processor time of one thread' if processor_time else ''}.", "",
        "## What effects cost", "",
        f"Scene wall (`prices.py`) on {base['n']} cells along x: ms per step, passes per step and bytes per cell. Saved: median and quartiles of {base['rounds']} pairs of runs, one with it and "
        f"one without, in turn, {base['steps']} steps each. What leaving an effect out changes is in effects/README.md of tests/lab/report.", "",
        *table(["", "ms per step", "saved [%]", "passes", "bytes per cell"],
               [[what, ms(row), share(row) if "saved" in row else "", str(row["passes"]), f"{row['bytes_per_cell']:.0f}"]
                for what, row in named if what == "everything" or what.startswith("effect")]),
        "## What safety costs", "",
        "One guard off at a time (negative: it costs more without), measured as above. "
        f"The ledger has no off: its row is the share of the passes that only it needs ({', '.join(LEDGER_PASSES)}) in the time of all, of level {LEDGER_LEVEL}, which has open sides and a source, on "
        "as many cells along a side; what no_quantum saves is its rounding. Strict floats: a second build without them; where there is none, tests/lab/results has 6 to 16 % of a step on an H100.", "",
        *table(["off", "ms per step", "saved [%]"],
               [["everything on", ms(base), ""], *([what, ms(row), share(row)] for what, row in named[1:] if not apart(what) and not what.startswith("effect"))]),
        "## What choices of method and of fused stages cost", "",
        *table(["choice", "ms per step", "saved [%]", "passes"], [[what, ms(row), share(row), str(row["passes"])] for what, row in named if apart(what)]),
        "## What parts of the water's laws cost", "",
        f"Level {WATER_LEVEL} on {laws[0]['n']} x {laws[0]['n']} cells with walls, without bed friction, shock viscosity and edits, as it is and without its sand; costs: of one part put in, in percent of a "
        f"step without it, median and quartiles of {laws[0]['rounds']} pairs of runs in turn. With sand, level sides let ground water through.", "",
        *table(["part", "ms per step without", "costs [%]"], [[row["point"].removeprefix("price: "), ms(row), share(row, "costs")] for row in laws]),
        stamps.stamp("prices"), ""])


def main():
    begun = time.monotonic()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="128 cells along x instead of 1024: for a CPU")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the CPU backend (default 0: all cores)")
    parser.add_argument("--processor-time", action="store_true", help="times are processor time of one thread: for a busy machine, CPU backend alone")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="pairs of runs per line (default 3); more on a busy machine")
    parser.add_argument("--relaxed", type=pathlib.Path, metavar="BIN", help="programs of a build with -DWADI_STRICT_FLOAT=OFF, to price strict floats by")
    parser.add_argument("--minutes", type=float, default=math.inf, help="no further round begins after that")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/prices"))
    options = parser.parse_args()
    if options.processor_time and options.backend != "cpu":
        parser.error("--processor-time: of the CPU backend alone")
    threads = 1 if options.processor_time else options.threads
    relaxed = options.relaxed and recordings.Recorder(options.relaxed / "wadi-recorder", options.backend, threads, options.processor_time)
    n, seconds = SIZES[options.quick]
    until = begun + 60 * options.minutes
    with recordings.Recorder(options.programs / "wadi-recorder", options.backend, threads, options.processor_time) as recorder:
        rows = price_list(recorder, relaxed, n, options.rounds, seconds, until) + water_prices(recorder, n, options.rounds, seconds, until)
    options.out.mkdir(parents=True, exist_ok=True)
    with (options.out / "prices.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ["point", "n", "rounds", "steps", "ms_per_step", "saved", "saved_low", "saved_high", "costs", "costs_low", "costs_high", "passes", "bytes_per_cell"], extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    (options.out / "README.md").write_text(page(rows, options.processor_time))
    print(options.out / "README.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
