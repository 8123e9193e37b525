"""A report's pages: README.md with charts beside it, and the same as one self-contained HTML file."""
import html
import math

import charts
import scenes
import sweep


def number(value):
    if value is None:
        return "not finite"
    return "0" if value == 0 else f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


class Page:
    """Collects headings, paragraphs, tables and charts; writes Markdown and HTML."""

    def __init__(self, out):
        self.out, self.markdown, self.html = out, [], []

    def heading(self, text, level=2):
        self.markdown += ["#" * level + " " + text, ""]
        self.html.append(f"<h{level}>{html.escape(text)}</h{level}>")

    def text(self, text):
        self.markdown += [text, ""]
        self.html.append(f"<p>{html.escape(text)}</p>")

    def table(self, head, rows):
        self.markdown += ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|", *("| " + " | ".join(row) + " |" for row in rows), ""]
        cells = lambda row, tag: "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row) + "</tr>"
        self.html.append("<table>" + cells(head, "th") + "".join(cells(row, "td") for row in rows) + "</table>")

    def chart(self, name, svg):
        (self.out / f"{name}.svg").write_text(svg)
        self.markdown += [f"![{name}]({name}.svg)", ""]
        self.html.append(svg)

    def write(self):
        (self.out / "README.md").write_text("\n".join(self.markdown))
        style = "body{font-family:sans-serif;max-width:75em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .5em;text-align:right}td:first-child,th:first-child{text-align:left}"
        (self.out / "report.html").write_text(f"<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Wadi: what accuracy costs</title><style>{style}</style>\n"
                                              + "\n".join(self.html) + "</html>\n")


def pareto(page, scene, rows):
    good = [row for row in rows if row["scene"] == scene.key and row.get("error") is not None and not row["off"] and row["choice"] not in sweep.GUARDS]
    best = sweep.frontier(good)
    by_size = {}
    for row in good:
        by_size.setdefault(("robust", row["n"]) if row["choice"] == "robust" else (row["choice"], ""), []).append((row["ms_per_second"], max(row["error"], 1e-3)))
    series = [("frontier", [(row["ms_per_second"], max(row["error"], 1e-3)) for row in best], "dash")]
    series += [(f"{choice} {n}".strip() + (" cells" if n else ""), sorted(points), "points") for (choice, n), points in sorted(by_size.items(), key=str)]
    page.heading(f"{scene.kind}: {scene.title}", 3)
    page.chart(f"pareto_{scene.key}", charts.line_chart(f"{scene.title}: error against time", "ms per simulated second", "error [%]", series, x_log=True, y_log=True))
    page.table(["on the frontier", "error [%]", "ms per simulated second", "ms per step"],
               [[f"`{row['point']}`", number(row["error"]), number(row["ms_per_second"]), number(row["ms_per_step"])] for row in best])


def order(rows):
    """Least-squares slope of log error over log dx."""
    points = [(math.log(row["dx"]), math.log(row["error"])) for row in rows if row.get("error")]
    if len(points) < 2:
        return None
    mx, my = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    below = sum((x - mx) ** 2 for x, _ in points)
    return sum((x - mx) * (y - my) for x, y in points) / below if below else None


def convergence(page, all_scenes, rows):
    page.heading("Errors against exact solutions and the laboratory")
    page.text("Error in percent by cells along x, at the base time step (dt proportional to dx); order: slope of the error over dx.")
    body, series = [], []
    for scene in all_scenes:
        if scene.sweep:
            continue
        for choice in ("robust", "published"):
            mine = sorted((r for r in rows if r["scene"] == scene.key and r["choice"] == choice and r["dt_factor"] == 1 and "failed" not in r), key=lambda r: r["n"])
            if not mine:
                continue
            slope = order(mine)
            finest = mine[-1]
            body.append([scene.title, choice, ", ".join(f"{r['n']}: {number(r['error'])}" for r in mine), "" if slope is None or scene.truth != "exact" else f"{slope:.2f}",
                         "; ".join(f"{name} {number(value)} {unit} (right {number(right)})" for name, unit, value, right in finest["measures"][1:] if right)])
            if scene.truth == "exact" and scene.kind == "water":
                series.append((f"{scene.key}, {choice}", [(r["dx"], r["error"]) for r in mine if r.get("error")], "line" if choice == "robust" else "dash"))
    page.table(["case", "method", "error [%]", "order", "at the finest"], body)
    page.chart("convergence", charts.line_chart("Water: error by cell size", "dx [m]", "error [%]", [s for s in series if s[1]], x_log=True, y_log=True))


def ratios(page, all_scenes, rows):
    page.heading("Sand steps per water step")
    page.text("Error [%] and ms per simulated second, robust, finest grid of the sweep. Along a row of dt the water step is fixed and T divides it.")
    for scene in all_scenes:
        mine = [r for r in rows if r["scene"] == scene.key and scene.sweep and r["choice"] == "robust" and not r["off"]]
        if not mine or scene.kind == "water":
            continue
        n = max(r["n"] for r in mine)
        found = {(r["dt_factor"], r["T"]): r for r in mine if r["n"] == n}
        steps, counts = sorted({k[0] for k in found}), sorted({k[1] for k in found})
        page.table([f"{scene.key}, {n} cells", *(f"T = {t}" for t in counts)],
                   [[f"dt x {step:g}", *((f"{number(found[step, t]['error'])} %, {number(found[step, t]['ms_per_second'])} ms" if (step, t) in found else "") for t in counts)]
                    for step in steps])


