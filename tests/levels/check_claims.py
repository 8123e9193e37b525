#!/usr/bin/env python3
"""Runs a level as its expected.json says and checks every claim, each with a control that must break it. README.md has the format.

usage: check_claims.py RECORDER LEVEL_FOLDER [--backend cpu] [--cells small|level|fine] [--keep DIR]
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import measures

BOUNDS = {"above": lambda value, bound: bound < value < math.inf, "below": lambda value, bound: -math.inf < value < bound}  # what never came is neither
CLAIM_KEYS = {"says", "value", "unit", "control", *BOUNDS}
RUN_KEYS = {"variant", "size", "dt", "seconds", "method"}


def fail(message):
    sys.exit(f"check_claims: {message}")


def record(recorder, level, name, run, times, backend, folder):
    """Runs one variant and returns its fields at all times."""
    command = [recorder, str(level), "--backend", backend, "--no-frames", "--out", str(folder), "--summary", str(folder / "summary.json")]
    for key in ("variant", "dt", "method", "accuracy"):
        if key in run:
            command += [f"--{key}", str(run[key])]
    if "size" in run:
        command += ["--size", "{}x{}".format(*run["size"])]
    dumped = ",".join(f"{time:g}" for time in times)
    command += ["--seconds", str(run.get("seconds", max(times))), "--dump", f"H,hs,W,hw,surface,phi@{dumped}"]
    folder.mkdir(parents=True)
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"run {name}: {' '.join(command)}\n{done.stdout}{done.stderr}")
    summary = json.loads((folder / "summary.json").read_text())
    if any(summary["ledger"][what]["drift_quanta"] != 0 for what in ("water", "sand")):
        fail(f"run {name}: the ledger drifts: {summary['ledger']}")
    grid = summary["grid"]
    print(f"run {name}: {grid['nx']} x {grid['ny']} cells of {grid['dx']:.4g} m, {summary['steps']} steps of {grid['dt']:.5g} s in "
          f"{summary['wall_seconds']:.1f} s, {summary['ms_per_step']:.3g} ms each, hash {summary['hash']}")
    return measures.Run(folder, grid["nx"], grid["ny"], grid["dx"], [float(f"{time:g}") for time in times])


def evaluate(text, runs, what):
    # All in the globals: what a lambda sees.
    names = {"__builtins__": {}, **runs, "Box": measures.Box, "min": min, "max": max, "abs": abs, "math": math, "inf": math.inf}
    try:
        return float(eval(text, names))
    except Exception as error:
        fail(f"{what}: {text}: {type(error).__name__}: {error}")


def check(claim, runs):
    """One line of text, and whether the claim holds and its control breaks it."""
    unknown = set(claim) - CLAIM_KEYS
    bounds = [key for key in BOUNDS if key in claim]
    if unknown or len(bounds) != 1 or not {"says", "value", "control"} <= set(claim):
        fail(f"claim {claim}: wants says, value, control, one of {sorted(BOUNDS)} and perhaps unit; unknown: {sorted(unknown)}")
    holds, bound = BOUNDS[bounds[0]], claim[bounds[0]]
    value = evaluate(claim["value"], runs, claim["says"])
    control = evaluate(claim["control"], runs, claim["says"])
    unit = " " + claim["unit"] if "unit" in claim else ""
    good = holds(value, bound) and not holds(control, bound)
    text = f"{claim['says']}: {value:.4g}{unit}, wanted {bounds[0]} {bound:g}{unit}; control {control:.4g}{unit}"
    return good, text + ("" if not holds(control, bound) else " BREAKS NOTHING")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder")
    parser.add_argument("level", type=pathlib.Path)
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--cells", choices=("small", "level", "fine"), default="small",
                        help="those that expected.json names for tests, the level's own, or its fine_grid, for which you want a GPU")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the fields, kept")
    options = parser.parse_args()
    expected = json.loads((options.level / "expected.json").read_text())
    unknown = set(expected) - {"small", "runs", "times", "claims"}
    if unknown:
        fail(f"{options.level}/expected.json: unknown keys {sorted(unknown)}")
    with tempfile.TemporaryDirectory() as scratch:
        runs = {}
        for name, run in expected["runs"].items():
            if set(run) - RUN_KEYS:
                fail(f"run {name}: unknown keys {sorted(set(run) - RUN_KEYS)}")
            small = expected["small"] if options.cells == "small" else {"accuracy": options.cells} if options.cells == "fine" else {}
            folder = (options.keep or pathlib.Path(scratch)) / name
            runs[name] = record(options.recorder, options.level, name, {**small, **run}, expected["times"], options.backend, folder)
        results = [check(claim, runs) for claim in expected["claims"]]
    for good, text in results:
        print(f"{'OK  ' if good else 'FAIL'} {text}")
    failed = sum(not good for good, _ in results)
    print(f"{len(results) - failed} of {len(results)} claims hold")
    return 1 if failed or not results else 0


if __name__ == "__main__":
    sys.exit(main())
