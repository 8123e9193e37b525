"""A report's pages: README.md with charts beside it, and the same as one self-contained HTML file."""
import html
import math
import re

import charts
import scenes
import stamps
from prices import LEDGER_LEVEL as LEVEL, LEDGER_PASSES as PASSES, WATER_LEVEL
import sweep
from scene import NORMS


def number(value):
    if value is None:
        return "not finite"
    return "0" if value == 0 else f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def as_html(text):
    """Of Markdown what the pages use: `code`."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))


class Page:
    """Collects headings, paragraphs, tables and charts; writes Markdown and HTML."""

    def __init__(self, out):
        self.out, self.markdown, self.html = out, [], []

    def heading(self, text, level=2):
        self.markdown += ["#" * level + " " + text, ""]
        self.html.append(f"<h{level}>{as_html(text)}</h{level}>")

    def text(self, text):
        self.markdown += [text, ""]
        self.html.append(f"<p>{as_html(text)}</p>")

    def table(self, head, rows):
        self.markdown += ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|", *("| " + " | ".join(row) + " |" for row in rows), ""]
        cells = lambda row, tag: "<tr>" + "".join(f"<{tag}>{as_html(cell)}</{tag}>" for cell in row) + "</tr>"
        self.html.append("<table>" + cells(head, "th") + "".join(cells(row, "td") for row in rows) + "</table>")

    def chart(self, name, svg):
        (self.out / f"{name}.svg").write_text(svg)
        self.markdown += [f"![{name}]({name}.svg)", ""]
        self.html.append(svg)

    def write(self, whole=True):
        """whole: as HTML, too."""
        (self.out / "README.md").write_text("\n".join([*self.markdown, stamps.stamp("report"), ""]))
        if not whole:
            return
        style = "body{font-family:sans-serif;max-width:75em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .5em;text-align:right}td:first-child,th:first-child{text-align:left}"
        (self.out / "report.html").write_text(f"<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Wadi: what accuracy costs</title><style>{style}</style>\n"
                                              + "\n".join(self.html) + "</html>\n")


def unguarded(rows, scene):
    """A scene's rows with an error and with every effect and guard on: what may lie on its frontier."""
    return [row for row in rows if row["scene"] == scene.key and row.get("error") is not None and not row["off"] and row["choice"] not in sweep.GUARDS]


# (name, factor on the cells, choice, whether Wadi has a preset of that name)
PRESETS = (("draft", 0.5, "robust", True), ("balanced", 1, "robust", True), ("balanced with order 2", 1, "second_order", False),
           ("twice the cells, order 1", 2, "robust", False), ("accurate", 2, "second_order", True))


def preset_rows(scene, rows, only_presets=True):
    """The rows of PRESETS at a scene's size, None where one is lacking. Sand alone has no order of water: its rows are those of order 1."""
    found = {(r["n"], r["T"], r["choice"]): r for r in rows if r["scene"] == scene.key and r["dt_factor"] == 1 and not r["off"]}
    n, ratio = scene.n // 2, 3 if scene.kind == "water" else 2
    return [found.get((round(n * factor), ratio, choice if scene.kind != "dry sand" else "robust")) for _, factor, choice, preset in PRESETS if preset or not only_presets]


def pareto(page, scene, rows):
    good = unguarded(rows, scene)
    best = sweep.frontier(good)
    place = lambda row: (row["ms_per_second"], max(row["error"], 1e-3))
    groups = {"order 1": ("robust",), "order 2": ("second_order", "second_order_sand"), "published": ("published",)}
    named = {choice for choices_of_group in groups.values() for choice in choices_of_group}
    groups["other choices"] = tuple({row["choice"] for row in good} - named)
    series = [("frontier", [place(row) for row in best], "dash")]
    series += [(name, sorted(place(row) for row in good if row["choice"] in members), "points") for name, members in groups.items()]
    presets_of = [(*place(row), name) for (name, *_), row in zip((preset for preset in PRESETS if preset[3]), preset_rows(scene, good)) if row]
    series = [one for one in series if one[1]]
    page.heading(f"{scene.kind}: {scene.title}", 3)
    page.chart(f"pareto_{scene.key}", charts.line_chart(f"{scene.title}: error against time", "ms per simulated second", "error [%]", series, x_log=True, y_log=True, named=presets_of))
    page.table(["on the frontier", "error [%]", "ms per simulated second", "ms per step"],
               [[f"`{row['point']}`", number(row["error"]), number(row["ms_per_second"]), number(row["ms_per_step"])] for row in best])


ROUNDING = 0.01  # [%]: an error below it is that of single precision and of the quantum


def norm_of(row, norm):
    """An error norm of a row [%]; None where the case has one number only."""
    return next((value for name, _, value, _ in row["measures"] if name.startswith(norm + " error of depth")), None)


