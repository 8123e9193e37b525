#!/usr/bin/env python3
"""The paper's tables from our own runs: time per stage and step of its six scenes (Table 2), time and memory by grid size (its supplement's
Figure 4), and what several sand substeps per water step save and cost (its supplement's section 2); what second order for water and the
accuracy presets cost. Writes CSVs, charts and the generated part of tests/lab/report/timings/README.md, section by section.

usage: tests/lab/report/timings.py BIN_FOLDER [--backends cuda,vulkan,cpu] [--threads 2] [--largest 4096] [--steps 200 | --quick] [--only table_2 scaling order presets budget asynchronous] [--out DIR]
"""
import argparse
import csv
import math
import pathlib
import sys

import charts
import prices
import recordings
import stamps
from side_by_side import METHODS, number, table

SCENES = {  # the paper's grids; its time steps do not fit our grids' lengths
    "castle": (1024, 512), "spring": (1024, 1024), "dam_break": (512, 512), "seepage": (1024, 512), "flush": (1024, 1024), "canyon": (800, 1024)}
PAPER = {  # Table 2: percent per row, then ms per step on the authors' GPU
    "castle": (1.2, 1.1, 3.8, 6.2, 40.5, 5.7, 6.1, 2.1, 33.5, 0.73), "spring": (1.7, 1.1, 4.0, 4.8, 44.5, 5.4, 8.4, 1.8, 28.2, 2.16),
    "dam_break": (1.4, 2.0, 3.0, 6.7, 44.1, 8.9, 6.7, 2.8, 24.6, 0.46), "seepage": (0.9, 1.0, 2.8, 6.2, 40.5, 6.0, 7.4, 2.1, 33.1, 3.54),
    "flush": (1.3, 0.9, 4.0, 5.2, 45.5, 5.7, 6.7, 1.9, 28.6, 2.04), "canyon": (0.8, 0.9, 3.0, 4.8, 38.4, 5.2, 6.2, 1.8, 38.9, 0.61)}
ROWS = {  # the paper's rows and the stages that do their work
    "diffuse and integrate water": ("diffuse_mixed_water", "diffuse_mixed_velocity", "diffuse_mixed_height", "spread_mixed_water", "limit_water_outflow",
                                    "compute_water_flux", "integrate_water_height"),
    "integrate water velocity": ("integrate_water_velocity", "backtrace_water_velocity", "push_mixed_water"),
    "integrate sand height": ("limit_sand_outflow", "compute_sand_flux", "integrate_sand_height", "compute_bed_load"),
    "integrate sand velocity": ("integrate_sand_velocity", "backtrace_sand_velocity", "push_sand", "compute_sand_stress", "apply_sand_stress"),
    "project deformation gradient": ("project_deformation_gradient", "yield_right_stretch"),
    "evolve deformation gradient": ("evolve_deformation_gradient", "advect_deformation_gradient", "stretch_deformation_gradient"),
    "compute momentum exchange": ("compute_momentum_exchange", "measure_layer_exchange", "give_layer_exchange"),
    "apply frictional force": ("apply_friction",),
    "update boundary conditions": ("update_water_boundary_types", "update_sand_boundary_types", "extrapolate_velocity",
                                   "extrapolate_strain", "open_sides", "open_sand_sides")}
REST = "saturation, sources, ledger"  # no row of the paper's
ASYNC = {"level": "spring", "size": (128, 128), "seconds": 4, "sand_substep": 0.004, "ratios": (1, 2, 3, 4, 6), "baseline": 5e-4}
ORDER_SIZES = {"cpu": (512, 1024), "": (512, 1024, 4096)}  # by backend, "": any other
PRESET_SIZE = 1024  # cells along a side of `balanced`
BUDGET = {"level": "beach", "seconds": 10, "sizes": (256, 512, 1024), "truth": 2048, "substeps": 2, "frames": 60}  # frames per second
PAIRS = 3  # pairs of runs of a ratio
SECTIONS = ("table_2", "scaling", "order", "presets", "budget", "asynchronous")
BEGIN, END = "<!-- timings.py writes from here -->\n", "<!-- to here -->\n"


def shares(summary):
    """Percent of the stages' time by the paper's rows."""
    stages = {stage["name"]: stage["ms"] for stage in summary["stages"]}
    total = math.fsum(stages.values())
    result = {row: 100 * math.fsum(stages.pop(name, 0) for name in names) / total for row, names in ROWS.items()}
    return {**result, REST: 100 * math.fsum(stages.values()) / total}


