"""What a setting costs: runs with it and without in turn, so that what else the machine does falls on both; the median of their ratios."""
import math
import statistics
import time

import recordings
import sweep

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
    """Rows of what each part of the water's laws costs, on n x n cells, as a report keeps them; `costs` is a share [%] of a step without it."""
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


def price_list(recorder, relaxed, scene, n, rounds, run_seconds, until):
    """Rows of what each effect and each guard costs on the scene with n cells along x, as a report keeps them. A run steps for about
    `run_seconds`, at most the scene's time. relaxed: a recorder built without strict floats, or None."""
    level = scene.make(n)
    level["dt"] = scene.step(level["grid"]["dx"])

    def run(changed, by=recorder, **options):
        return by.record(changed, seconds=seconds, benchmark=True, **options)[1]

    seconds = 20 * level["dt"]
    first = run(level)
    seconds = min(max(seconds, 1000 * run_seconds / first["ms_per_step"] * level["dt"]), scene.seconds)
    variants = {f"effect {off} off": lambda off=off: run({**level, "effects": sweep.forced_off(off)}) for off in sweep.EFFECTS}
    for choice in (*sweep.METHODS[1:], *sweep.GUARDS):
        variants[choice] = lambda choice=choice: run(recordings.choose(level, **sweep.CHOICES[choice]))
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
