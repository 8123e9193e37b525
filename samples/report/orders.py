#!/usr/bin/env python3
"""First against second order transport of water: error of dam breaks with a known answer on finer and finer grids, and what a step costs.
Prints two tables.

usage: samples/report/orders.py BIN_FOLDER [--backend cpu] [--sizes 100 200 400 800]
BIN_FOLDER holds wadi-recorder.
"""
import argparse
import pathlib
import statistics
import sys

import cases
import recordings

ORDERS = (1, 2)


def pool(n=256):
    """A column of water that spreads in a pool, no sand."""
    return {"format_version": 1, "name": "Pool", "grid": {"nx": n, "ny": n, "dx": 0.1}, "dt": 0.004, "duration": 1,
            "water": [{"shape": "plane", "height": 0.2}, {"shape": "cylinder", "center": [0.05 * n, 0.05 * n], "radius": 4, "height": 0.8}]}


COSTS = {  # what a step costs: (level, seconds)
    "water only, 256 x 256": (pool(), 1),
    "canyon (water, sand, mixture), 200 x 256": ("canyon", 4),
}


def errors(recorder, sizes):
    for name, right in (("stoker", 0.2), ("ritter", 0)):
        for n in sizes:
            level, seconds, measure = cases.dam_break(right, n)
            found = []
            for order in ORDERS:
                run, summary = recorder.record(recordings.choose(level, water_transport_order=order), seconds=seconds, times=(seconds,))
                found.append(measure(run, summary)[0][2])
            yield name, n, found


def step_times(recorder, name, repeats=3):
    """Median ms per step of each order, runs taken in turn."""
    level, seconds = COSTS[name]
    level = level if isinstance(level, dict) else recordings.read_level(level)
    times = {order: [] for order in ORDERS}
    for _ in range(repeats):
        for order in ORDERS:
            _, summary = recorder.record(recordings.choose(level, water_transport_order=order), seconds=seconds, benchmark=True)
            times[order].append(summary["ms_per_step"])
    return [statistics.median(times[order]) for order in ORDERS]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 200, 400, 800])
    options = parser.parse_args()
    with recordings.Recorder(options.programs / "wadi-recorder", options.backend) as recorder:
        print("| dam break | cells | order 1: mean error [m] | order 2 | ratio |\n| --- | ---: | ---: | ---: | ---: |")
        for name, n, (first, second) in errors(recorder, options.sizes):
            print(f"| {name} | {n} | {first:.3g} | {second:.3g} | {second / first:.2f} |", flush=True)
        print("\n| level | order 1: ms per step | order 2 | ratio |\n| --- | ---: | ---: | ---: |")
        for name in COSTS:
            first, second = step_times(recorder, name)
            print(f"| {name} | {first:.3g} | {second:.3g} | {second / first:.2f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
