#!/usr/bin/env python3
"""Holds wadi-tune to what the recorder then measures. Usage: judge.py BIN [LEVEL ...] [options]; needs numpy.

Levels are shipped ones, or with --drawn N --seed S N that drawn_levels.py draws, or both. For each level: tunes a copy of it, records the variant that was written (time: three whole recordings), and compares its surfaces
with those of a run that is finer than any the tuner made. Prints a table in Markdown; exit code 1 where a time is off by more than 15 %
from all three, or an error by more than a factor of 1.5, where more than a third of the errors are not told, or where a program fails."""
import argparse
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy

import drawn_levels

LEVELS = pathlib.Path(__file__).resolve().parents[1] / "levels"
JUDGED = ("beach", "canyon", "seepage", "piles")  # the model's constants are from dam_break and castle
KINDS = {"sand": "hs", "water": "surface"}  # fields
MOST_TIME, MOST_ERROR = 1.15, 1.5  # factors
MOST_UNTOLD = 1 / 3  # of the errors


def strip_comments(text):
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda match: match.group(1) or "", text, flags=re.S)


def averaged(field, shape):
    """Means over the cells of another grid of the same extent."""
    for axis, cells in enumerate(shape):
        edges = numpy.linspace(0, field.shape[axis], cells + 1)
        sums = numpy.concatenate([numpy.zeros_like(field.take([0], axis)), numpy.cumsum(field, axis)], axis)
        low = numpy.minimum(edges.astype(int), field.shape[axis] - 1)
        share = (edges - low).reshape([-1 if k == axis else 1 for k in range(2)])
        at = sums.take(low, axis) + share * (sums.take(low + 1, axis) - sums.take(low, axis))
        field = numpy.diff(at, axis=axis) / (field.shape[axis] / cells)
    return field


def record(recorder, level, variant, seconds, times, scratch, options):
    """(summary, {field: [at each time]}), between two steps where a time lies there."""
    folder = scratch / "out"
    command = [recorder, level, "--variant", variant, "--seconds", repr(seconds), "--no-frames", "--out", folder, "--summary", scratch / "summary.json", *options]
    dt = json.loads(strip_comments(level.read_text()))["variants"][variant]["dt"]
    steps = [(int(time / dt + 1e-6), time / dt - int(time / dt + 1e-6)) for time in times]
    asked = sorted({step + more for step, share in steps for more in ((0, 1) if share > 1e-3 else (0,))})
    if times:
        command += ["--dump", "hs,surface@" + ",".join(f"{step * dt:.9g}" for step in asked)]
        command[command.index("--seconds") + 1] = repr((asked[-1] + 0.1) * dt)
    subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)
    kept = {}
    for name in ("hs", "surface") if times else ():
        at = {step: numpy.load(folder / f"{name}_{step * dt:.9g}.npy").astype(float) for step in asked}
        kept[name] = [at[step] if share <= 1e-3 else (1 - share) * at[step] + share * at[step + 1] for step, share in steps]
    shutil.rmtree(folder, ignore_errors=True)
    return json.loads((scratch / "summary.json").read_text()), kept


def error(run, truth, name, checkpoints):
    """As samples/tune/README.md says."""
    moved = [averaged(field - truth[name][0], run[name][0].shape) for field in truth[name][1:1 + checkpoints]]
    span = max(field.max() for field in [*moved, 0 * moved[0]]) - min(field.min() for field in [*moved, 0 * moved[0]])
    return 100 * numpy.mean([numpy.abs(field - run[name][0] - truth).mean() for field, truth in zip(run[name][1:], moved)]) / span


def proportional(grid, nx):
    """Cells of a grid of the same extent along both axes, about nx along x: half a cell along y too many shows as an error."""
    common = math.gcd(grid["nx"], grid["ny"])
    times = max(round(nx / grid["nx"] * common), 1)
    return grid["nx"] // common * times, grid["ny"] // common * times


