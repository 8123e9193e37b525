#!/usr/bin/env python3
"""The paper's own method beside ours: cases with known answers, the supplement's half turn, and the claims of the shipped levels, by
`robust` and `published`. Writes tables and pictures into tests/lab/report/methods (README.md there: between its two marks).

usage: tests/lab/report/side_by_side.py BIN_FOLDER [--backend cpu] [--small] [--only NAME ...] [--out DIR | --check]
BIN_FOLDER holds wadi-recorder and conformance. --small: the levels' test sizes. --check: small cases, no files, fails where the
method that should be wrong is right or the other way round.
"""
import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

import cases
import charts
import exact
import recordings
import stamps
from recordings import LEVELS

import check_claims  # beside measures: recordings put it on the path

METHODS = ("robust", "published")
BED_LOAD = ("seepage", "low", (64, 32), 30)  # level, variant, cells, end [s]
LEVELS_WITH_PICTURES = ("castle", "letters", "piles", "spring", "seepage", "canyon", "dam_break")
SHOWN_LEVELS = (*LEVELS_WITH_PICTURES, "flush", "beach", "wadi")
BEGIN, END = "<!-- side_by_side.py writes from here -->\n", "<!-- to here -->\n"


def number(value):
    return "0" if value == 0 else f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def at_once(function, items):
    """[function(item)], one run on each core."""
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return list(pool.map(function, items))


def exact_rows(recorder, small):
    """(case, measure, unit, right answer, {method: value}); a run that the recorder calls broken gives its message instead."""
    made = {key: make(cases.SMALL[key]) if small else make() for key, (_, make) in cases.EXACT.items()}

    def values_of(case):
        key, method = case
        level, seconds, measure = made[key]
        run, summary = recorder.record(recordings.choose(level, name=method), seconds=seconds, times=(0, seconds))
        print(f"{cases.EXACT[key][0]}: {method}", flush=True)
        return measure(run, summary)

    runs = list(itertools.product(made, METHODS))
    columns = dict(zip(runs, at_once(values_of, runs)))
    for key in made:
        for n, (name, unit, _, right) in enumerate(columns[key, "robust"]):
            yield cases.EXACT[key][0], name, unit, right, {method: columns[key, method][n][2] for method in METHODS}


def half_turns(conformance, backend):
    """{strain: {degrees: area}} as the stages compute it."""
    areas = {}
    for strain in ("polar", "direct", "left_stretch"):
        done = subprocess.run([str(conformance), "test", "--backend", backend, "--case", f"half_turn(strain={strain})"], capture_output=True,
                              text=True, check=True)
        areas[strain] = {float(a): float(b) for a, b in re.findall(r"(\d+):(\d+\.\d+)", done.stdout)}
    return areas


def profiles(recorder, out):
    """ritter.svg and stoker.svg: depth along the channel, exact and by both methods."""
    for name, right in (("ritter", 0), ("stoker", 0.2)):
        n = 400
        level, seconds, _ = cases.dam_break(right, n)
        places = [(i + 0.5) * level["grid"]["dx"] for i in range(n)]
        truth = [exact.stoker(x, seconds, 1, right, 25) if right else exact.ritter(x, seconds, 1, 25) for x in places]
        series = [("exact", list(zip(places, truth)), "line")]
        for method in METHODS:
            run, _ = recorder.record(recordings.choose(level, name=method), seconds=seconds, times=(seconds,))
            series.append((method, list(zip(places, run.field("W", seconds)[n:2 * n])), "line"))
        title = f"{cases.EXACT[name][0]}, {seconds} s, {n} cells"
        (out / f"{name}.svg").write_text(charts.line_chart(title, "x [m]", "depth [m]", series))


def shown(name, method, variant=None):
    """What a recorder runs of a shipped level, and how. Bed load is ours, and without the outflow limiter nothing bounds it: published goes
    without."""
    if method != "published":
        return {"level": name, "method": method, "variant": variant}
    level = recordings.read_level(name)
    level = recordings.merged(level, level.get("variants", {}).get(variant, {}))
    return {"level": recordings.merged(level, {"effects": {"bed_shear": "off"}}), "method": method}