def order(pairs):
    """Least-squares slope of log error over log dx, of [(dx, error)]."""
    points = [(math.log(dx), math.log(error)) for dx, error in pairs if error]
    if len(points) < 2:
        return ""
    if max(error for _, error in pairs if error) < ROUNDING:
        return "rounding"
    mx, my = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return f"{sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points):.2f}"


def by_size(rows, scene, choice):
    """Rows of a scene with known answer at its base step, by cells."""
    return sorted((r for r in rows if r["scene"] == scene.key and r["choice"] == choice and r["dt_factor"] == 1 and r["T"] == 3 and "failed" not in r), key=lambda r: r["n"])


def convergence(page, all_scenes, rows):
    body = []
    for scene in all_scenes:
        if scene.sweep:
            continue
        for choice in ("robust", "second_order", "published"):
            mine = by_size(rows, scene, choice)
            if not mine:
                continue
            finest = mine[-1]
            cells = [scene.title, choice, ", ".join(f"{r['n']}: {number(r['error'])}" for r in mine), order([(r["dx"], r["error"]) for r in mine]) if scene.truth == "exact" else ""]
            for norm in NORMS[1:]:
                value = norm_of(finest, norm)
                cells.append("" if value is None else f"{number(value)} (order {order([(r['dx'], norm_of(r, norm)) for r in mine])})")
            body.append([*cells, "; ".join(f"{name} {number(value)} {unit}" + (f" (right {number(right)})" if right else "")
                                           for name, unit, value, right in finest["measures"][1:] if " error of depth" not in name)])
    if not body:
        return
    page.heading("Errors against exact solutions and the laboratory")
    page.text("Error in percent by cells along x, at the base time step (dt proportional to dx): L1 where a whole profile is compared, with L2 and largest at the finest "
              "grid; order: slope of the error over dx, \"rounding\" where every error is below 0.01 %.")
    page.table(["case", "method", "error [%]", "order", "L2 [%]", "largest [%]", "at the finest"], body)


VERDICTS = ("yes: better than twice the cells along x and y", "yes: better than more cells in the same time", "no: more cells are the better buy")


def second_order(page, all_scenes, rows):
    """Where method.water_transport_order = 2 pays."""
    body, series = [], []
    for scene in all_scenes:
        if scene.kind == "dry sand":
            continue
        first, second = by_size(rows, scene, "robust"), by_size(rows, scene, "second_order")
        first, second = ([r for r in side if not r["off"] and r["error"]] for side in (first, second))
        at = {r["n"]: r for r in first}
        pairs = [(at[r["n"]], r, at[2 * r["n"]]) for r in second if r["n"] in at and 2 * r["n"] in at]
        if not pairs or max(r["error"] for r in first) < ROUNDING:
            continue
        one, two, finer = pairs[-1]
        slopes = [order([(r["dx"], r["error"]) for r in side]) for side in (first, second)]
        slower = two["ms_per_step"] / one["ms_per_step"]
        same_time = one["error"] * slower ** (-float(slopes[0]) / 3)  # time goes with the third power of the cells along x
        verdict = VERDICTS[2 if two["error"] >= one["error"] else 0 if two["error"] < finer["error"] else 1 if two["error"] < same_time else 2]
        body.append([scene.title, str(one["n"]), number(one["error"]), number(two["error"]), number(finer["error"]), f"{two['error'] / one['error']:.2f}", " / ".join(slopes),
                     f"{slower:.1f}", number(same_time), verdict])
        if scene.kind == "water" and scene.truth == "exact":
            colour = len(series) // 2
            series += [(f"{scene.key}, order {n}", [(r["dx"], r["error"]) for r in side], style, colour) for n, side, style in ((1, first, "dash"), (2, second, "line"))]
    if not body:
        return
    page.heading("Second order for water: where it pays")
    page.text("method.water_transport_order = 2 (engine/NUMERICS.md 2.16; choice second_order in a point) moves the water's heights and velocities with limited slopes. It pays where water "
              "is smooth or a bore or front runs through it: waves, dam breaks, streams over a bump with and without a jump, shores that move over sloping ground. Water inside sand gains "
              "where it flows as one body (the mound), not where drag or a boundary sets its error (the pair, Dupuit's dam). Doubling the cells along x and y costs eight times the work.")
    page.table(["case", "cells", "order 1 [%]", "order 2 [%]", "order 1, twice the cells [%]", "2 over 1", "measured order, 1 / 2", "time of a step, 2 over 1", "order 1, cells for that time [%]", "pays?"], body)
    if series:
        page.chart("convergence", charts.line_chart("Water: error by cell size, order 1 (dashed) and 2", "dx [m]", "error [%]", series, x_log=True, y_log=True))