def judge(arguments, name, source, scratch):
    """source: the level's folder."""
    folder = scratch / name
    shutil.copytree(source, folder)
    level = folder / "level.json"
    device = ["--backend", arguments.backend, "--threads", arguments.threads]
    command = [arguments.bin / "wadi-tune", level, "--budget-ms", arguments.budget_ms, "--minutes", arguments.minutes, "--write", "--json", scratch / "tune.json",
               *device, *(["--processor-time"] if arguments.processor_time else [])]
    done = subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)
    tuned = json.loads((scratch / "tune.json").read_text())
    if arguments.keep:
        shutil.copytree(folder, arguments.keep / name)
        shutil.copy(scratch / "tune.json", arguments.keep / name)
        (arguments.keep / name / "tune.txt").write_text(done.stderr + done.stdout)

    key = "processor_seconds" if arguments.processor_time else "stepping_seconds"
    duration = json.loads(strip_comments(level.read_text())).get("duration", 10)
    recorder = arguments.bin / "wadi-recorder"
    times = []
    for _ in range(3):
        summary, _ = record(recorder, level, "budget", duration, (), scratch, device)
        times.append(1e3 * summary[key] / summary["simulated_seconds"] / tuned["frames_per_second"])

    text = json.loads(strip_comments(level.read_text()))
    finest = json.loads(json.dumps(text["variants"]["budget"]))
    extent = finest["grid"]["nx"] * finest["grid"]["dx"]
    nx, ny = proportional(text["grid"], arguments.finer * max(tuned["reference"]["nx"], tuned["chosen"]["nx"]))
    finest["dt"] = finest["dt"] * finest["grid"]["nx"] / nx
    finest["grid"] = {"nx": nx, "ny": ny, "dx": extent / nx}
    finest["method"] = {"substeps": 3, "water_transport_order": 2, "sand_transport_order": 2}
    text["variants"]["finest"] = finest
    level.write_text(json.dumps(text))
    checkpoints = [tuned["piece_seconds"] * k / tuned["checkpoints"] for k in range(tuned["checkpoints"] + 1)]
    _, mine = record(recorder, level, "budget", tuned["piece_seconds"], checkpoints, scratch, device)
    _, truth = record(recorder, level, "finest", tuned["piece_seconds"], checkpoints, scratch, ["--backend", arguments.backend])
    errors = {kind: error(mine, truth, KINDS[kind], tuned["checkpoints"]) if tuned[kind]["moved"] else None for kind in KINDS}
    early = {kind: error(mine, truth, KINDS[kind], tuned[kind]["early_checkpoints"]) if tuned[kind]["early_checkpoints"] else None for kind in KINDS}
    return tuned, sorted(times), (nx, ny), errors, early


def offences(tuned, times, errors, early):
    """What the tuner said too far from what was measured; times: of each recording, rising. They differ by what others on the machine do."""
    chosen, found = tuned["chosen"], []
    if not times[0] / MOST_TIME <= chosen["ms_per_frame"] <= times[-1] * MOST_TIME:
        found.append(f"{chosen['ms_per_frame']:.3g} ms said, {times[0]:.3g} to {times[-1]:.3g} ms recorded")
    for kind in KINDS:
        for part, said, judged, told in (("", chosen[f"{kind}_percent"], errors[kind], tuned[kind]["converges"]),
                                         (" at first", tuned[kind]["early_percent"], early[kind], True)):
            if judged is not None and (said > MOST_ERROR * judged or judged > MOST_ERROR * said and told):
                found.append(f"{kind}{part} {said:.3g} % said, {judged:.3g} % judged")
    return found


def untold(tuned, errors):
    """For each error that was judged whether the tuner told none, not even of an early part."""
    return [not tuned[kind]["converges"] and not tuned[kind]["early_checkpoints"] for kind in KINDS if errors[kind] is not None]


