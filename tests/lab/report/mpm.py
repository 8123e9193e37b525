#!/usr/bin/env python3
"""Columns of sand that collapse: Wadi beside the material point method in three dimensions. Errors, processor time of one thread, and
pictures into tests/lab/report/mpm (README.md there: between its two marks). Needs Taichi and numpy; exit status 77 without.

usage: tests/lab/report/mpm.py RECORDER [--work DIR] [--out DIR]
       tests/lab/report/mpm.py --check
--work keeps runs, so that one that was broken off goes on. --check: small columns against the kept profiles, with friction and, to fail,
without.
"""
import argparse
import csv
import dataclasses
import hashlib
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "sand"))
try:
    import mpm_solver
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing} (a Python with the package taichi runs this)")
    sys.exit(77)
import charts  # noqa: E402
import columns  # noqa: E402  scenes, references and measures of tests/lab/sand
import cuts  # noqa: E402
import shapes  # noqa: E402
import stamps  # noqa: E402
from scene import Lab, level  # noqa: E402

ASPECTS, HALF, STRIP = columns.ASPECTS, columns.HALF, columns.STRIP
END, EARLY = columns.TIMES[-1], 0.8  # [s]
FRICTION = 0.5
BARE = "Wadi, untuned"  # without internal friction and viscosity, which were chosen on columns like these
ROUNDS = 3  # runs of Wadi whose times are taken
BEGIN_MARK, END_MARK = "<!-- mpm.py writes from here -->\n", "<!-- to here -->\n"


@dataclasses.dataclass(frozen=True)
class Kind:
    title: str
    dimensions: int  # of MPM's space
    parts: int  # as much of the column MPM leaves out by symmetry
    run: object  # columns' (lab, dx, a, material) -> cells, run
    depth: object  # columns' (cells, hs) -> depths about the middle
    mpm_cells: tuple  # [m]
    wadi_cells: tuple = (0.4, 0.2, 0.1, 0.05)  # [m]


KINDS = {
    "axi": Kind("round", 3, 4, columns.axisymmetric, columns.rings, (0.4, 0.2, 0.1)),
    "planar": Kind("planar", 2, 2, columns.planar, columns.halves, (0.4, 0.2, 0.1, 0.05)),
}


@dataclasses.dataclass
class Result:
    """costs: processor time per simulated second of the whole column [ms]; depths: {time [s]: in rings or strips of STRIP [m]}."""
    kind: str
    aspect: float
    method: str
    cell: float
    count: int
    costs: list
    depths: dict

    def reference(self):
        return f"{self.kind}_triaxial_a{self.aspect:g}"

    def weights(self, count):
        return 2 * np.arange(count) + 1 if self.kind == "axi" else np.ones(count)

    def elsewhere(self):
        depth = self.depths[END]
        return columns.elsewhere(depth, columns.profile(self.reference(), len(depth)), self.weights(len(depth)))

    def toe(self, time=END):
        return columns.toe(self.depths[time])

    def centre(self):
        return float(np.average(self.depths[END][:5], weights=self.weights(5)))

    def quartiles(self):
        return np.percentile(self.costs, (25, 50, 75))


def by_mpm(kind, aspect, cell, friction=FRICTION):
    """One run; its costs are those of the stretches between the references' times, all of which do the same work."""
    column = mpm_solver.Column(KINDS[kind].dimensions, HALF, HALF * aspect, cell, friction, friction)
    column.warm()
    costs, depths, past = [], {}, 0.0
    for time in columns.TIMES:
        costs.append(1000 * column.advance(time) / (time - past) * KINDS[kind].parts)
        depths[time] = column.depths(STRIP)
        past = time
    return Result(kind, aspect, "MPM", cell, column.count * KINDS[kind].parts, costs, {time: depths[time] for time in (EARLY, END)})


def kept_by_mpm(work, kind, aspect, cell):
    version = hashlib.sha256((HERE / "mpm_solver.py").read_bytes()).hexdigest()[:16]
    file = work / f"mpm_{kind}_{aspect:g}_{cell:g}_{version}.json"
    if not file.exists():
        file.write_text(json.dumps(dataclasses.asdict(by_mpm(kind, aspect, cell)), default=lambda values: values.tolist()))
    kept = Result(**json.loads(file.read_text()))
    kept.depths = {float(time): np.array(depth) for time, depth in kept.depths.items()}
    return kept


