#!/usr/bin/env python3
"""What limits a step of a level on a CUDA device: Nsight Compute's counters of whole steps, kernel by kernel, beside two bounds. Needs ncu.

usage: tests/conformance/limits.py BIN_FOLDER [LEVEL:NXxNY:SECONDS ...] [--skip 700] [--launches 75] [--out DIR]
       tests/conformance/limits.py --page [--out DIR]      tables of the CSVs that lie in DIR
LEVEL: a shipped one; all_wet: water alone, no dry ground, no tiles; or all_effects: what `conformance perf-tiles` steps, every effect but sources,
rain and open sides in every cell. Counters lie in OUT/LEVEL_NX.csv.gz; what is printed is Markdown. Of a step, in ms:
the time of its kernels and of the short ones among them, and what it would take if every issue slot of every scheduler were used (`instructions`)
or memory ran at its full rate (`bytes`).
--launches has to hold a whole step: 19 to 40 kernels with tiles.
"""
import argparse
import csv
import gzip
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROWS = ("castle:4096x4096:0.5", "wadi:4096x4096:0.5", "beach:4096x4096:0.5", "canyon:4096x5243:1", "dam_break:4096x4096:1", "dam_break:1024x1024:1", "dam_break:512x512:1",
        "all_wet:4096x4096:5", "all_wet:1024x1024:12", "all_effects:4096x4096:0", "all_effects:1024x1024:0")
SECTIONS = ("SpeedOfLight", "WarpStateStats", "SchedulerStats", "InstructionStats", "LaunchStats", "Occupancy", "MemoryWorkloadAnalysis")
ALL_WET = {"format_version": 1, "name": "all wet", "grid": {"nx": 256, "ny": 256, "dx": 1}, "dt": 0.05, "duration": 10, "effects": {"bed_friction": "off"},
           "water": [{"shape": "plane", "height": 2}, {"shape": "cylinder", "center": [64, 64], "radius": 40, "height": 3, "combine": "set"}]}
ONCE_A_STEP = ("step_mixed_water", "step_water")
TIME, EXECUTED, RATE = "gpu__time_duration.sum", "smsp__inst_executed.sum", "dram__bytes.sum.per_second"
ISSUE, MEMORY, WARPS = "sm__issue_active.avg.pct_of_peak_sustained_elapsed", "dram__cycles_active.avg.pct_of_peak_sustained_elapsed", "sm__warps_active.avg.pct_of_peak_sustained_active"
WAVES = "launch__waves_per_multiprocessor"
STALL = re.compile(r"smsp__average_warps_issue_stalled_(\w+)_per_issue_active\.ratio")
WAITS = {"long_scoreboard": "loads", "barrier": "barriers", "short_scoreboard": "shared memory", "wait": "fixed latencies", "no_instruction": "instructions to arrive", "math_pipe_throttle": "arithmetic pipes",
         "mio_throttle": "shared memory's queue", "lg_throttle": "loads' queue", "not_selected": "other warps", "branch_resolving": "branches", "imc_miss": "constants", "dispatch_stall": "dispatch"}


def collect(programs, row, options):
    level, size, seconds = row.split(":")
    report = options.out / f"{level}_{size.split('x')[0]}"
    where = ROOT / "samples" / "levels" / level
    if level == "all_wet":
        where = options.out / "all_wet.json"
        where.write_text(json.dumps(ALL_WET))
    program = [str(programs / "wadi-recorder"), str(where), "--backend", "cuda", "--size", size, "--seconds", seconds, "--no-frames", "--out", str(options.out / "recording")]
    if level == "all_wet":
        program += ["--active-tiles", "-1"]
    if level == "all_effects":
        program = [str(programs / "conformance"), "perf-tiles", "--backend", "cuda", "--size", size.split("x")[0], "--shares", "1", "--tiles", "0", "--fused-only", "--repeats", "1"]
    command = ["ncu", "--force-overwrite", "--export", str(report), "--graph-profiling", "node", "--clock-control", "none", "--cache-control", "none", "--launch-skip", str(options.skip),
               "--launch-count", str(options.launches), *(word for section in SECTIONS for word in ("--section", section)), *program]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    raw = subprocess.run(["ncu", "--import", f"{report}.ncu-rep", "--page", "raw", "--csv", "--print-units", "base", "--print-kernel-base", "demangled"], capture_output=True, text=True, check=False)
    if done.returncode != 0 or raw.returncode != 0:
        sys.exit(f"{row}: ncu failed\n{done.stdout[-2000:]}{done.stderr[-2000:]}{raw.stdout[-500:]}{raw.stderr[-500:]}")
    with gzip.open(f"{report}.csv.gz", "wt") as file:
        file.write(raw.stdout)


def number(text):
    return float(text.replace(",", "")) if text else 0.0