def claims_of(recorder, name, method, small):
    """[(sentence, value, unit, bound as text, holds)] of a level under a method, and its largest values."""
    expected = json.loads((LEVELS / name / "expected.json").read_text())
    runs, worst = {}, {}
    for run_name, run in expected["runs"].items():
        options = {**(expected["small"] if small else {}), **run}
        options |= shown(name, method, options.pop("variant", None))
        seconds = options.pop("seconds", max(expected["times"]))
        runs[run_name], summary = recorder.record(seconds=seconds, times=expected["times"], fields=("H", "hs", "W", "hw", "surface", "phi"), **options)
        for what, value in (("water", summary["extremes"]["largest_water_speed_m_per_s"]), ("sand", summary["extremes"]["largest_sand_speed_m_per_s"]),
                            ("drift", max(abs(entry["relative_drift"]) if entry["drift_quanta"] else 0
                                          for entry in (summary["ledger"][m] for m in ("water", "sand")))),
                            ("not finite", summary["counts"]["not_finite"]["largest"])):
            worst[what] = max(worst.get(what, 0), value)
    results = []
    for claim in expected["claims"]:
        bound = next(key for key in check_claims.BOUNDS if key in claim)
        value = check_claims.evaluate(claim["value"], runs, claim["says"])
        results.append((claim["says"], value, claim.get("unit", ""), f"{bound} {claim[bound]:g}", check_claims.BOUNDS[bound](value, claim[bound])))
    return results, worst