def by_wadi(labs, kind, aspect, cell, method="Wadi"):
    done = [KINDS[kind].run(lab, cell, aspect, {}) for lab in labs]
    cells, run = done[0]
    costs = [1000 * each.summary["processor_seconds"] / END for _, each in done]
    depths = {time: KINDS[kind].depth(cells, run.field("hs", time)) for time in (EARLY, END)}
    return Result(kind, aspect, method, cell, cells["nx"] * cells["ny"], costs, depths)


def measured(labs, work):
    results = []
    bare = [lab.variant({"material.internal_friction": 0, "material.sand_viscosity": 0}) for lab in labs]
    ways = (lambda *key: by_wadi(labs, *key), lambda *key: by_wadi(bare, *key, BARE), lambda *key: kept_by_mpm(work, *key))
    for kind, what in KINDS.items():
        for aspect in ASPECTS:
            for make, cells in zip(ways, (what.wadi_cells, (0.1,), what.mpm_cells)):
                for cell in cells:
                    results.append(make(kind, aspect, cell))
                    last = results[-1]
                    print(f"{kind} a {aspect:g}: {last.method} {cell:g} m, {last.elsewhere():.1f} % elsewhere, {np.median(last.costs):.4g} ms", flush=True)
    return results


def cohesive_rows(lab):
    """(Rankine's height / the column's, method, cell, share of Rankine's wedge that left the column, toe [m], height of its middle [m])."""
    weight = cuts.DENSITY * cuts.GRAVITY * HALF
    for ratio in (0, 0.25, 0.5, 1, 2):
        cohesion = ratio * weight / (4 * cuts.passive(FRICTION))
        for cell in (0.1, 0.05):
            grid = {"nx": round(columns.PLANAR_BOX / cell), "ny": columns.ROWS, "dx": cell}
            sand = shapes.draw(grid, shapes.block(2 * HALF, 2 * columns.ROWS * cell, HALF))
            material = {"friction": FRICTION, "yield_friction": FRICTION, "sand_density": cuts.DENSITY, "cohesion_dry": cohesion}
            run = lab.run(level(grid, sand=[{"file": sand}], material=material), [cuts.SECONDS])
            column = mpm_solver.Column(2, HALF, HALF, cell, FRICTION, FRICTION, cohesion)
            column.advance(cuts.SECONDS)
            for method, depth in (("Wadi", columns.halves(grid, run.field("hs", cuts.SECONDS))), ("MPM", column.depths(STRIP))):
                left = (HALF - depth[: round(HALF / STRIP)]).sum() * STRIP / (HALF**2 / 2 / cuts.passive(FRICTION))
                yield ratio, method, cell, left, columns.toe(depth), depth[:5].mean()