def ratios(page, all_scenes, rows):
    page.heading("Sand substeps per water step")
    page.text("Error [%] and ms per simulated second, robust, finest grid with every ratio. Along a row of dt the water step is fixed and T divides it.")
    for scene in all_scenes:
        mine = [r for r in rows if r["scene"] == scene.key and scene.sweep and r["choice"] == "robust" and not r["off"]]
        if not mine or scene.kind == "water":
            continue
        sizes = [r["n"] for r in mine]
        n = max(sizes, key=lambda size: (sizes.count(size), size))  # the fullest table
        found = {(r["dt_factor"], r["T"]): r for r in mine if r["n"] == n}
        steps, counts = sorted({k[0] for k in found}), sorted({k[1] for k in found})
        page.table([f"{scene.key}, {n} cells", *(f"T = {t}" for t in counts)],
                   [[f"dt x {step:g}", *((f"{number(found[step, t]['error'])} %, {number(found[step, t]['ms_per_second'])} ms" if (step, t) in found else "") for t in counts)]
                    for step in steps])


def presets(page, all_scenes, rows):
    body, factors, frontiers = [], {}, []
    for scene in all_scenes:
        line = preset_rows(scene, rows, only_presets=False)
        if not scene.sweep or any(row is None for row in line):
            continue
        base = line[1]
        for (name, *_), row in zip(PRESETS, line):
            factors.setdefault(name, []).append((row["error"] / base["error"], row["ms_per_second"] / base["ms_per_second"]))
        body.append([scene.key, *(f"{number(row['error'])} %, {number(row['ms_per_second'])} ms" for row in line)])
        best = {row["point"] for row in sweep.frontier(unguarded(rows, scene))}
        frontiers.append([f"{scene.key}: on the frontier", *("yes" if row["point"] in best else "no" for row in line)])
    if not body:
        return
    page.heading("Presets")
    page.text("Error and ms per simulated second with half, all and twice the cells along x and y, the step in proportion, two sand substeps per water step (three where there is "
              "only water); accurate also has order 2 for water. Two columns are no presets. On the frontier: of all points of the scene, as in its chart; sand alone has no order of water. "
              "On grids this small a GPU's time is that of its launches; on large ones it goes with the third power of the factor.")
    geometric = lambda values: math.prod(values) ** (1 / len(values))
    page.table(["", *(name for name, *_ in PRESETS)],
               [*body, *frontiers, ["error over balanced, mean", *(f"{sum(e for e, _ in v) / len(v):.2f}" for v in factors.values())],
                ["time over balanced, geometric mean", *(f"{geometric([t for _, t in v]):.2g}" for v in factors.values())]])


def choices(page, all_scenes, rows):
    page.heading("Method, choice by choice")
    page.text("Error [%] at the base step and at a quarter of it, where only what a choice itself errs is left.")
    swept = [scene for scene in all_scenes if scene.sweep and any(r["scene"] == scene.key for r in rows)]
    body = []
    for choice in sweep.METHODS:
        line = [choice]
        for scene in swept:
            mine = [r for r in rows if r["scene"] == scene.key and r["choice"] == choice and not r["off"] and r["T"] == 3]
            n = max((r["n"] for r in mine if r["dt_factor"] == 0.25), default=0)
            at = {r["dt_factor"]: r for r in mine if r["n"] == n}
            line.append(", ".join(f"{number(at[f].get('error'))} ({number(at[f]['ms_per_step'])} ms)" for f in (1, 0.25) if f in at))
        if any(line[1:]):
            body.append(line)
    page.table(["choice", *(f"{scene.kind}: {scene.key}" for scene in swept)], body)


def share(row, kind="saved"):
    """Median and quartiles [%]."""
    return f"{row[kind]:.1f} ({row[kind + '_low']:.1f} to {row[kind + '_high']:.1f})" if kind in row else ""


