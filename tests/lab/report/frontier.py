#!/usr/bin/env python3
"""What accuracy costs on grids of real sizes: error against milliseconds a frame, Wadi's settings beside the paper's own method, on cases whose
right answer comes from outside (frontier_cases.py). Writes README.md (between its two marks), results.csv and a chart per case and kind of
machine. Needs numpy, exit status 77 without.

usage: tests/lab/report/frontier.py BIN_FOLDER [--backend cpu] [--sizes 64 128 256 512] [--row-seconds S] [--processor-time] [--only CASE ...] [--out DIR]
       tests/lab/report/frontier.py --page [--out DIR]     the page anew, of rows that lie there
Rows lie in OUT/rows_cpu.jsonl and OUT/rows_gpu.jsonl: the page shows both, as far as they were measured with the sources as they are, and
a run that was broken off goes on.
"""
import argparse
import csv
import hashlib
import json
import math
import pathlib
import sys

import charts
import recordings
import stamps

try:
    import frontier_cases
except ImportError as missing:
    print(f"skipped: {missing} (Debian's package python3-numpy has it)")
    sys.exit(77)
from frontier_cases import CASES, np  # noqa: E402

FRAMES = 60  # a second
# (method preset, sand steps per water step, part of the case's time step); the paper's explicit drag wants shorter steps than ours.
METHODS = {"order 1": ("robust", 2, 1), "order 2": ("robust", 2, 1), "published": ("published", 3, 1), "published, dt/4": ("published", 3, 4)}
# By kind of machine: heading, milliseconds of a frame that the answer asks for, cells a side measured by default.
MACHINES = {"gpu": ("On a GPU", (0.1, 0.5, 2, 8), (256, 512, 1024, 2048, 4096)), "cpu": ("On a CPU", (0.25, 1, 4, 16), (64, 128, 256, 512))}
BEGIN_MARK, END_MARK = "<!-- frontier.py writes from here -->\n", "<!-- to here -->\n"
HERE = pathlib.Path(__file__).resolve().parent


class Store:
    """Rows by point in a file of JSON lines: a run that was broken off goes on where it stopped."""

    def __init__(self, path, stamp):
        self.path, self.stamp, self.rows = path, stamp, {}
        self.gap = ""
        if path.exists():
            self.gap = "" if path.read_text().endswith("\n") else "\n"
            for line in path.read_text().splitlines():
                try:
                    row = json.loads(line)
                except json.JSONDecodeError:
                    continue  # broken off in mid-line
                if row.get("stamp") == stamp:
                    self.rows[row["point"]] = row

    def add(self, row):
        self.rows[row["point"]] = row
        with self.path.open("a") as file:
            file.write(self.gap + json.dumps({**row, "stamp": self.stamp}) + "\n")
        self.gap = ""


def undominated(rows):
    """Of rows with an error those that no other beats in both error and time, by time."""
    best, result = math.inf, []
    for row in sorted((r for r in rows if r["error"] is not None), key=lambda r: (r["ms_per_frame"], r["error"])):
        if row["error"] < best:
            best = row["error"]
            result.append(row)
    return result


def level_of(case, n, method):
    preset, substeps, part = METHODS[method]
    level = {**case.level(n), "dt": case.step * case.length / n / part}
    return recordings.choose(level, name=preset, substeps=substeps, **(case.order if method == "order 2" else {}))


def measure(recorder, key, n, method):
    """A row. error None: the state is no number any more, or was refused, `why` says it."""
    case, preset = CASES[key], METHODS[method][0]
    level = level_of(case, n, method)
    files = {name: (n, n, np.ascontiguousarray(values, "f4").ravel()) for name, values in case.files(n).items()}
    row = {"case": key, "n": n, "method": method, "dt": level["dt"], "error": None}
    try:
        run, summary = recorder.record(level, seconds=case.seconds, times=(case.seconds,), fields=(case.field,), files=files)
    except recordings.Failed as failure:
        return {**row, "why": str(failure).strip().splitlines()[-1]}
    now = np.asarray(run.field(case.field, case.seconds)).reshape(n, n)
    steps = summary["steps"]
    row |= {"device": summary["device"]["name"], "steps": steps, "stepping_seconds": summary["stepping_seconds"], "ms_per_step": summary["ms_per_step"],
            "ms_per_frame": 1000 * summary["stepping_seconds"] / summary["simulated_seconds"] / FRAMES}
    if summary["counts"]["not_finite"]["largest"] or not np.isfinite(now).all():
        return {**row, "why": "ends in values that are no numbers"}
    capped = summary["counts"]["capped_faces"]["largest"]
    if capped and preset == "robust":
        return {**row, "why": f"gravity is capped at {capped} faces: the case's time step is too long for what it shows"}
    error = case.error(now, run.dx, summary["simulated_seconds"])
    return {**row, "error": error} if math.isfinite(error) else {**row, "why": "its error is no number"}