def picture(recorder, name, method, small, out):
    expected = json.loads((LEVELS / name / "expected.json").read_text())
    options = dict(expected["small"]) if small else {}
    options.pop("seconds", None)
    run, _ = recorder.record(**shown(name, method), seconds=max(expected["times"]), pictures=3, **options)
    shutil.copy(run.folder / "contact_sheet.jpg", out / f"{name}_{method}.jpg")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|"]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def write_page(recorder, conformance, options):
    out = options.out
    out.mkdir(parents=True, exist_ok=True)
    lines = []
    if not options.only:
        rows = list(exact_rows(recorder, options.small))
        with (out / "exact.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["case", "measure", "unit", "right", *METHODS])
            writer.writerows([case, name, unit, right, *values.values()] for case, name, unit, right, values in rows)
        lines += ["## Cases with a known answer", ""]
        lines += table(["case", "measure", "right", *METHODS],
                       [[case, f"{name} [{unit}]", number(right), *map(number, values.values())] for case, name, unit, right, values in rows])
        profiles(recorder, out)
        lines += ["", "![Ritter](ritter.svg)", "", "![Stoker](stoker.svg)"]
        areas = half_turns(conformance, recorder.backend)
        degrees = sorted(areas["polar"])
        lines += ["", "## Half way between a strained body and itself turned", "", "Area over the area of both ends; what a stage on the device gave, one column per angle [degrees].", ""]
        lines += table(["kept and moved", *(f"{d:g}" for d in degrees)],
                       [[title, *(f"{areas[strain][d]:.3f}" for d in degrees)]
                        for title, strain in (("angle and stretch apart (`polar`, the paper's)", "polar"), ("F as it is (`direct`)", "direct"),
                                              ("left stretch (robust)", "left_stretch"))])
        lines += [""]
    lines += ["## Levels", "", "What `expected.json` beside each level claims, by each method; bold where it does not hold.", ""]

    def side_of(run):
        name, method = run
        claims = claims_of(recorder, name, method, options.small)
        if name in LEVELS_WITH_PICTURES:
            picture(recorder, name, method, options.small, out)
        print(f"{name}: {method}, {sum(holds for *_, holds in claims[0])} of {len(claims[0])} claims", flush=True)
        return claims

    names = [name for name in SHOWN_LEVELS if not options.only or name in options.only]
    runs = list(itertools.product(names, METHODS))
    results = dict(zip(runs, at_once(side_of, runs)))
    for name in names:
        sides = {method: results[name, method] for method in METHODS}
        lines += [f"### {name}", ""]
        rows = []
        for claim in zip(*(sides[method][0] for method in METHODS)):
            cells = [number(value) if holds else f"**{number(value)}**" for _, value, _, _, holds in claim]
            says, _, unit, wanted, _ = claim[0]
            rows.append([says, f"{wanted} {unit}".strip(), *cells])
        lines += table(["claim", "wanted", *METHODS], rows)
        lines += ["", "; ".join(f"{method}: water up to {number(w['water'])} m/s, sand up to {number(w['sand'])} m/s, mass drifts by {number(w['drift'])}"
                                + (f", {w['not finite']} values not finite" if w["not finite"] else "")
                                for method, (_, w) in sides.items()) + ".", ""]
        if name in LEVELS_WITH_PICTURES:
            lines += table(METHODS, [[f"![{name}, {method}]({name}_{method}.jpg)" for method in METHODS]]) + [""]
    lines += [stamps.stamp("methods"), ""]
    page = out / "README.md"
    text = page.read_text() if page.exists() else f"# Methods\n\n{BEGIN}{END}"
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    page.write_text(text[:start] + "\n".join(lines) + text[end:])


def finite(recorder, bed_load):
    """Whether a run by published ends in numbers."""
    name, variant, cells, seconds = BED_LOAD
    level = recordings.read_level(name)
    level = recordings.merged(level, level["variants"][variant])
    if not bed_load:
        level = recordings.merged(level, {"effects": {"bed_shear": "off"}})
    run, _ = recorder.record(recordings.choose(level, name="published"), size=cells, seconds=seconds, times=(seconds,), fields=("hs", "W"))
    return all(math.isfinite(value) for field in ("hs", "W") for value in run.field(field, seconds))


def check(recorder, conformance):
    """Each line: what must hold of robust and must not of published, or the other way round where the paper's choice is the better."""
    found = {(case, name): values for case, name, _, _, values in exact_rows(recorder, True)}
    lake, stoker, ritter = cases.EXACT["lake"][0], cases.EXACT["stoker"][0], cases.EXACT["ritter"][0]
    areas = half_turns(conformance, recorder.backend)
    turned = [(found[lake, "fastest water"], "a lake over sand rests", lambda v: v == 0),
              (found[ritter, "mean error of depth"], "a dam break on dry ground errs by less than 1 cm", lambda v: v < 0.01),
              (found[stoker, "mean error of depth"], "a bore errs by less than 1.2 cm", lambda v: v < 0.012)]
    good = True
    for values, says, holds in turned:
        fine = holds(values["robust"]) and not holds(values["published"])
        good &= fine
        print(f"{'OK  ' if fine else 'FAIL'} {says}: robust {number(values['robust'])}; published {number(values['published'])}")
    for strain, wanted in (("polar", True), ("left_stretch", True), ("direct", False)):
        kept = min(areas[strain].values()) > 0.98
        good &= kept == wanted
        print(f"{'OK  ' if kept == wanted else 'FAIL'} half turns keep their area with {strain}: least {min(areas[strain].values()):.3f}")
    for bed_load, wanted in ((False, True), (True, False)):
        ends = finite(recorder, bed_load)
        good &= ends == wanted
        print(f"{'OK  ' if ends == wanted else 'FAIL'} published, {'with' if bed_load else 'without'} bed load: {'finite' if ends else 'not finite'}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--only", nargs="*", default=[], choices=SHOWN_LEVELS)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "methods")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    conformance = options.programs / "conformance"
    with recordings.Recorder(options.programs / "wadi-recorder", options.backend, threads=1) as recorder:
        if options.check:
            return 0 if check(recorder, conformance) else 1
        write_page(recorder, conformance, options)
    return 0


if __name__ == "__main__":
    sys.exit(main())
