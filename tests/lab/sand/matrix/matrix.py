#!/usr/bin/env python3
"""Sand at rest and on the point of sliding, wherever it lies: shapes x beds, inclines, faces, banks, each against a law. README.md is what
--page wrote.

usage: matrix.py RECORDER --quick | --full | NAME...    [--check] [--control] [--page] [--jobs N] [--work DIR]
NAME: names or patterns of cases ('rest/cylinder/*'), --list shows all.
"""
import argparse
import concurrent.futures
import dataclasses
import fnmatch
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(HERE.parent))
import measure  # noqa: E402
import scene  # noqa: E402
import table  # noqa: E402

import banks  # noqa: E402
import faces  # noqa: E402
import inclines  # noqa: E402
import on_bed  # noqa: E402
import page  # noqa: E402
import resting  # noqa: E402

CASES = [*resting.CASES, *inclines.CASES, *faces.CASES, *banks.CASES, *on_bed.CASES]


@dataclasses.dataclass
class Result:
    name: str
    dx: float
    rows: list
    control: list | None

    @property
    def title(self):
        return f"{self.name}, dx {self.dx:g}"

    @property
    def missed(self):
        return [row for row in self.rows if not row.ok]

    @property
    def tame(self):
        return self.control is not None and all(row.ok for row in self.control)


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder")
    parser.add_argument("cases", nargs="*", metavar="NAME")
    parser.add_argument("--quick", action="store_true", help="what ctest runs")
    parser.add_argument("--full", action="store_true", help="everything")
    parser.add_argument("--dx", type=measure.spacings, help="cell sizes [m] instead of the cases' own")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--set", type=measure.setting, action="append", default=[], metavar="KEY=VALUE", help="a level's key, dotted; repeatable")
    parser.add_argument("--control", action="store_true", help="run each case once more with settings with which it must miss a limit")
    parser.add_argument("--check", action="store_true", help="fail where a limit is missed, or where a control misses none")
    parser.add_argument("--page", action="store_true", help="write README.md and its picture from what was run")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at once")
    parser.add_argument("--work", metavar="DIR", help="keeps the runs there and takes them from there")
    parser.add_argument("--list", action="store_true", help="names of the cases and their cells")
    wanted = parser.parse_intermixed_args()
    if not (wanted.list or wanted.cases or wanted.quick or wanted.full):
        parser.error("say --quick, --full or the names of cases")
    return wanted


def chosen(wanted):
    """(case, dx) of all that is wanted."""
    for pattern in wanted.cases:
        if not any(fnmatch.fnmatch(case.name, pattern) for case in CASES):
            sys.exit(f"matrix.py: no case {pattern}")
    for case in CASES:
        if not wanted.cases or any(fnmatch.fnmatch(case.name, pattern) for pattern in wanted.cases):
            for dx in case.quick if wanted.quick else wanted.dx or case.dx:
                yield case, dx


def results(wanted, lab):
    # Threads for all: the lab itself holds back more runs than --jobs.
    with concurrent.futures.ThreadPoolExecutor(16) as pool:
        waiting = [(case, dx, pool.submit(case.measure, lab, dx), pool.submit(case.measure, lab.variant(case.control), dx) if wanted.control else None)
                   for case, dx in chosen(wanted)]
        for case, dx, rows, control in waiting:
            yield Result(case.name, dx, rows.result(), control and control.result())


def main():
    wanted = options()
    if wanted.list:
        print("\n".join(f"{case.name}  {' '.join(f'{dx:g}' for dx in case.dx)}{'  quick' if case.quick else ''}" for case in CASES))
        return 0
    done = []
    try:
        with tempfile.TemporaryDirectory(prefix="wadi_matrix_") as scratch:
            lab = scene.Lab(wanted.recorder, wanted.work or scratch, wanted.backend, dict(wanted.set), max(1, wanted.jobs))
            for result in results(wanted, lab):
                print("\n".join(table.lines(result.title, result.rows, result.control)), flush=True)
                done.append(result)
    except scene.RunError as error:
        sys.exit(f"matrix.py: {error}")
    wrong, tame = [result for result in done if result.missed], [result for result in done if result.tame]
    print(f"{len(done)} cases, {len(wrong)} are wrong{''.join(f'{chr(10)}  {result.title}' for result in wrong)}")
    for result in tame:
        print(f"  {result.title}: its control misses no limit")
    if wanted.page:
        page.write(HERE, done, lab)
    return 1 if wanted.check and (wrong or tame or not done) else 0


if __name__ == "__main__":
    sys.exit(main())