def cell(tuned, kind, judged, early):
    if judged is None:
        return "-"
    whole = f"{'' if tuned[kind]['converges'] else 'at least '}{tuned['chosen'][f'{kind}_percent']:.2f}, {judged:.2f}"
    if early is None:
        return whole
    seconds = tuned["piece_seconds"] * tuned[kind]["early_checkpoints"] / tuned["checkpoints"]
    return f"{whole}; first {seconds:.3g} s {tuned[kind]['early_percent']:.2f}, {early:.2f}"


def draw(arguments, number, scratch):
    """The folder of a drawn level, named after its kind, seed, number and try."""
    level = drawn_levels.drawn(arguments.bin / "wadi-recorder", arguments.seed, number, lambda line: print(line, file=sys.stderr, flush=True))
    folder = scratch / "drawn" / level["name"].lower().removeprefix("drawn ").replace(" ", "_")
    drawn_levels.write(level, folder)
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path, help="folder of wadi-tune and wadi-recorder")
    parser.add_argument("levels", nargs="*", help=f"shipped levels; without --drawn {', '.join(JUDGED)} unless said")
    parser.add_argument("--drawn", type=int, default=0, metavar="N", help="draw N levels")
    parser.add_argument("--seed", type=int, help="to draw from")
    parser.add_argument("--first", type=int, default=0, help="number of the first of them")
    parser.add_argument("--keep", type=pathlib.Path, help="a new folder for the levels with their variants and what the tuner said of them")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--wall-time", action="store_true", help="on a CPU as well, whose times are else processor time")
    parser.add_argument("--budget-ms", default="2")
    parser.add_argument("--minutes", default="1")
    parser.add_argument("--finer", type=float, default=1.6, help="cells along x of the run that judges, over those of the tuner's finest")
    arguments = parser.parse_args()
    arguments.processor_time = arguments.backend == "cpu" and not arguments.wall_time
    if arguments.drawn and arguments.seed is None:
        parser.error("--drawn wants --seed")
    off, left = [], []
    print("| level | settings | model [ms] | said [ms] | recorder [ms] | sand: said, judged [%] | water: said, judged [%] | judged against |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: | --- |", flush=True)
    names = arguments.levels or ([] if arguments.drawn else JUDGED)
    jobs = [(None, lambda scratch, number=number: draw(arguments, number, scratch)) for number in range(arguments.first, arguments.first + arguments.drawn)]
    jobs += [(name, lambda _, name=name: LEVELS / name) for name in names]
    for name, find in jobs:
        with tempfile.TemporaryDirectory() as scratch:
            source = find(pathlib.Path(scratch))
            name = name or source.name
            try:
                tuned, times, finest, errors, early = judge(arguments, name, source, pathlib.Path(scratch))
            except subprocess.CalledProcessError as failure:
                print(f"| `{name}` | failed |", flush=True)
                off.append(f"{name}: {(failure.stderr.strip().splitlines() or ['?'])[-1]}")
                continue
        off += [f"{name}: {line}" for line in offences(tuned, times, errors, early)]
        left += untold(tuned, errors)
        chosen, model = tuned["chosen"], tuned["predicted"]
        cells = [cell(tuned, kind, errors[kind], early[kind]) for kind in KINDS]
        orders = "".join(str(chosen[f"{kind}_transport_order"]) for kind in ("water", "sand"))
        way = f"orders {orders}, T {chosen['substeps']}{', tiles' if chosen['active_tiles'] == 1 else ''}"
        print(f"| `{name}` | {chosen['nx']} x {chosen['ny']}, {way} | {model['ms_per_frame']:.2f} | {chosen['ms_per_frame']:.2f} | {times[0]:.2f} | "
              f"{cells[0]} | {cells[1]} | {finest[0]} x {finest[1]}, {tuned['piece_seconds']:.3g} s |", flush=True)
    if len(jobs) > 1 and sum(left) > MOST_UNTOLD * len(left):
        off.append(f"{sum(left)} of {len(left)} errors are not told")
    print("\n".join(off))
    return 1 if off else 0


if __name__ == "__main__":
    sys.exit(main())
