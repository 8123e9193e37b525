#!/usr/bin/env python3
"""Effect by effect, and choice by choice that levels have on by themselves, what leaving it out changes: the level that shows it best, with it
and without, in three dimensions and in numbers, and what it costs. Writes tests/lab/report/effects.

usage: tests/lab/report/effects.py BIN_FOLDER [--backend cpu] [--prices] [--processor-time] [--rounds 7] [--only EFFECT ...] [--out DIR | --check]
       tests/lab/report/effects.py --page [--out DIR]     the page anew, of rows that lie there
Rows lie in OUT/rows_cpu.jsonl and OUT/rows_gpu.jsonl; the page wants those of the sources as they are: numbers and pictures of every effect, and
prices from a CPU, a GPU or both.
--check: half the cells along x and y and half the time, no files; fails where a pair does not differ, where the same run twice does, or where an effect, or a
choice that is on by itself, has no pair.
"""
import argparse
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import pairs
import prices
import recordings
import stamps

# effect: (level, cells, seconds, what the level is changed by, what to look at)
SHOWN = {
    "water": ("letters", (160, 80), 5, {}, "No wave, and no damp that holds the letters: they run out."),
    "sand": ("dam_break", (96, 96), 7, {}, "No columns that the flood has to run round."),
    "mixture": ("letters", (160, 80), 10, {}, "One velocity for all water: letters hold the whole stream up, and most of them stay."),
    "diffusion": ("piles", (168, 112), 5.4, {"material": {"diffusion_rate": 0.5}}, "Less water comes out of the soaked pile; what pores hold back stays either way."),
    "drag": ("castle", (128, 64), 6, {}, "Water fills the sand unhindered and does not push it: the castle slumps to a sheet where it stood."),
    "elastoplastic": ("castle", (128, 64), 3, {}, "Sand that only rubs: the walls run apart before the wave is there."),
    "cohesion": ("piles", (168, 112), 5.4, {}, "Damp piles run out as dry ones do."),
    "sources": ("spring", (128, 128), 8, {}, "No spring: the hollow stays dry."),
    "rain": ("canyon", (100, 128), 40, {"rain": 0.005, "sources": []}, "A cloudburst of 5 mm/s in place of the flood fills hollows and the lakes behind the dams."),
    "open_sides": ("beach", (160, 128), 28, {}, "No waves come in."),
    "bed_friction": ("letters", (160, 80), 5, {"material": {"bed_friction": 0.1}}, "The wave runs further over the ground."),
    "bed_shear": ("spring", (128, 128), 8, {}, "Clear water slides over the sand: a small pit in place of a wide crater."),
    "roughness": ("letters", (160, 80), 5, {"roughness": [{"shape": "box", "from": [0, 0], "to": [64, 16], "manning": 0.1}]},
                  "The wave runs over the southern half as far as over the northern one."),
    "slope_normal": ("dam_break", (96, 96), 3, {}, "Friction as on level ground: the dry column runs out further, to a flatter cone."),
    "internal_friction": ("piles", (168, 112), 5.4, {}, "Sand that spreads does not rub within: the dry pile and the soaked ones run further."),
    "retention": ("piles", (168, 112), 5.4, {}, "All pore water flows: damp piles stand in puddles of their own, the one at 0.45 sheds a ring of sand."),
    "shock_viscosity": ("dam_break", (96, 96), 6, {"dt": 0.01, "sand": [], "method": {"largest_height": 64}, "water": [
        {"shape": "plane", "height": 24}, {"shape": "box", "from": [0, 0], "to": [40, 40], "height": 30, "combine": "set"}]}, "Ripples of two cells trail the bores."),
}
NEEDED_BY = {"water": ("mixture", "diffusion", "drag", "cohesion", "rain", "bed_friction", "roughness", "bed_shear", "sources", "open_sides", "retention"),
             "sand": ("mixture", "diffusion", "drag", "elastoplastic", "cohesion", "bed_shear", "slope_normal", "internal_friction", "retention"),
             "mixture": ("diffusion", "bed_shear", "retention"), "drag": ("retention",), "bed_friction": ("roughness",), "elastoplastic": ("cohesion",)}