def presets(page, all_scenes, rows):
    found = {(r["scene"], r["n"], r["T"]): r for r in rows if r["choice"] == "robust" and r["dt_factor"] == 1 and not r["off"]}
    body, mean = [], {}
    for scene in all_scenes:
        n, ratio = scene.n // 2, 3 if scene.kind == "water" else 2
        line = [found.get((scene.key, cells, ratio)) for cells in (n // 2, n, 2 * n)]
        if not scene.sweep or any(row is None for row in line):
            continue
        for name, row in zip(("draft", "balanced", "accurate"), line):
            mean.setdefault(name, []).append(row["error"] / line[1]["error"])
        body.append([scene.key, *(f"{number(row['error'])} %, {number(row['ms_per_second'])} ms" for row in line)])
    if not body:
        return
    page.heading("Presets")
    page.text("Error and ms per simulated second with half, all and twice the cells along x and y, the step in proportion, two sand steps per water step. "
              "On grids this small a GPU's time is that of its launches; on large ones it goes with the third power of the factor.")
    page.table(["", "draft", "balanced", "accurate"], [*body, ["error, factor", *(f"{sum(v) / len(v):.2f}" for v in mean.values())]])


def choices(page, all_scenes, rows):
    page.heading("Method, choice by choice")
    page.text("Error [%] at the base step and at a quarter of it, where only what a choice itself errs is left.")
    swept = [scene for scene in all_scenes if scene.sweep and any(r["scene"] == scene.key for r in rows)]
    body = []
    for choice in sweep.METHODS:
        line = [choice]
        for scene in swept:
            mine = [r for r in rows if r["scene"] == scene.key and r["choice"] == choice and not r["off"] and r["T"] == 3]
            n = max((r["n"] for r in mine), default=0)
            at = {r["dt_factor"]: r for r in mine if r["n"] == n}
            line.append(", ".join(f"{number(at[f].get('error'))} ({number(at[f]['ms_per_step'])} ms)" for f in (1, 0.25) if f in at))
        if any(line[1:]):
            body.append(line)
    page.table(["choice", *(f"{scene.kind}: {scene.key}" for scene in swept)], body)


def price_list(page, rows, cost, n):
    everything = cost[0]
    page.heading("What effects cost, and what leaving one out changes")
    change = {r["off"]: r for r in rows if r["off"]}
    page.text(f"Scene wall on {n} cells along x: ms per step, passes per step and bytes per cell; error: against the reference with everything on, at the sweep's size.")
    page.table(["", "ms per step", "saved [%]", "passes", "bytes per cell", "error without it [%]"],
               [[what, f"{ms:.4g}", f"{100 * (1 - ms / everything[1]):.0f}", str(passes), f"{size:.0f}",
                 number(change[what.split()[1]].get("error")) if what.startswith("effect") and what.split()[1] in change else ""]
                for what, ms, passes, size in cost if what == "everything" or what.startswith("effect")])
    page.heading("What safety costs")
    page.text("One guard off at a time (negative: it costs more without). Error and mass drift at the base step and at four times it, where the guards work. "
              "Strict floats: 6 to 16 % of a step (tests/conformance/results). The ledger of open sides and sources is part of their passes.")
    at = {(r["choice"], r["dt_factor"]): r for r in rows if r["scene"] == "wall" and r["choice"] in sweep.GUARDS}
    base = {r["dt_factor"]: r for r in rows if r["scene"] == "wall" and r["choice"] == "robust" and r["T"] == 3 and not r["off"] and r["n"] == max((q["n"] for q in at.values()), default=0)}
    both = lambda table, key: [f"{number(table[key].get('error'))} %, drift {number(table[key].get('drift', 0))}" if key in table else "" ]
    body = [["everything on", f"{everything[1]:.4g}", "", *both(base, 1), *both(base, 4)]]
    for what, ms, _, _ in cost:
        if what in sweep.GUARDS or what.startswith("timestamps"):
            body.append([what, f"{ms:.4g}", f"{100 * (1 - ms / everything[1]):.0f}", *both(at, (what, 1)), *both(at, (what, 4))])
    page.table(["off", "ms per step", "saved [%]", "base step", "four times it"], body)


def write(out, all_scenes, rows, cost, cost_size, quick):
    page = Page(out)
    device = next((r["device"] for r in rows if "device" in r), "")
    backend = next((r["backend"] for r in rows if "backend" in r), "")
    page.heading("What accuracy costs in time", 1)
    page.text(f"{'Quick' if quick else 'Full'} run on {backend}: {device}. Error: mean absolute error of sand and water surface in percent of the range over which they moved, "
              "or as the case says; time: of stepping alone, per simulated second. A point such as wall@n64,dt1,T3,robust is 64 cells along x, the base time step, "
              "three sand steps per water step, method robust; samples/report/wadi-report BIN --point POINT measures it again.")
    page.heading("Error against time")
    for scene in all_scenes:
        if scene.sweep and any(r["scene"] == scene.key for r in rows):
            pareto(page, scene, rows)
    presets(page, all_scenes, rows)
    ratios(page, all_scenes, rows)
    choices(page, all_scenes, rows)
    convergence(page, all_scenes, rows)
    price_list(page, rows, cost, cost_size)
    page.write()