def preset_of(row, middle):
    """The preset by which a level of `middle` cells a side has the settings of this row, or None."""
    return {(middle // 2, "order 1"): "draft", (middle, "order 1"): "balanced", (2 * middle, "order 2"): "accurate"}.get((row["n"], row["method"]))


def name_of(row, middle):
    preset = preset_of(row, middle)
    return f"{row['n']}², {row['method']}" + (f" (`{preset}` of {middle}²)" if preset else "")


def percent(value):
    return f"{value:.2g} %" if value < 10 else f"{value:.0f} %"


def best_within(rows, budget, preset):
    """The row of least error that fits a budget, of one method preset."""
    fit = [row for row in rows if row["error"] is not None and row["ms_per_frame"] <= budget and METHODS[row["method"]][0] == preset]
    return min(fit, key=lambda row: row["error"], default=None)


def answer(rows, budgets):
    """The table at the top: per case and budget the settings of least error, and below them the paper's own method for the same time."""
    lines = ["| what moves | " + " | ".join(f"{budget:g} ms a frame" for budget in budgets) + " |", "| --- " + "| --- " * len(budgets) + "|"]
    for key, case_rows in rows.items():
        for preset, name in (("robust", CASES[key].of), ("published", "the paper's own method")):
            found = [best_within(case_rows, budget, preset) for budget in budgets]
            lines.append(f"| {name} | " + " | ".join("-" if row is None else f"{percent(row['error'])}: {row['n']}², {row['method']}" for row in found) + " |")
    return lines


def conclusion(rows, middle):
    """One sentence per case, from the numbers: what twice the cells and order 2 buy, and where the paper's own method ends."""
    lines = []
    for key, case_rows in rows.items():
        at = {(row["n"], row["method"]): row for row in case_rows if row["error"] is not None}
        base, finer, second = (at.get(place) for place in ((middle, "order 1"), (2 * middle, "order 1"), (middle, "order 2")))
        paper = min((row for row in case_rows if row["n"] == 2 * middle and METHODS[row["method"]][0] == "published" and row["error"] is not None), key=lambda row: row["error"], default=None)
        if not (base and finer and second):
            continue
        text = (f"- **{CASES[key].of}** (`{key}`): {percent(base['error'])} on {middle}² cells; twice the cells along x and y leave {finer['error'] / base['error']:.2f} of it for "
                f"{finer['ms_per_frame'] / base['ms_per_frame']:.1f} times the time, order 2 leaves {second['error'] / base['error']:.2f} for {second['ms_per_frame'] / base['ms_per_frame']:.2g} times. ")
        left_out = [row for row in case_rows if row["n"] == 2 * middle and METHODS[row["method"]][0] == "published" and row.get("left_out")]
        text += (f"The paper's own method errs by {percent(paper['error'])} on {2 * middle}² cells for {paper['ms_per_frame'] / finer['ms_per_frame']:.2g} times order 1's time." if paper
                 else f"The paper's own method was left out on {2 * middle}² cells." if left_out else f"The paper's own method does not last on {2 * middle}² cells.")
        lines.append(text)
    return lines


def chart_of(case, kind, rows, middle):
    good = [row for row in rows if row["error"] is not None]
    series = [(method, sorted((row["ms_per_frame"], row["error"]) for row in good if row["method"] == method), "line" if METHODS[method][0] == "robust" else "dash") for method in METHODS]
    named = [(row["ms_per_frame"], row["error"], f"{preset_of(row, middle)} of {middle}²") for row in good if preset_of(row, middle)]
    return charts.line_chart(f"{case.title}: error against time, {kind.upper()}", f"ms a frame of 1/{FRAMES} s", "error [%]", [one for one in series if one[1]], x_log=True, y_log=True, named=named)


def table_of(rows, middle):
    on = {(row["n"], row["method"]) for row in undominated(rows)}
    lines = ["| settings | error [%] | ms a frame | ms a step | on the frontier |", "| --- | ---: | ---: | ---: | --- |"]
    for row in rows:
        if row["error"] is None:
            lines.append(f"| {name_of(row, middle)} | {row['why']} | | | |")
        else:
            lines.append(f"| {name_of(row, middle)} | {row['error']:.3g} | {row['ms_per_frame']:.3g} | {row['ms_per_step']:.3g} | {'yes' if (row['n'], row['method']) in on else ''} |")
    return lines


def middle_of(rows):
    sizes = sorted({row["n"] for case_rows in rows.values() for row in case_rows})
    return sizes[(len(sizes) - 1) // 2]


def kept_rows(out):
    """{kind of machine: {case: rows}} that the sources as they are have made, in order."""
    machines = {}
    for kind in MACHINES:
        path, rows = out / f"rows_{kind}.jsonl", {}
        latest = {row["point"]: row for row in map(json.loads, path.read_text().splitlines() if path.exists() else ()) if row["sources"] == stamps.state("frontier")}
        for key in CASES:
            rows[key] = sorted((row for row in latest.values() if row["case"] == key), key=lambda row: (row["n"], list(METHODS).index(row["method"])))
        rows = {key: case_rows for key, case_rows in rows.items() if any(row["error"] is not None for row in case_rows)}
        if rows:
            machines[kind] = rows
        elif path.exists():
            print(f"{path}: of other sources, left out of the page")
    return machines


def write(out, machines):
    lines = []
    for kind, rows in machines.items():
        heading, budgets, _ = MACHINES[kind]
        of = next(row for case_rows in rows.values() for row in case_rows if "device" in row)
        lines += [f"## {heading}", "", f"{of['device']}; {of['times']}, frames of 1/{FRAMES} s.", "", *answer(rows, budgets), "", *conclusion(rows, middle_of(rows)), ""]
    for key, case in CASES.items():
        if any(key in rows for rows in machines.values()):
            lines += [f"## {case.of.capitalize()}: {case.title[0].lower()}{case.title[1:]}", "", f"Truth: {case.truth}. `{key}`, {case.length:g} m a side, {case.seconds:.3g} s.", ""]
        for kind, rows in machines.items():
            if key in rows:
                (out / f"{key}_{kind}.svg").write_text(chart_of(case, kind, rows[key], middle_of(rows)))
                lines += [f"![{key} on a {kind.upper()}]({key}_{kind}.svg)", "", *table_of(rows[key], middle_of(rows)), ""]
    with (out / "results.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ["case", "n", "method", "dt", "steps", "ms_per_step", "ms_per_frame", "error", "device", "why"], extrasaction="ignore")
        writer.writeheader()
        for rows in machines.values():
            for case_rows in rows.values():
                writer.writerows(case_rows)
    page = out / "README.md"
    head, tail = (page if page.exists() else HERE / "frontier" / "README.md").read_text().split(BEGIN_MARK)
    tail = tail.split(END_MARK)[1]
    tail = stamps.STAMP.sub("", tail).strip()
    page.write_text(head + BEGIN_MARK + "\n".join(lines) + END_MARK + (tail + "\n" if tail else "") + "\n" + stamps.stamp("frontier") + "\n")


def too_long(done, limit):
    """Why the next size of a method is left out, or "". done: its rows so far, sizes ascending."""
    if done and done[-1].get("left_out"):
        return "left out like the size below"
    times = [row["stepping_seconds"] for row in done if row["error"] is not None]
    if len(times) < 2:
        return ""
    seconds = times[-1] * min(8, 1.5 * times[-1] / times[-2])  # four times the cells in half the step, once a device is full
    return f"left out: some {seconds:.0f} s, the limit was {limit:g} s" if seconds > limit else ""


def measure_all(recorder, store, options):
    for key in options.only:
        done = {method: [] for method in METHODS}
        for n in sorted(options.sizes):
            for method in METHODS:
                point = f"{key}@{n},{method}"
                if point not in store.rows or store.rows[point].get("left_out"):
                    why = too_long(done[method], options.row_seconds)
                    row = {"case": key, "n": n, "method": method, "error": None, "why": why, "left_out": True} if why else measure(recorder, key, n, method)
                    times = "processor time of one thread" if options.processor_time else "time of stepping alone"
                    store.add({**row, "point": point, "sources": stamps.state("frontier"), "times": times})
                row = store.rows[point]
                done[method].append(row)
                print(f"{point}: " + (row["why"] if row["error"] is None else f"{row['error']:.3g} %, {row['ms_per_frame']:.3g} ms a frame"), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path, nargs="?")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--sizes", nargs="+", type=int, metavar="N", help="cells a side (default " + ", ".join(" ".join(map(str, sizes)) + f" {head.lower()}" for head, _, sizes in MACHINES.values()) + ")")
    parser.add_argument("--row-seconds", type=float, default=math.inf, metavar="S", help="leave out rows that would step for longer, and say so on the page")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the CPU backend (default 0: all cores)")
    parser.add_argument("--processor-time", action="store_true", help="times are processor time of one thread: for a busy machine, CPU backend alone")
    parser.add_argument("--only", nargs="+", choices=CASES, default=list(CASES), metavar="CASE", help=f"of {', '.join(CASES)}")
    parser.add_argument("--page", action="store_true", help="measure nothing")
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "frontier")
    options = parser.parse_args()
    kind = "cpu" if options.backend == "cpu" else "gpu"
    options.sizes = options.sizes or MACHINES[kind][2]
    if options.page == bool(options.programs):
        parser.error("want the programs' folder or --page")
    if options.processor_time and kind != "cpu":
        parser.error("--processor-time: of the CPU backend alone")
    if min(options.sizes) < 16 or len(options.sizes) < 2:
        parser.error(f"--sizes: want two or more, each 16 or more, got {' '.join(map(str, options.sizes))}")
    options.out.mkdir(parents=True, exist_ok=True)
    if options.programs:
        program = options.programs / "wadi-recorder"
        version = hashlib.sha256(program.read_bytes() + stamps.state("frontier").encode()).hexdigest()[:16]
        store = Store(options.out / f"rows_{kind}.jsonl", f"{options.backend} {options.threads} {options.processor_time} {version}")
        with recordings.Recorder(program, options.backend, 1 if options.processor_time else options.threads, options.processor_time) as recorder:
            measure_all(recorder, store, options)
    machines = kept_rows(options.out)
    if not machines:
        print("FAILED: no run came to an end")
        return 1
    write(options.out, machines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