OFF = {"shock_viscosity": {"method": {"shock_viscosity": 0}}}  # choices of method are no `effects`
LEAST_PIXELS, LEAST_ERROR = 1.0, 0.2  # [%]: a pair differs from here on, to the eye and in its fields
PRICED = {"cpu": 2, "gpu": 8}  # prices: cells along x and y over those of the numbers, enough to keep the device busy
FINER, PICTURE = 2, "440x300"  # pictures: cells along x and y over those of the numbers; pixels
CAMERA = {"internal_friction": "opposite"}  # effect: where it is seen best, else "overview"


def known(recorder):
    """The effects that the engine has and the choices of method that are on by themselves, by a level's plan."""
    plan = subprocess.run([recorder.program, str(recordings.LEVELS / "piles"), "--backend", recorder.backend, "--print-plan"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  (?:on|- ) +(\w+)", plan, re.M) + re.search(r"^grid .* T = \d+(?:, (.*))?$", plan, re.M)[1].split(", ")


def left_out(with_it, without, seconds):
    """[(what, MAE in percent of the range over which it moved with the effect on)]."""
    result = []
    for name, what in (("hs", "sand"), ("surface", "water surface")):
        start, a, b = with_it.field(name, 0), with_it.field(name, seconds), without.field(name, seconds)
        moved = [y - x for x, y in zip(start, a)]
        span = max(moved) - min(moved)
        if span > 1e-6:
            result.append((what, 100 * math.fsum(abs(x - y) for x, y in zip(a, b)) / len(a) / span))
    return result


def level_of(effect, off):
    level, _, _, changes, _ = SHOWN[effect]
    level = recordings.merged(recordings.read_level(level), changes)
    if off:
        level = recordings.merged(level, OFF.get(effect) or {"effects": {name: "off" for name in (effect, *NEEDED_BY.get(effect, ()))}})
    return level


def run(recorder, effect, off, cells, seconds):
    recording, summary = recorder.record(level_of(effect, off), size=cells, seconds=seconds, times=(0, seconds), pictures=2)
    return recording, summary, pairs.map_of(recording.folder / "frame_00001.png", recording.nx, recording.ny)


def number(value):
    return f"{value:.3g}"


def pair(recorder, effect, cells, seconds):
    with_it, without = (run(recorder, effect, off, cells, seconds) for off in (False, True))
    errors = left_out(with_it[0], without[0], seconds)
    pixels = pairs.differing(with_it[2], without[2])
    print(f"{effect}: " + ", ".join(f"{what} {number(error)} %" for what, error in errors) + f", {number(pixels)} % of the pixels", flush=True)
    return with_it, without, errors, pixels


def view(programs, effect, off, picture):
    """The end of a run as the viewer draws it, simulated on the CPU."""
    _, cells, seconds, _, _ = SHOWN[effect]
    level = level_of(effect, off)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)

        def beside(value):  # a level names files of its own folder alone
            if isinstance(value, dict):
                for name in [value["file"]] if isinstance(value.get("file"), str) else []:
                    shutil.copy(name, scratch)
                return {key: pathlib.Path(inner).name if key == "file" else beside(inner) for key, inner in value.items()}
            return [beside(inner) for inner in value] if isinstance(value, list) else value

        (scratch / "level.json").write_text(json.dumps(beside(level)))
        command = [str(programs / "wadi-viewer"), str(scratch / "level.json"), "--backend", "cpu", "--threads", "1", "--grid", f"{FINER * cells[0]}x{FINER * cells[1]}", "--offscreen", "--jpeg",
                   "--start", f"{seconds:g}", "--size", PICTURE, "--camera", CAMERA.get(effect, "overview"), "--quality", "high", "--out", str(scratch / "out")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise recordings.Failed(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
        shutil.copy(next((scratch / "out").glob("*.jpg")), picture)


def kind_of(recorder):
    return "cpu" if recorder.backend == "cpu" else "gpu"


def priced(recorder, effect, rounds):
    """A row: what the effect adds to a step, in percent of the step with it, with the quartiles."""
    _, cells, seconds, _, _ = SHOWN[effect]
    cells = tuple(n * PRICED[kind_of(recorder)] for n in cells)
    step = lambda off: recorder.record(level_of(effect, off), size=cells, seconds=seconds)[1]
    price = prices.paired(lambda: step(False), {"off": lambda: step(True)}, rounds)["off"]
    low, middle, high = (100 * (1 - ratio) for ratio in (price.high, price.ratio, price.low))
    print(f"{effect}: {middle:.1f} % ({low:.1f} to {high:.1f}) of {price.base_ms:.3g} ms on {cells[0]} x {cells[1]} cells", flush=True)
    device = price.summary["device"]
    return {"what": "price", "ms": price.base_ms, "low": low, "middle": middle, "high": high, "rounds": rounds,
            "device": f"{device['backend']}: {device['name']}" + (", processor time" if recorder.processor_time else "")}


def numbers_of(recorder, effect):
    """A row: what leaving the effect out changes, and what a step has with it and without."""
    _, cells, seconds, _, _ = SHOWN[effect]
    with_it, without, errors, pixels = pair(recorder, effect, cells, seconds)
    return {"what": "numbers", "errors": dict(errors), "pixels": pixels, "passes": [side[1]["passes"]["per_step"] for side in (with_it, without)],
            "bytes_per_cell": [side[1]["bytes_per_cell"] for side in (with_it, without)]}


def measure(recorder, programs, options):
    with (options.out / f"rows_{kind_of(recorder)}.jsonl").open("a") as file:
        for effect in options.only or SHOWN:
            rows = [] if options.prices else [numbers_of(recorder, effect)]
            for off in () if options.prices else (False, True):
                view(programs, effect, off, options.out / f"{effect}_{'off' if off else 'on'}.jpg")
            for row in [*rows, priced(recorder, effect, options.rounds)]:
                file.write(json.dumps({**row, "effect": effect, "sources": stamps.state("effects")}) + "\n")
                file.flush()


def kept_rows(out):
    """({effect: numbers}, {kind of machine: {effect: price}}) that the sources as they are have made, the latest."""
    numbers, priced_on = {}, {}
    for kind in PRICED:
        path = out / f"rows_{kind}.jsonl"
        for row in map(json.loads, path.read_text().splitlines() if path.exists() else ()):
            if row["sources"] == stamps.state("effects"):
                (numbers if row["what"] == "numbers" else priced_on.setdefault(kind, {}))[row["effect"]] = row
    return numbers, {kind: rows for kind, rows in priced_on.items() if set(rows) == set(SHOWN)}


def share(price):
    text = f"({price['low']:.0f} to {price['high']:.0f})"
    return f"{price['middle']:.0f} {text}" if price["low"] > 0 or price["high"] < 0 else f"lost in the scatter {text}"


def write_page(out):
    """False where an effect lacks its numbers or prices."""
    numbers, priced_on = kept_rows(out)
    if set(numbers) != set(SHOWN) or not priced_on:
        print(f"{out}: no page, want numbers and prices of all effects: numbers of {len(numbers)} of {len(SHOWN)}, prices from {', '.join(priced_on) or 'no machine'}")
        return False
    both = lambda pair: " / ".join(f"{value:.0f}" for value in pair)
    rows, shown = [], []
    for effect, (level, cells, seconds, changes, look) in SHOWN.items():
        row = numbers[effect]
        rows.append([f"[{effect}](#{effect})", level, *(number(row["errors"][what]) if what in row["errors"] else "" for what in ("sand", "water surface")), number(row["pixels"]),
                     *(text for on in priced_on.values() for text in (number(on[effect]["ms"]), share(on[effect]))), both(row["passes"]), both(row["bytes_per_cell"])])
        extra = "".join(f", `{key}` {json.dumps(value)}" for key, value in changes.items())
        shown += [f"## {effect}", f"`{level}`, {cells[0]} x {cells[1]} cells (pictures: {FINER} times as many along x and y), {seconds} s{extra}. {look}", "",
                  f"| with `{effect}` | without |", "| --- | --- |", f"| ![with {effect}]({effect}_on.jpg) | ![without {effect}]({effect}_off.jpg) |", ""]
    head = ["without", "level", "sand [%]", "water surface [%]", "pixels [%]", *(text for kind in priced_on for text in (f"{kind.upper()}: ms per step", "of that the effect's [%]")), "passes",
            "bytes per cell"]
    machines = "; ".join(f"{kind.upper()}: {first['device']}, {PRICED[kind]} times the cells along x and y, {first['rounds']} pairs"
                         for kind, on in priced_on.items() for first in [next(iter(on.values()))])
    lines = ["# Effect by effect", "", "What leaving one effect out of a level changes (`\"effects\": { NAME: \"off\" }`, what needs it off as well; `shock_viscosity`, a choice of method: 0). Sand and water "
             "surface: mean absolute difference in percent of the range over which they moved with the effect on. Pixels: of the recorder's map, different by a tenth or more. Its share of a step: "
             "median and quartiles of pairs of runs by turns; negative where a step without it takes longer, since the scene is another then. Passes and bytes: with it / without. "
             f"Made by `tests/lab/report/effects.py BIN`. {machines}.", "",
             "| " + " | ".join(head) + " |", "| --- | --- " + "| ---: " * (len(head) - 2) + "|", *("| " + " | ".join(row) + " |" for row in rows), "", *shown, stamps.stamp("effects"), ""]
    (out / "README.md").write_text("\n".join(lines))
    return True


def check(recorder):
    lacking, unknown = set(known(recorder)) - set(SHOWN), set(SHOWN) - set(known(recorder))
    good = not lacking and not unknown and len(SHOWN) > 5
    print(f"{'OK  ' if good else 'FAIL'} every effect has a pair" + "".join(f"; {name}: none" for name in lacking) + "".join(f"; {name}: no effect" for name in unknown))
    for effect, (_, cells, seconds, *_) in SHOWN.items():
        with_it, _, errors, pixels = pair(recorder, effect, tuple(n // 2 for n in cells), seconds / 2)
        fine = pixels > LEAST_PIXELS and max(error for _, error in errors) > LEAST_ERROR
        good &= fine
        print(f"{'OK  ' if fine else 'FAIL'} {effect} shows: {number(pixels)} % of the pixels (above {LEAST_PIXELS:g})")
    again = run(recorder, effect, False, tuple(n // 2 for n in cells), seconds / 2)
    same = pairs.differing(with_it[2], again[2])
    good &= same == 0
    print(f"{'OK  ' if same == 0 else 'FAIL'} control: the same run twice differs in {number(same)} % of the pixels")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path, nargs="?")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the CPU backend (default 0: all cores)")
    parser.add_argument("--processor-time", action="store_true", help="times are processor time of one thread: for a busy machine, CPU backend alone")
    parser.add_argument("--prices", action="store_true", help="measure prices alone")
    parser.add_argument("--rounds", type=int, default=7, metavar="N", help="pairs of runs that price an effect (default %(default)s)")
    parser.add_argument("--only", nargs="*", default=[], choices=SHOWN, metavar="EFFECT")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "effects")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--page", action="store_true", help="measure nothing")
    options = parser.parse_args()
    if options.page == bool(options.programs):
        parser.error("want the programs' folder or --page")
    options.out.mkdir(parents=True, exist_ok=True)
    if options.programs:
        with recordings.Recorder(options.programs / "wadi-recorder", options.backend, 1 if options.processor_time else options.threads, options.processor_time) as recorder:
            if options.check:
                return 0 if check(recorder) else 1
            measure(recorder, options.programs, options)
    return 0 if write_page(options.out) or (options.programs and (options.prices or options.only)) else 1


if __name__ == "__main__":
    sys.exit(main())
