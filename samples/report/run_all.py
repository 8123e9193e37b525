#!/usr/bin/env python3
"""The measurements of this folder that depend on the machine, unattended, of one build and in one job: frontier.py, timings.py, effects.py and
wadi-report's price lists on the first backend that the machine has, each into a folder of its own under OUT, what they print in OUT/log.txt. A
backend that the machine lacks is left out, and said; a part that outlasts its share of the time is ended, and what it has written stays. Exit
code 1 where a part failed or was ended.

--beside: while frontier runs, whose times of large grids no busy host moves, the pages of a CPU (timings and frontier on two cores, effects, prices
and the report's sweep in processor time of one) and errors, whose numbers are the same on any machine, each on cores of its own; the other parts
then have the machine to themselves. Needs 16 cores and a GPU. With 32 methods runs too, on those that are left; it is the same anywhere as well.
In less than the 30 minutes it ends methods and what else is long.

usage: samples/report/run_all.py BIN_FOLDER [--quick] [--parts PART ...] [--minutes 30] [--backends cuda,vulkan,cpu] [--beside] [--relaxed BIN_FOLDER] [--out out/all]
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

from effects import SHOWN

HERE = pathlib.Path(__file__).resolve().parent
SHARES = {"frontier": 0.15, "timings": 0.35, "effects": 0.3, "prices": 0.2}  # of a lane's time, in this order; what one leaves over goes to the next
FRONTIER_ROWS = 30  # as many of the longest rows as fit: of each of 16 kinds of run one, and those of smaller grids
WRITES_PAGE = 0.9  # of its time: wadi-report stops measuring here
BESIDE_CORES = 16
BESIDE_SHARE = 0.58  # of the minutes
# A CPU's parts by the cores that a lane of them has: every second one, since neighbours may be threads of one core. 0 and 1 have the GPU's frontier.
CPU_LANES = {(2, 4): ("timings", "frontier", "errors"), (6,): ("sweep",), (8,): ("prices",), (10,): ("effects_0",), (12,): ("effects_1",), (14,): ("effects_2",)}
METHODS_CORES = 32  # so many are there; its own are those beyond BESIDE_CORES


def end_group(process):
    """The script and its recorder, as Ctrl-C does: the script removes its scratch files."""
    os.killpg(process.pid, signal.SIGINT)
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def run(command, seconds, log, cores=None):
    """Exit code, or None where the time was over."""
    # Its own output file: a pipe would block the clock below on a silent part.
    process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
                               preexec_fn=(lambda: os.sched_setaffinity(0, cores)) if cores else None)
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        end_group(process)
        return None
    except BaseException:
        end_group(process)
        raise


class Job:
    """Lanes of parts: those of a lane one after another, lanes at the same time."""

    def __init__(self, options):
        self.options, self.failed, self.lock = options, [], threading.Lock()
        self.out = options.out
        self.out.mkdir(parents=True, exist_ok=True)
        self.main_log = (self.out / "log.txt").open("a")

    def say(self, text):
        with self.lock:
            print(text, flush=True)
            print(text, file=self.main_log, flush=True)

    def lane(self, name, parts, minutes, cores=None):
        """parts: {folder under OUT: (share of the lane's minutes, function of the seconds it has, which gives its command)}"""
        due, whole = time.monotonic(), sum(share for share, _ in parts.values())
        log_name = f"log_{name}.txt" if name else "log.txt"
        log = (self.out / log_name).open("a") if name else self.main_log
        for folder, (share, command_of) in parts.items():
            due += 60 * minutes * share / whole
            left = due - time.monotonic()
            script, *arguments = command_of(left)
            self.say(f"== {folder}: {script} {' '.join(map(str, arguments))}, {left:.0f} s at most")
            start = time.monotonic()
            code = run([sys.executable, "-u", str(HERE / script), *map(str, arguments), "--out", str(self.out / folder)], left, log, cores)
            result = "ENDED: out of time" if code is None else {0: "done", 77: f"SKIPPED, see {log_name}"}.get(code, f"FAILED: exit code {code}")
            self.say(f"== {folder}: {result} after {time.monotonic() - start:.0f} s")
            if code not in (0, 77):
                self.failed.append(folder)


def device_parts(options, there):
    """The parts on the first backend (timings: on all)."""
    first, programs, quick = there[0], options.programs, ["--quick"] if options.quick else []
    commands = {
        "frontier": lambda left: ["frontier.py", programs, "--backend", first, "--row-seconds", f"{left / FRONTIER_ROWS:.1f}", *(["--sizes", "16", "32"] if options.quick else [])],
        "timings": lambda left: ["timings.py", programs, *quick, "--backends", ",".join(there)],
        "effects": lambda left: ["effects.py", programs, "--backend", first, *(["--only", "water", "drag"] if options.quick else []),
                                 *(["--prices", "--rounds", "3"] if first != "cpu" else [])],
        "prices": lambda left: ["wadi-report", programs, "--prices", *(quick or ["--full"]), "--backend", first, "--minutes", f"{WRITES_PAGE * left / 60:.2f}",
                                *(["--relaxed", options.relaxed] if options.relaxed else [])]}
    return {name: (SHARES[name], commands[name]) for name in SHARES if name in options.parts}


def cpu_parts(options):
    """{part: (folder under OUT, function of the seconds it has, which gives its command)}; a third of the effects to each of three parts."""
    programs, one, quick = options.programs, ["--backend", "cpu", "--processor-time"], options.quick
    return {
        "timings": ("cpu_timings", lambda left: ["timings.py", programs, "--backends", "cpu", "--threads", "2", "--only", "table_2", "scaling", "order", "presets",
                                                 *(["--quick"] if quick else [])]),
        "sweep": ("cpu_sweep", lambda left: ["wadi-report", programs, "--no-prices", "--quick" if quick else "--full", *one, "--repeats", options.repeats,
                                             "--minutes", f"{WRITES_PAGE * left / 60:.2f}"]),
        "prices": ("cpu_prices", lambda left: ["wadi-report", programs, "--prices", *one, "--minutes", f"{WRITES_PAGE * left / 60:.2f}"]),
        "frontier": ("cpu_frontier", lambda left: ["frontier.py", programs, "--backend", "cpu", "--row-seconds", f"{left / FRONTIER_ROWS:.1f}",
                                                   *(["--sizes", "16", "32"] if quick else [])]),
        "errors": ("errors", lambda left: ["errors.py", programs]),
        **{f"effects_{third}": ("cpu_effects", lambda left, third=third: ["effects.py", programs, "--prices", *one,
                                                                          "--only", *(["water", "drag", "sand"] if quick else list(SHOWN))[third::3]]) for third in range(3)}}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="small grids: shows that all runs, measures little")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--parts", nargs="+", choices=SHARES, default=list(SHARES), metavar="PART", help=f"of {', '.join(SHARES)} (default all)")
    parser.add_argument("--repeats", type=int, default=2, metavar="N", help="runs per point of the sweep (default %(default)s)")
    parser.add_argument("--backends", default="cuda,vulkan,cpu", help="wanted, the one to report on first (default %(default)s)")
    parser.add_argument("--beside", action="store_true", help="the pages of CPU cores, methods and errors as well, beside frontier")
    parser.add_argument("--relaxed", type=pathlib.Path, metavar="BIN", help="programs of a build with -DWADI_STRICT_FLOAT=OFF, to price strict floats by")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/all"))
    options = parser.parse_args()
    cores = sorted(os.sched_getaffinity(0))
    if options.beside and len(cores) < BESIDE_CORES:
        parser.error(f"--beside wants {BESIDE_CORES} cores, {len(cores)} are there")
    job = Job(options)
    listed = subprocess.run([str((options.programs / "wadi-recorder").resolve()), "--list-backends"], capture_output=True, text=True, check=True).stdout
    there = [name for name in options.backends.split(",") if re.search(rf"^{name} +\d+ ", listed, re.M)]
    job.say(listed.rstrip())
    for name in options.backends.split(","):
        if name not in there:
            job.say(f"SKIPPED {name}: no device here")
    if not there:
        return 1
    devices, minutes = device_parts(options, there), options.minutes
    if options.beside:
        lanes, cpu = [], cpu_parts(options)  # (name, parts, cores)
        if "frontier" in devices:
            lanes.append(("frontier", {"frontier": devices.pop("frontier")}, cores[:2]))
        for own, names in CPU_LANES.items():
            lanes.append(("_".join(("cpu", *names)), {cpu[name][0]: (1, cpu[name][1]) for name in names}, [cores[core] for core in own]))
        if len(cores) >= METHODS_CORES:
            lanes.append(("methods", {"methods": (1, lambda left: ["side_by_side.py", options.programs, *(["--small"] if options.quick else [])])}, cores[BESIDE_CORES:]))
        else:
            job.say(f"SKIPPED methods: {METHODS_CORES} cores wanted, {len(cores)} are there")
        with concurrent.futures.ThreadPoolExecutor(len(lanes)) as pool:
            for lane in [pool.submit(job.lane, name, parts, BESIDE_SHARE * minutes, set(own)) for name, parts, own in lanes]:
                lane.result()
        minutes *= 1 - BESIDE_SHARE
    job.lane("", devices, minutes)
    job.say(f"{options.out}: " + (f"{', '.join(job.failed)} not complete, see its log" if job.failed else "complete"))
    return 1 if job.failed else 0


if __name__ == "__main__":
    sys.exit(main())
