#!/usr/bin/env python3
"""Draws time per water step and memory against the grid's size from CSVs of `conformance perf`, as one SVG.

Usage: plot.py OUT.svg A.csv [B.csv ...]"""
import math
import sys
from xml.sax.saxutils import escape

import perf_table

COLOURS = ["#0b6fa4", "#c8501e", "#3a8a3a", "#7a4fa3", "#a38a1e", "#555555"]
STEPS = [("step, all effects", ""), ("step, dry sand", "6 3"), ("step, water only", "2 3")]
WIDTH, HEIGHT, LEFT, TOP = 440, 340, 76, 46


class Panel:
    """Log-log axes with grid lines at powers of ten and at each grid size."""

    def __init__(self, x, title, unit, sizes, values):
        self.x, self.title, self.unit, self.sizes = x + LEFT, title, unit, sizes
        self.low = math.floor(math.log10(min(values)))
        self.high = math.ceil(math.log10(max(values)))

    def at(self, size, value):
        span = math.log2(self.sizes[-1] / self.sizes[0]) or 1
        x = self.x + WIDTH * math.log2(size / self.sizes[0]) / span
        y = TOP + HEIGHT * (self.high - math.log10(value)) / (self.high - self.low)
        return f"{x:.1f},{y:.1f}"

    def axes(self):
        out = [f'<text x="{self.x}" y="{TOP - 18}" font-size="15" font-weight="bold">{escape(self.title)}</text>']
        for power in range(self.low, self.high + 1):
            _, y = self.at(self.sizes[0], 10.0**power).split(",")
            out.append(f'<line x1="{self.x}" x2="{self.x + WIDTH}" y1="{y}" y2="{y}" stroke="#dddddd"/>')
            out.append(f'<text x="{self.x - 6}" y="{float(y) + 4:.1f}" text-anchor="end">{10.0**power:g} {self.unit}</text>')
        for size in self.sizes:
            x, _ = self.at(size, 10.0**self.low).split(",")
            out.append(f'<line x1="{x}" x2="{x}" y1="{TOP}" y2="{TOP + HEIGHT}" stroke="#eeeeee"/>')
            out.append(f'<text x="{x}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{size}²</text>')
        return out

    def line(self, points, colour, dash):
        path = " ".join(self.at(size, value) for size, value in points)
        marks = "".join(
            '<circle cx="{}" cy="{}" r="3" fill="{}"/>'.format(*self.at(size, value).split(","), colour) for size, value in points
        )
        return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>{marks}'


def series(rows, step, column):
    return sorted((row["size"], row[column]) for row in rows if row["row"] == step and row[column])


def draw(files):
    tables = [perf_table.read(path) for path in files]
    steps = [name for name, _ in STEPS]
    whole = [row for rows in tables for row in rows if row["row"] in steps]
    if not whole:
        raise SystemExit("no whole steps in these files; was `conformance perf` run with --stage?")
    sizes = sorted({row["size"] for row in whole})
    mib = 1.0 / (1 << 20)
    times = [row[column] for row in whole for column in ("median_ms", "floor_ms")]
    time_panel = Panel(0, "Time of one water step, T = 3 (median)", "ms", sizes, times)
    memory_panel = Panel(WIDTH + LEFT + 40, "Device memory of a world", "MiB", sizes, [row["world_bytes"] * mib for row in whole])
    out = time_panel.axes() + memory_panel.axes()
    legend = []
    for rows, colour in zip(tables, COLOURS):
        for step, dash in STEPS:
            points = series(rows, step, "median_ms")
            if not points:
                continue
            out.append(time_panel.line(points, colour, dash))
            legend.append((f'{rows[0]["backend"]}, {rows[0]["device"]}: {step.removeprefix("step, ")}', colour, dash))
    # The least a step can move at the fastest copy rate measured, and the memory, are those of the first file.
    out.append(time_panel.line(series(tables[0], STEPS[0][0], "floor_ms"), "#999999", "1 3"))
    legend.append((f'floor, all effects: state once in and out at the copy rate of {tables[0][0]["backend"]}', "#999999", "1 3"))
    for step, dash in STEPS:
        points = [(size, value * mib) for size, value in series(tables[0], step, "world_bytes")]
        if points:
            out.append(memory_panel.line(points, "#333333", dash))
            legend.append((f'memory: {step.removeprefix("step, ")}', "#333333", dash))
    y = TOP + HEIGHT + 48
    for number, (text, colour, dash) in enumerate(legend):
        x = LEFT + (number % 2) * (WIDTH + LEFT + 40)
        out.append(f'<line x1="{x}" x2="{x + 34}" y1="{y}" y2="{y}" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        out.append(f'<text x="{x + 42}" y="{y + 4}">{escape(text)}</text>')
        y += 20 if number % 2 else 0
    width, height = 2 * (WIDTH + LEFT) + 70, y + 24
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">'
        f'<rect width="100%" height="100%" fill="white"/>{"".join(out)}</svg>\n'
    )


if len(sys.argv) < 3:
    raise SystemExit(__doc__)
with open(sys.argv[1], "w", encoding="utf-8") as file:
    file.write(draw(sys.argv[2:]))