def whole_steps(path):
    """([kernels of whole steps], how many steps); the second line of ncu's CSV are units."""
    with gzip.open(path, "rt") as file:
        kernels = list(csv.DictReader(file))[1:]
    for kernel in kernels:
        named = re.match(r".*wadi_stage_cuda_(\w+)::", kernel["Kernel Name"])
        kernel["stage"] = named[1] if named else "step_water"  # of one kernel alone ncu prints no namespace, and water's step is one kernel
    starts = [n for n, kernel in enumerate(kernels) if kernel["stage"] in ONCE_A_STEP]
    if len(starts) < 2:
        sys.exit(f"{path}: {len(kernels)} kernels and no whole step among them; want another --skip or more --launches")
    return kernels[starts[0]:starts[-1]], len(starts) - 1


def totals(kernels, steps):
    """Milliseconds of a step: of its kernels, if all issue slots were used, if memory ran at its rate; warp instructions, bytes."""
    time = sum(number(k[TIME]) for k in kernels) / steps / 1e6
    # A slot's share used and memory's share busy, of the kernel's own time: what is left of it at 100 %.
    issue = sum(number(k[TIME]) * number(k[ISSUE]) for k in kernels) / steps / 1e8
    memory = sum(number(k[TIME]) * number(k[MEMORY]) for k in kernels) / steps / 1e8
    return time, issue, memory, sum(number(k[EXECUTED]) for k in kernels) / steps, sum(number(k[RATE]) * number(k[TIME]) / 1e9 for k in kernels) / steps


def waits_for(kernels):
    """The two largest reasons for which a warp waits, in cycles per instruction issued, means by time."""
    whole, cycles = sum(number(k[TIME]) for k in kernels), {}
    for column in kernels[0]:
        found = STALL.fullmatch(column)
        if found and found[1] not in ("selected", "not_selected"):
            cycles[found[1]] = sum(number(k[TIME]) * number(k[column]) for k in kernels) / whole
    return ", ".join(f"{WAITS.get(name, name)} {value:.1f}" for name, value in sorted(cycles.items(), key=lambda item: -item[1])[:2])


def page(folder):
    paths = sorted(folder.glob("*.csv.gz"))
    if not paths:
        sys.exit(f"{folder}: no CSV of counters")
    print("| row | kernels | their time | instructions | bytes | warp instructions [M] | bytes moved [MB] | kernels under 10 us |\n| --- |" + " ---: |" * 7)
    steps_of = {path: whole_steps(path) for path in paths}
    for path, (kernels, steps) in steps_of.items():
        time, issue, memory, executed, moved = totals(kernels, steps)
        small = sum(number(k[TIME]) for k in kernels if number(k[TIME]) < 1e4) / steps / 1e6
        print(f"| {path.name.split('.')[0]} | {len(kernels) / steps:.0f} | {time:.3f} | {issue:.3f} | {memory:.3f} | {executed / 1e6:.0f} | {moved / 1e6:.0f} | {small:.3f} |")
    for path, (kernels, steps) in steps_of.items():
        print(f"\n{path.name.split('.')[0]}\n\n| stage | a step | us a step | issue slots used [%] | memory busy [%] | warps there [%] | waves | a warp waits mostly for [cycles] |\n| --- |" + " ---: |" * 6 + " --- |")
        by_stage = {}
        for kernel in kernels:
            by_stage.setdefault(kernel["stage"], []).append(kernel)
        for stage, of in sorted(by_stage.items(), key=lambda item: -sum(number(k[TIME]) for k in item[1])):
            whole = sum(number(k[TIME]) for k in of)
            mean = lambda column: sum(number(k[TIME]) * number(k[column]) for k in of) / whole  # noqa: B023, used within the loop
            print(f"| `{stage}` | {len(of) / steps:.3g} | {whole / steps / 1e3:.1f} | {mean(ISSUE):.0f} | {mean(MEMORY):.0f} | {mean(WARPS):.0f} | {mean(WAVES):.1f} | {waits_for(of)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path, nargs="?")
    parser.add_argument("rows", nargs="*", default=ROWS, metavar="LEVEL:NXxNY:SECONDS")
    parser.add_argument("--skip", type=int, default=700, help="kernels before the first that is looked at (default %(default)s)")
    parser.add_argument("--launches", type=int, default=75, help="kernels that are looked at (default %(default)s)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/limits"))
    parser.add_argument("--page", action="store_true", help="measure nothing")
    options = parser.parse_args()
    if options.page == bool(options.programs):
        parser.error("want the programs' folder or --page")
    options.out.mkdir(parents=True, exist_ok=True)
    for row in options.rows if options.programs else ():
        collect(options.programs.resolve(), row, options)
    page(options.out)


if __name__ == "__main__":
    main()
