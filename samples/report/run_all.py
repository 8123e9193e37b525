#!/usr/bin/env python3
"""Every measurement of this folder that depends on the machine, unattended: frontier.py, timings.py, effects.py and wadi-report, each into a folder of its
own under OUT, what they print in OUT/log.txt as it comes. A backend that the machine lacks is left out, and said; a part that outlasts its
share of the time is ended, and what it has written stays. Exit code 1 where a part failed or was ended.

usage: samples/report/run_all.py BIN_FOLDER [--quick] [--parts PART ...] [--minutes 30] [--backends cuda,vulkan,cpu] [--relaxed BIN_FOLDER] [--out out/all]
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
SHARES = {"frontier": 0.15, "timings": 0.42, "effects": 0.11, "report": 0.32}  # of the time, in this order; what one leaves over goes to the next
FRONTIER_ROWS = 30  # as many of the longest rows as fit: of each of 16 kinds of run one, and those of smaller grids
WRITES_PAGE = 0.9  # of its time: the report stops measuring here


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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="small grids: shows that all runs, measures little")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--parts", nargs="+", choices=SHARES, default=list(SHARES), metavar="PART", help=f"of {', '.join(SHARES)} (default all)")
    parser.add_argument("--repeats", type=int, default=2, metavar="N", help="runs per point of the report (default %(default)s)")
    parser.add_argument("--backends", default="cuda,vulkan,cpu", help="wanted, the one to report on first (default %(default)s)")
    parser.add_argument("--relaxed", type=pathlib.Path, metavar="BIN", help="programs of a build with -DWADI_STRICT_FLOAT=OFF, to price strict floats by")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/all"))
    options = parser.parse_args()
    begun = time.monotonic()
    options.out.mkdir(parents=True, exist_ok=True)
    recorder = options.programs / "wadi-recorder"
    listed = subprocess.run([str(recorder.resolve()), "--list-backends"], capture_output=True, text=True, check=True).stdout
    there = [name for name in options.backends.split(",") if re.search(rf"^{name} +\d+ ", listed, re.M)]
    with (options.out / "log.txt").open("a") as log:
        def say(text):
            print(text, flush=True)
            print(text, file=log, flush=True)

        say(listed.rstrip())
        for name in options.backends.split(","):
            if name not in there:
                say(f"SKIPPED {name}: no device here")
        if not there:
            return 1
        quick = ["--quick"] if options.quick else []
        parts = {
            "frontier": ["frontier.py", options.programs, "--backend", there[0], *(["--sizes", "16", "32"] if options.quick else [])],
            "timings": ["timings.py", options.programs, *quick, "--backends", ",".join(there)],
            "effects": ["effects.py", options.programs, "--backend", there[0], *(["--only", "water", "drag"] if options.quick else []), *(["--prices", "--rounds", "3"] if there[0] != "cpu" else [])],
            "report": ["wadi-report", options.programs, *(quick or ["--full"]), "--backend", there[0], "--repeats", options.repeats, *(["--relaxed", options.relaxed] if options.relaxed else [])]}
        failed, due = [], begun
        for name in [part for part in SHARES if part in options.parts]:
            script, *arguments = parts[name]
            due += 60 * options.minutes * SHARES[name] / sum(SHARES[part] for part in options.parts)
            left = due - time.monotonic()
            if name == "report":
                arguments += ["--minutes", f"{WRITES_PAGE * left / 60:.2f}"]
            if name == "frontier":
                arguments += ["--row-seconds", f"{left / FRONTIER_ROWS:.1f}"]
            say(f"== {name}: {script} {' '.join(map(str, arguments))}, {left:.0f} s at most")
            start = time.monotonic()
            code = run([sys.executable, "-u", str(HERE / script), *map(str, arguments), "--out", str(options.out / name)], left, log)
            result = "ENDED: out of time" if code is None else {0: "done", 77: "SKIPPED, see log.txt"}.get(code, f"FAILED: exit code {code}")
            say(f"== {name}: {result} after {time.monotonic() - start:.0f} s")
            if code not in (0, 77):
                failed.append(name)
        say(f"{options.out}: " + (f"{', '.join(failed)} not complete, see log.txt" if failed else "complete"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