def steps_seconds(level, size, steps):
    """What `steps` steps of the level at this size last [s]: dt follows the cells' size (samples/levels/README.md, Another size)."""
    own = recordings.read_level(level)
    return steps * own["dt"] * own["grid"]["nx"] / size[0]


def table_two(recorders, shrink, steps):
    """[(backend, method, level, shares, ms per step, device)]"""
    rows = []
    for backend, recorder in recorders.items():
        for level, size in SCENES.items():
            size = tuple(n // shrink for n in size)
            for method in METHODS:
                count = steps if backend != "cpu" else max(5, steps // 20)
                seconds = steps_seconds(level, size, count)
                _, timed = recorder.record(level, size=size, method=method, seconds=seconds, benchmark=True)
                _, profiled = recorder.record(level, size=size, method=method, seconds=seconds, profile=True, benchmark=True, fused=-1)  # the rows are of stages
                rows.append((backend, method, level, shares(profiled), timed["ms_per_step"], timed["device"]["name"]))
                print(f"table 2: {backend} {level} {method}: {timed['ms_per_step']:.3f} ms per step", flush=True)
    return rows


def scaling(recorders, largest, steps):
    """[(backend, method, n, ms per step, device bytes)] of dam_break on n x n cells."""
    rows = []
    for backend, recorder in recorders.items():
        n = 128
        while n <= largest:
            for method in METHODS:
                seconds = steps_seconds("dam_break", (n, n), counted(backend, n, steps))
                _, summary = recorder.record("dam_break", size=(n, n), method=method, seconds=seconds, benchmark=True)
                rows.append((backend, method, n, summary["ms_per_step"], summary["device_bytes"]))
                print(f"scaling: {backend} {n} {method}: {summary['ms_per_step']:.3f} ms per step", flush=True)
            n *= 2
    return rows


def device_name(recorder):
    """What a recording's summary calls the device."""
    return recorder.record("dam_break", size=(16, 16), seconds=0)[1]["device"]["name"]


def counted(backend, n, steps):
    """How many steps to time on n x n cells."""
    return max(5, min(steps, steps // 20 * 2**20 // (n * n))) if backend == "cpu" else max(steps // 4, min(steps, steps * 2**20 // (n * n)))


def dam_break(sand):
    level = recordings.read_level("dam_break")
    return level if sand else {key: value for key, value in level.items() if key != "sand"}


def orders(recorders, largest, steps):
    """[(backend, what, n, Price of order 2)] of dam_break on n x n cells, whole and as water alone."""
    rows = []
    for backend, recorder in recorders.items():
        for n in [size for size in ORDER_SIZES.get(backend, ORDER_SIZES[""]) if size <= largest] or [largest]:
            seconds = steps_seconds("dam_break", (n, n), counted(backend, n, steps))
            for what, sand in (("all effects", True), ("water alone", False)):
                level = dam_break(sand)

                def run(order, level=level, n=n, seconds=seconds, recorder=recorder):
                    return recorder.record(recordings.choose(level, water_transport_order=order), size=(n, n), seconds=seconds, benchmark=True)[1]

                price = prices.paired(lambda: run(1), {"2": lambda: run(2)}, PAIRS)["2"]
                rows.append((backend, what, n, price))
                print(f"order of water: {backend} {n} {what}: {price.base_ms:.3f} ms per step, order 2 {price.ratio:.3f} times that", flush=True)
    return rows


def preset_costs(recorders, largest, steps):
    """[(backend, preset, cells along a side of balanced, Price: time per simulated second over that of balanced)] of dam_break."""
    rows = []
    base = min(PRESET_SIZE, largest // 2)
    level = dam_break(True)
    finer = base / level["grid"]["nx"]
    level = {**level, "grid": {"nx": base, "ny": base, "dx": level["grid"]["dx"] / finer}, "dt": level["dt"] / finer}  # --size would outdo the preset's cells
    for backend, recorder in recorders.items():
        def run(preset, recorder=recorder, seconds=counted(backend, 2 * base, steps) * level["dt"]):
            _, summary = recorder.record(level, accuracy=preset, seconds=seconds, benchmark=True)
            return {**summary, "ms_per_step": 1000 * summary["stepping_seconds"] / summary["simulated_seconds"]}  # paired() compares this key

        costs = prices.paired(lambda: run("balanced"), {preset: lambda preset=preset: run(preset) for preset in ("draft", "accurate")}, PAIRS)
        for preset, price in costs.items():
            rows.append((backend, preset, base, price))
            print(f"presets: {backend} {preset} on {base}: {price.ratio:.3f} times the time of balanced", flush=True)
    return rows


def averaged(values, nx, ny, to_nx):
    """Means over blocks: a finer field on a coarser grid."""
    f = nx // to_nx
    result = []
    for top in range(0, ny // f * f, f):
        rows = [values[j * nx:(j + 1) * nx] for j in range(top, top + f)]
        result += [math.fsum(cell) / (f * f) for cell in zip(*(row[a::f] for row in rows for a in range(f)))]
    return result


def mean_error(run, baseline, name, time):
    """Mean absolute difference of a surface, in percent of the range over which the baseline moved it, as means over the run's cells."""
    now = run.field(name, time)
    then, start = (averaged(baseline.field(name, at), baseline.nx, baseline.ny, run.nx) for at in (time, 0))
    moved = [b - a for a, b in zip(start, then)]
    return 100 * math.fsum(abs(a - b) for a, b in zip(now, then)) / len(then) / (max(moved) - min(moved))


def asynchronous(recorder, method, ratios):
    """[(what is fixed, T, water step, sand substep, MAE of sand, MAE of water, ms per simulated second)], the baseline's own error last."""
    level = recordings.read_level(ASYNC["level"])
    end = ASYNC["seconds"]

    def run(dt, ratio):
        made = recordings.choose(level, substeps=ratio)
        return recorder.record(made, method=None if method == "robust" else method, size=ASYNC["size"], dt=dt, seconds=end, times=(0, end),
                               fields=("hs", "surface"))

    baseline, _ = run(ASYNC["baseline"], 1)
    rows = []
    for fixed in ("sand substep", "water step"):
        for ratio in ratios:
            dt = ASYNC["sand_substep"] * (ratio if fixed == "sand substep" else 1)
            recorded, summary = run(dt, ratio)
            rows.append((fixed, ratio, dt, dt / ratio, mean_error(recorded, baseline, "hs", end), mean_error(recorded, baseline, "surface", end),
                         1000 * summary["stepping_seconds"] / summary["simulated_seconds"]))
            print(f"asynchronous: {method} {fixed} fixed, T = {ratio}: {rows[-1][4]:.2f} % sand, {rows[-1][5]:.2f} % water", flush=True)
    coarser, summary = run(2 * ASYNC["baseline"], 1)
    rows.append(("baseline at twice its step", 1, 2 * ASYNC["baseline"], 2 * ASYNC["baseline"], mean_error(coarser, baseline, "hs", end),
                 mean_error(coarser, baseline, "surface", end), 1000 * summary["stepping_seconds"] / summary["simulated_seconds"]))
    return rows


def write_csv(path, head, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows(rows)


def two_text(rows, out):
    names = [*ROWS, REST]
    write_csv(out / "table_2.csv", ["backend", "method", "level", *names, "ms_per_step", "device"],
              [[b, m, level, *(f"{part[name]:.2f}" for name in names), f"{ms:.4f}", device] for b, m, level, part, ms, device in rows])
    lines = ["## Table 2: share of each part of a step, time per step", "", "Shares: of stages run one by one; time per step: as the device runs them (`fused_stages` auto).", ""]
    lines += ["### paper", "", *table(["part [%]", *SCENES], [[name, *(f"{PAPER[level][n]:g}" for level in SCENES)] for n, name in enumerate(ROWS)]
                                      + [["ms per step", *(f"{PAPER[level][-1]:g}" for level in SCENES)]]), ""]
    for backend in dict.fromkeys(row[0] for row in rows):
        for method in METHODS:
            mine = {row[2]: row for row in rows if row[:2] == (backend, method)}
            body = [[name, *(f"{mine[level][3][name]:.1f}" for level in SCENES)] for name in names]
            body.append(["**ms per step**", *(f"**{number(mine[level][4])}**" for level in SCENES)])
            lines += [f"### {method}, {backend}: {mine['castle'][5]}", "", *table(["part [%]", *SCENES], body), ""]
    return lines


def scaling_text(rows, out):
    write_csv(out / "scaling.csv", ["backend", "method", "n", "ms_per_step", "device_bytes"], rows)
    sizes = sorted({row[2] for row in rows})
    series = [(f"{method}, {backend}", [(n, ms) for b, m, n, ms, _ in rows if (b, m) == (backend, method)], "line" if method == "robust" else "dash")
              for backend in dict.fromkeys(row[0] for row in rows) for method in METHODS]
    (out / "time.svg").write_text(charts.line_chart("Dam break: time per step", "cells along a side", "ms", series, x_log=True, y_log=True, x_marks=sizes))
    first = rows[0][0]  # memory is the same on every backend
    memory = [(method, [(n, size / 2**20) for b, m, n, _, size in rows if (b, m) == (first, method)], "line") for method in METHODS]
    (out / "memory.svg").write_text(charts.line_chart("Dam break: memory of the world", "cells along a side", "MiB", memory, x_log=True, y_log=True, x_marks=sizes))
    body = [[f"{n}²", *(next((f"{number(ms)} ms, {number(size / 2**20)} MiB" for b, m, k, ms, size in rows if (b, m, k) == (backend, method, n)), "")
                        for backend in dict.fromkeys(row[0] for row in rows) for method in METHODS)] for n in sizes]
    head = ["grid", *(f"{method}, {backend}" for backend in dict.fromkeys(row[0] for row in rows) for method in METHODS)]
    return ["## Time and memory by grid size", "", "`dam_break`, T = 3.", "", *table(head, body), "", "![time](time.svg)", "", "![memory](memory.svg)", ""]


def pairs_table(head, rows):
    return table(head, [[*row, number(price.base_ms), f"{price.ratio:.3g} ({price.low:.3g} to {price.high:.3g})"] for *row, price in rows])


def budget(recorder, shrink):
    """[(n, order of water, ms per step, steps per frame, error of sand, of the water surface)] of a shipped level on n x n cells, against itself on
    the finest with order 2. shrink: divides cells and time."""
    seconds = BUDGET["seconds"] / shrink

    def run(n, order):
        level = recordings.choose(recordings.read_level(BUDGET["level"]), substeps=BUDGET["substeps"], water_transport_order=order)
        return recorder.record(level, size=(n, n), seconds=seconds, times=(0, seconds), fields=("hs", "surface"))

    truth, _ = run(BUDGET["truth"] // shrink, 2)
    rows = []
    for n in (size // shrink for size in BUDGET["sizes"]):
        for order in (1, 2):
            recorded, summary = run(n, order)
            errors = [mean_error(recorded, truth, name, seconds) for name in ("hs", "surface")]
            rows.append((n, order, summary["ms_per_step"], summary["steps"] / seconds / BUDGET["frames"], *errors))
            print(f"budget: {n}, order {order}: {rows[-1][2]:.3f} ms per step, {rows[-1][3]:.2f} steps per frame, {errors[0]:.2f} % sand, {errors[1]:.2f} % water", flush=True)
    return rows


def budget_text(rows, out, backend, shrink):
    write_csv(out / "budget.csv", ["n", "order", "ms_per_step", "steps_per_frame", "mae_sand_percent", "mae_water_percent"], rows)
    return ["## A level on a frame's budget", "", f"`{BUDGET['level']}` on n x n cells, {BUDGET['substeps']} sand substeps per water step, {BUDGET['frames']} frames a second, on {backend}. Error: mean absolute "
            f"difference after {BUDGET['seconds'] / shrink:g} s from the same level on {BUDGET['truth'] // shrink}² cells with order 2, in percent of the range over which the surface moved.", "",
            *table(["grid", "order of water", "ms per step", "steps per frame", "ms per frame", "sand [%]", "water surface [%]"],
                   [[f"{n}²", str(order), number(ms), f"{steps:.2f}", number(ms * steps), f"{sand:.2f}", f"{water:.2f}"] for n, order, ms, steps, sand, water in rows]), ""]


def orders_text(rows, out):
    write_csv(out / "order.csv", ["backend", "what", "n", "ms_per_step_order_1", "order_2_over_1", "low", "high"],
              [[*row, f"{price.base_ms:.5f}", *(f"{value:.4f}" for value in (price.ratio, price.low, price.high))] for *row, price in rows])
    return ["## Second order for water", "", f"`dam_break` with T = 3, whole and without its sand. Median and quartiles of {PAIRS} pairs of runs in turn.", "",
            *pairs_table(["backend", "effects", "grid", "ms per step, order 1", "order 2 over 1"], [(b, what, f"{n}²", price) for b, what, n, price in rows]), ""]


def presets_text(rows, out):
    write_csv(out / "presets.csv", ["backend", "preset", "n", "ms_per_second_balanced", "over_balanced", "low", "high"],
              [[*row, f"{price.base_ms:.5f}", *(f"{value:.4f}" for value in (price.ratio, price.low, price.high))] for *row, price in rows])
    return ["## Accuracy presets", "", f"Time per simulated second of `dam_break`, `balanced` on the cells that the row says (`draft` half, `accurate` twice as many along a side, with second order "
            f"for water), and over that of `balanced`. Median and quartiles of {PAIRS} pairs of runs in turn.", "",
            *pairs_table(["backend", "preset", "grid of balanced", "ms per second, balanced", "over balanced"], [(b, preset, f"{n}²", price) for b, preset, n, price in rows]), ""]


def async_text(by_method, out, backend):
    head = ["method", "fixed", "T", "water_step_s", "sand_step_s", "mae_sand_percent", "mae_water_percent", "ms_per_second"]
    write_csv(out / "asynchronous.csv", head, [[method, *row] for method, rows in by_method.items() for row in rows])
    lines = ["## Several sand substeps per water step", "",
             f"`{ASYNC['level']}` on {ASYNC['size'][0]} x {ASYNC['size'][1]} cells, {ASYNC['seconds']} s, on {backend}. Mean absolute error against the same method at T = 1 with a step of "
             f"{ASYNC['baseline']:g} s, in percent of the range over which the surface moved; time per simulated second, and what it saves against T = 1.", ""]
    for method, rows in by_method.items():
        first = {row[0]: row[6] for row in reversed(rows)}
        lines += [f"### {method}", "", *table(["fixed", "T", "water step [s]", "sand substep [s]", "sand [%]", "water surface [%]", "ms per second", "saved [%]"],
                                              [[row[0], str(row[1]), f"{row[2]:.3g}", f"{row[3]:.3g}", f"{row[4]:.2f}", f"{row[5]:.2f}", number(row[6]),
                                                f"{100 * (1 - row[6] / first[row[0]]):.0f}"] for row in rows]), ""]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--backends", default="cpu")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the CPU backend (default 0: all cores)")
    parser.add_argument("--largest", type=int, default=4096)
    parser.add_argument("--steps", type=int, default=200, help="of the timed runs on GPUs; a twentieth on the CPU")
    parser.add_argument("--quick", action="store_true", help="grids an eighth as wide, few steps: shows that the script runs, measures nothing")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, default=SECTIONS, metavar="SECTION", help=f"of {', '.join(SECTIONS)}; the page has these alone")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent / "timings")
    options = parser.parse_args()
    shrink, largest, steps, sand_substeps = (8, 128, 20, (1, 3)) if options.quick else (1, options.largest, options.steps, ASYNC["ratios"])
    options.out.mkdir(parents=True, exist_ok=True)
    page, kept = options.out / "README.md", pathlib.Path(__file__).resolve().parent / "timings" / "README.md"
    text = (page if page.exists() else kept).read_text()
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    recorders = {backend: recordings.Recorder(options.programs / "wadi-recorder", backend, options.threads) for backend in options.backends.split(",")}
    first = next(iter(recorders.values()))
    ratio_of = {backend: recorder for backend, recorder in recorders.items() if recorder is first or backend == "cpu"}
    sections = {
        "table_2": lambda: two_text(table_two(recorders, shrink, steps), options.out),
        "scaling": lambda: scaling_text(scaling(recorders, largest, steps), options.out),
        "order": lambda: orders_text(orders(ratio_of, largest, steps), options.out),
        "presets": lambda: presets_text(preset_costs(ratio_of, largest, steps), options.out),
        "budget": lambda: budget_text(budget(first, shrink), options.out, first.backend, shrink),
        "asynchronous": lambda: async_text({method: asynchronous(first, method, sand_substeps) for method in METHODS}, options.out, first.backend)}
    try:
        lines = ["Measured on " + "; ".join(f"{backend}: {device_name(recorder)}" for backend, recorder in recorders.items()) + ".", ""]
        for section in options.only:
            lines += sections[section]()
            page.write_text(text[:start] + "\n".join(lines) + text[end:])
        tail = stamps.STAMP.sub("", text[end:]).rstrip()
        page.write_text(text[:start] + "\n".join(lines) + tail + "\n\n" + stamps.stamp("timings") + "\n")
    finally:
        for recorder in recorders.values():
            recorder.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
