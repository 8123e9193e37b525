#!/usr/bin/env python3
"""The measurements of this folder that depend on the machine, unattended, of one build and in one job: with a GPU frontier.py, timings.py,
prices.py and effects.py's prices, on a CPU all of effects.py and side_by_side.py besides, which are the same on any machine. Each writes a
folder of its own under OUT, what they print is in OUT/log.txt. A backend that the machine lacks is left out, and said; a part that outlasts its share of the time is ended, and what it has written stays. Exit code 1 where a part failed or was ended.

usage: tests/lab/report/run_all.py BIN_FOLDER [--quick] [--parts PART ...] [--minutes 30] [--backends cuda,vulkan,cpu] [--relaxed BIN_FOLDER] [--out out/all]

A CPU has two threads for timings and frontier and one, whose processor time counts, for the rest. Full parts took 15 minutes on an H100; two cores want
75 or more.
"""
import argparse
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
PARTS = ("frontier", "timings", "prices", "effects", "methods")
FRONTIER_ROWS = 16  # as many times the longest row that is measured fit: all took 12 times as long on an H100, 8 on two cores
WRITES_PAGE = 0.9  # of its time: prices.py begins no further round


def end_group(process):
    """The script and its recorder, as Ctrl-C does: the script removes its scratch files."""
    os.killpg(process.pid, signal.SIGINT)
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def run(command, seconds, log):
    """Exit code, or None where the time was over."""
    # Its own output file: a pipe would block the clock below on a silent part.
    process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        end_group(process)
        return None
    except BaseException:
        end_group(process)
        raise


def parts_on(options, there):
    """{part: (share of the minutes, function of the seconds it has, which gives its command)} in their order, on the first backend (timings of a
    GPU: on all). What one leaves over goes to the next."""
    first, programs, quick = there[0], options.programs, options.quick
    cpu = first == "cpu"
    one = ["--backend", first, *(["--processor-time"] if cpu else [])]
    until = lambda left: ["--minutes", f"{WRITES_PAGE * left / 60:.2f}"]
    relaxed = ["--relaxed", options.relaxed] if options.relaxed else []
    parts = {
        "frontier": (5 if cpu else 4, lambda left: ["frontier.py", programs, "--backend", first, *(["--threads", 2] if cpu else []), "--row-seconds", f"{left / FRONTIER_ROWS:.1f}",
                                      *(["--sizes", 16, 32] if quick else [])]),
        "timings": (2, lambda left: ["timings.py", programs, *(["--quick"] if quick else []), "--backends", ",".join(there),
                                     *(["--threads", 2, "--only", "table_2", "scaling", "order", "presets"] if cpu else [])]),
        "prices": (2, lambda left: ["prices.py", programs, *(["--quick"] if quick or cpu else []), *one, *until(left), *relaxed]),
        "effects": (27 if cpu else 2, lambda left: ["effects.py", programs, *one, *(["--only", "water", "drag"] if quick else []), *([] if cpu else ["--prices", "--rounds", 3])])}
    if cpu:
        parts["methods"] = 32, lambda left: ["side_by_side.py", programs, *(["--small"] if quick else [])]
    return {name: part for name, part in parts.items() if name in options.parts}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="small grids: shows that all runs, measures little")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, metavar="PART", help=f"of {', '.join(PARTS)} (default all)")
    parser.add_argument("--backends", default="cuda,vulkan,cpu", help="wanted, the one to report on first (default %(default)s)")
    parser.add_argument("--relaxed", type=pathlib.Path, metavar="BIN", help="programs of a build with -DWADI_STRICT_FLOAT=OFF, to price strict floats by")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/all"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    log, failed = (options.out / "log.txt").open("a"), []

    def say(text):
        print(text, flush=True)
        print(text, file=log, flush=True)

    listed = subprocess.run([str((options.programs / "wadi-recorder").resolve()), "--list-backends"], capture_output=True, text=True, check=True).stdout
    there = [name for name in options.backends.split(",") if re.search(rf"^{name} +\d+ ", listed, re.M)]
    say(listed.rstrip())
    for name in options.backends.split(","):
        if name not in there:
            say(f"SKIPPED {name}: no device here")
    if not there:
        return 1
    parts, due = parts_on(options, there), time.monotonic()
    for name in options.parts:
        if name not in parts:
            say(f"SKIPPED {name}: of a CPU alone, the first backend is {there[0]}")
    for name, (share, command_of) in parts.items():
        due += 60 * options.minutes * share / sum(share for share, _ in parts.values())
        left = due - time.monotonic()
        script, *arguments = command_of(left)
        say(f"== {name}: {script} {' '.join(map(str, arguments))}, {left:.0f} s at most")
        start = time.monotonic()
        code = run([sys.executable, "-u", str(HERE / script), *map(str, arguments), "--out", str(options.out / name)], left, log)
        result = "ENDED: out of time" if code is None else {0: "done", 77: "SKIPPED, see log.txt"}.get(code, f"FAILED: exit code {code}")
        say(f"== {name}: {result} after {time.monotonic() - start:.0f} s")
        if code not in (0, 77):
            failed.append(name)
    say(f"{options.out}: " + (f"{', '.join(failed)} not complete, see its log" if failed else "complete"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