def number(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|", *("| " + " | ".join(row) + " |" for row in rows)]


def result_rows(results):
    for one in results:
        low, middle, high = map(number, one.quartiles())
        yield [f"{one.method}, {one.cell:g} m", f"{one.count}", f"{one.elsewhere():.1f}", f"{one.toe():.1f}", f"{one.toe(EARLY):.1f}", f"{one.centre():.2f}",
               middle, f"{low} ... {high}"]


def cost_chart(kind, results):
    series = [(f"{method}, a = {aspect:g}", [(np.median(one.costs), one.elsewhere()) for one in results if (one.method, one.aspect) == (method, aspect)], style, n)
              for n, aspect in enumerate(ASPECTS) for method, style in (("Wadi", "line"), ("MPM", "dash"))]
    return charts.line_chart(f"Error against cost, {KINDS[kind].title} columns", "processor time per simulated second [ms]",
                             "sand elsewhere than in the fine MPM [%]", series, x_log=True, y_log=True)


def profile_chart(title, wadi, mpm):
    def points(depth):
        shown = np.nonzero(depth > 0.001)[0][-1] + 2
        return [((n + 0.5) * STRIP, float(value)) for n, value in enumerate(depth[:shown])]
    series = [("fine MPM, 0.04 m", points(columns.profile(mpm.reference(), len(mpm.depths[END]))), "line")]
    series += [(f"{one.method}, {one.cell:g} m, {number(np.median(one.costs))} ms", points(one.depths[END]), "line") for one in (wadi, mpm)]
    return charts.line_chart(f"{title}: {KINDS[mpm.kind].title} column, a = {mpm.aspect:g}, after {END} s", "distance from the middle [m]", "depth [m]", series)


def write_page(results, cohesive, out):
    out.mkdir(parents=True, exist_ok=True)
    lines = []
    with (out / "columns.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["kind", "aspect", "method", "cell_m", "count", "elsewhere_percent", "toe_m", f"toe_at_{EARLY:g}_s_m", "centre_m", "ms_quartile_1",
                         "ms_median", "ms_quartile_3"])
        for one in results:
            numbers = (one.elsewhere(), one.toe(), one.toe(EARLY), one.centre(), *one.quartiles())
            writer.writerow([one.kind, one.aspect, one.method, one.cell, one.count, *(f"{value:.4g}" for value in numbers)])
    for kind, what in KINDS.items():
        own = [one for one in results if one.kind == kind]
        (out / f"cost_{kind}.svg").write_text(cost_chart(kind, own))
        lines += [f"## {what.title.capitalize()} columns", "", f"![Error against cost](cost_{kind}.svg)", ""]
        for aspect in ASPECTS:
            mine = [one for one in own if one.aspect == aspect]
            past = columns.history(mine[0].reference())
            lines += [f"a = {aspect:g}; fine MPM: toe {past[END][1]:.1f} m, {past[EARLY][1]:.1f} m at {EARLY:g} s, centre {past[END][0]:.2f} m.", ""]
            head = ["", "particles or cells", "sand elsewhere [%]", "toe [m]", f"at {EARLY:g} s [m]", "centre [m]", "ms per simulated second", "quartiles"]
            lines += [*table(head, result_rows(mine)), ""]
        one_aspect = [one for one in own if one.aspect == 1]
        wadi, mpm = ([one for one in one_aspect if one.method == method] for method in ("Wadi", "MPM"))
        for mpm_cell, name, title in ((0.2, "cells", "Equal cells"), (0.4, "time", "About equal time")):
            other = next(one for one in mpm if one.cell == mpm_cell)
            near = {"cells": lambda one: abs(one.cell - mpm_cell), "time": lambda one: abs(np.log(np.median(one.costs) / np.median(other.costs)))}[name]
            (out / f"profile_{kind}_{name}.svg").write_text(profile_chart(title, min(wadi, key=near), other))
            lines += [f"![{title}](profile_{kind}_{name}.svg)", ""]
    lines += ["## Cohesive columns", "", f"Planar, a = 1, after {cuts.SECONDS} s, dry sand with cohesion.", ""]
    head = ["Rankine's height / the column's", "", "share of Rankine's wedge that left", "toe [m]", "centre [m]"]
    lines += table(head, [[f"{ratio:g}", f"{method}, {cell:g} m", f"{left:.2f}", f"{toe:.1f}", f"{centre:.2f}"] for ratio, method, cell, left, toe, centre in cohesive])
    lines += ["", stamps.stamp("mpm")]
    page = out / "README.md"
    text = page.read_text() if page.exists() else f"# Wadi beside the material point method\n\n{BEGIN_MARK}{END_MARK}"
    start, end = text.index(BEGIN_MARK) + len(BEGIN_MARK), text.index(END_MARK)
    page.write_text(text[:start] + "\n".join([*lines, ""]) + text[end:])


def check():
    """MPM's own small columns keep to the kept profiles, and without friction they do not."""
    good = True
    for kind, cell, limit in (("planar", 0.2, 6), ("axi", 0.4, 12)):
        for friction, wanted in ((FRICTION, True), (0.0, False)):
            moved = by_mpm(kind, 1, cell, friction).elsewhere()
            fine = (moved < limit) == wanted
            good &= fine
            print(f"{'OK  ' if fine else 'FAIL'} {kind}, friction {friction:g}: {moved:.1f} % elsewhere, {'under' if wanted else 'over'} {limit} wanted")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder", type=pathlib.Path, nargs="?")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "mpm")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.check:
        return 0 if check() else 1
    if options.recorder is None:
        parser.error("RECORDER is missing")
    with tempfile.TemporaryDirectory() as scratch:
        work = options.work or pathlib.Path(scratch)
        work.mkdir(parents=True, exist_ok=True)
        labs = [Lab(options.recorder, work / f"round_{n}") for n in range(ROUNDS)]
        write_page(measured(labs, work), list(cohesive_rows(labs[0])), options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