def price_list(page, rows, prices):
    laws, prices = [row for row in prices if "costs" in row], [row for row in prices if "costs" not in row]
    everything = prices[0]
    at = {(r["choice"], r["dt_factor"]): r for r in rows if r["scene"] == "wall" and r["choice"] in sweep.GUARDS}
    base = {r["dt_factor"]: r for r in rows if r["scene"] == "wall" and r["choice"] == "robust" and r["T"] == 3 and not r["off"] and r["n"] == max((q["n"] for q in at.values()), default=0)}
    named = [(row["point"].removeprefix("price: "), row) for row in prices]
    page.heading("What effects cost, and what leaving one out changes")
    change = {r["off"]: r for r in rows if r["off"]}
    page.text(f"Scene wall on {everything['n']} cells along x: ms per step, passes per step and bytes per cell{'; error: against the reference with everything on, at the size of the sweep' if rows else ''}. "
              f"Saved: median and quartiles of {everything['rounds']} pairs of runs, one with it and one without, in turn, {everything['steps']} steps each. "
              "On so coarse a grid one error can offset another: what leaving an effect out changes by itself is in effects/README.md of samples/report.")
    error = lambda what: "".join(number(point.get("error")) for point in (change.get(what.removeprefix("effect ").removesuffix(" off")), base.get(1) if what == "everything" else None) if point)
    page.table(["", "ms per step", "saved [%]", "passes", "bytes per cell", *(["error [%]"] if rows else [])],
               [[what, f"{row['ms_per_step']:.4g}", share(row), str(row["passes"]), f"{row['bytes_per_cell']:.0f}", *([error(what)] if rows else [])]
                for what, row in named if what == "everything" or what.startswith("effect")])
    page.heading("What safety costs")
    page.text(f"One guard off at a time (negative: it costs more without), measured as above.{' Error and mass drift at the base step and at four times it, where the guards work.' if rows else ''} "
              f"The ledger has no off: its row is the share of the passes that only it needs ({', '.join(PASSES)}) in the time of all, of level {LEVEL}, which has open sides and a source, on "
              f"as many cells along a side; what no_quantum saves is its rounding. Strict floats: a second build without them; where there is none, tests/conformance/results has 6 to 16 % of a step on an H100.")
    both = lambda table, key: [f"{number(table[key].get('error'))} %, drift {number(table[key].get('drift', 0))}" if key in table else ""] if rows else []
    body = [["everything on", f"{everything['ms_per_step']:.4g}", "", *both(base, 1), *both(base, 4)]]
    for what, row in named[1:]:
        if what in sweep.GUARDS or not (what in sweep.METHODS or what.startswith(("effect", "fused"))):
            body.append([what, f"{row['ms_per_step']:.4g}" if "ms_per_step" in row else "", share(row), *both(at, (what, 1)), *both(at, (what, 4))])
    page.table(["off", "ms per step", "saved [%]", *(["base step", "four times it"] if rows else [])], body)
    page.heading("What choices of method and of fused stages cost")
    page.table(["choice", "ms per step", "saved [%]", "passes"], [[what, f"{row['ms_per_step']:.4g}", share(row), str(row["passes"])] for what, row in named if what in sweep.METHODS or what.startswith("fused")])
    page.heading("What parts of the water's laws cost")
    page.text(f"Level {WATER_LEVEL} on {laws[0]['n']} x {laws[0]['n']} cells with walls, without bed friction, shock viscosity and edits, as it is and without its sand; costs: of one part put in, in percent of a "
              f"step without it, median and quartiles of {laws[0]['rounds']} pairs of runs in turn. With sand, level sides let ground water through.")
    page.table(["part", "ms per step without", "costs [%]"], [[row["point"].removeprefix("price: "), f"{row['ms_per_step']:.4g}", share(row, "costs")] for row in laws])


def write_prices(out, prices, processor_time):
    """The price lists alone."""
    page = Page(out)
    page.heading("What effects, guards and choices cost", 1)
    page.text(f"On {prices[0]['backend']}: {prices[0]['device']}; time of stepping alone{', processor time of one thread' if processor_time else ''}. Errors: sweep/README.md of samples/report.")
    price_list(page, [], prices)
    page.write(whole=False)


def write(out, all_scenes, rows, prices, planned, quick, processor_time):
    page = Page(out)
    device = next((r["device"] for r in rows if "device" in r), "")
    backend = next((r["backend"] for r in rows if "backend" in r), "")
    page.heading("What accuracy costs in time", 1)
    page.text(f"{'Quick' if quick else 'Full'} run on {backend}: {device}. Error: mean absolute error of sand and water surface in percent of the range over which they moved, "
              f"or as the case says; time: {'processor time of one thread, ' if processor_time else ''}of stepping alone, per simulated second. "
              f"Truth of island, heap and wall: double precision on {scenes.SOLVED_N} x {scenes.SOLVED_N // 2} cells "
              f"with second order for water. A point such as wall@n64,dt1,T3,robust is 64 cells along x, the base time step, "
              "three sand substeps per water step, method robust; samples/report/wadi-report BIN --point POINT measures it again.")
    if len(rows) < planned:
        page.text(f"Broken off: {planned - len(rows)} of {planned} points are not measured.")
    page.heading("Error against time")
    for scene in all_scenes:
        if scene.sweep and any(r["scene"] == scene.key for r in rows):
            pareto(page, scene, rows)
    presets(page, all_scenes, rows)
    ratios(page, all_scenes, rows)
    choices(page, all_scenes, rows)
    second_order(page, all_scenes, rows)
    convergence(page, all_scenes, rows)
    if prices:
        price_list(page, rows, prices)
    page.write()
