#!/usr/bin/env python3
"""Measures sand against truth from outside: runs scenes and prints what they give, with limits and references. README.md has more.

usage: measure.py RECORDER [CASE...] [--backend cpu] [--dx 0.1,0.05] [--set material.slope_normal=0] [--control] [--check] [--jobs N]
"""
import argparse
import concurrent.futures
import fnmatch
import json
import os
import sys
import tempfile

try:
    import numpy  # noqa: F401, first of all, for a message that helps
except ImportError:
    sys.exit(f"measure.py: {sys.executable} has no numpy; install python3-numpy and run it with /usr/bin/python3")

import cases
import scene
import table

import columns  # noqa: F401, registers its cases, as do:
import brinks  # noqa: F401
import cuts  # noqa: F401
import damp  # noqa: F401
import dams  # noqa: F401
import orders  # noqa: F401
import piles  # noqa: F401
import slopes  # noqa: F401
import slopes_energy  # noqa: F401
import streams  # noqa: F401


def setting(text):
    key, sign, value = text.partition("=")
    if not sign or not key:
        raise argparse.ArgumentTypeError(f"{text}: want KEY=VALUE, such as material.friction=0.6")
    try:
        return key, json.loads(value)
    except json.JSONDecodeError:
        return key, value


def spacings(text):
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if not values or min(values) <= 0:
        raise argparse.ArgumentTypeError(f"{text}: want cell sizes in metres, such as 0.1,0.05")
    return values


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="names or patterns ('column_*'); default: all")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--dx", type=spacings, help="cell sizes [m] instead of the cases' own")
    parser.add_argument("--quick", action="store_true", help="only the cases and cell sizes that ctest runs")
    parser.add_argument("--set", type=setting, action="append", default=[], metavar="KEY=VALUE", help="a level's key, dotted; repeatable")
    parser.add_argument("--control", action="store_true", help="run each case once more with its control, which must miss a limit")
    parser.add_argument("--check", action="store_true", help="fail where a limit is missed, or where a control misses none")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at once")
    parser.add_argument("--work", metavar="DIR", help="keeps the runs there and takes them from there")
    parser.add_argument("--list", action="store_true", help="names of the cases")
    return parser.parse_intermixed_args()


def chosen(patterns):
    names = [name for name in cases.CASES if not patterns or any(fnmatch.fnmatch(name, pattern) for pattern in patterns)]
    for pattern in patterns:
        if not any(fnmatch.fnmatch(name, pattern) for name in names):
            sys.exit(f"measure.py: no case {pattern}; there are: {' '.join(cases.CASES)}")
    return [cases.CASES[name] for name in names]


def measured(wanted, lab):
    """(title, rows, rows of the control or None) of each case on each of its grids."""
    # Threads for all: the lab itself holds back more runs than --jobs.
    with concurrent.futures.ThreadPoolExecutor(64) as pool:
        waiting = []
        for case in chosen(wanted.cases):
            for dx in (case.quick if wanted.quick else wanted.dx or case.dx):
                control = pool.submit(case.measure, lab.variant(case.control), dx) if wanted.control else None
                waiting.append((f"{case.name}, dx {dx:g}", pool.submit(case.measure, lab, dx), control))
        for title, rows, control in waiting:
            yield title, rows.result(), control and control.result()


def main():
    wanted = options()
    if wanted.list:
        print("\n".join(cases.CASES))
        return 0
    count, missed, slack, tame = 0, [], [], []
    try:
        with tempfile.TemporaryDirectory(prefix="wadi_sand_") as scratch:
            lab = scene.Lab(wanted.recorder, wanted.work or scratch, wanted.backend, dict(wanted.set), max(1, wanted.jobs))
            for title, rows, control in measured(wanted, lab):
                print("\n".join(table.lines(title, rows, control)), flush=True)
                count += 1
                missed += [f"{title}: {row.name}" for row in rows if not row.held]
                slack += [f"{title}: {row.name}" for row in rows if row.held and not row.ok]
                if control and all(row.held for row in control):
                    tame.append(title)
    except scene.RunError as error:
        sys.exit(f"measure.py: {error}")
    print(f"{count} cases, {len(missed)} limits missed{''.join(f'{chr(10)}  {name}' for name in missed)}")
    if slack:
        print(f"  {len(slack)} limits known to be missed:{''.join(f'{chr(10)}    {name}' for name in slack)}")
    for title in tame:
        print(f"  {title}: its control misses no limit")
    return 1 if wanted.check and (missed or tame or count == 0) else 0


if __name__ == "__main__":
    sys.exit(main())
