"""Line charts as SVG text: linear or logarithmic axes, a legend beside the plot. No packages."""
import math
from xml.sax.saxutils import escape

TITLE, TITLE_WIDTH = 15, 0.62  # font size; of a bold letter as wide as most, in font sizes
COLOURS = ("#222222", "#0b6fa4", "#c8501e", "#3a8a3a", "#7a4fa3", "#a38a1e", "#b03070", "#2a9d9d")
WIDTH, HEIGHT, LEFT, TOP, BOTTOM, LEGEND = 520, 320, 74, 40, 52, 190


def ticks(low, high, log):
    """Places of grid lines that cover low ... high."""
    if log:
        first, last = math.floor(math.log10(low) + 1e-9), math.ceil(math.log10(high) - 1e-9)
        return [10.0**power for power in range(first, max(last, first + 1) + 1)]
    size = 10 ** math.floor(math.log10((high - low) or 1))
    step = next(size * part for part in (0.1, 0.2, 0.5, 1, 2) if (high - low) / (size * part) <= 8)
    return [n * step for n in range(math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9) + 1)]


class Axis:
    def __init__(self, values, log, start, length, marks=None):
        self.log, self.start, self.length = log, start, length
        self.marks = marks or ticks(min(values), max(values), log)
        self.low, self.high = self.position(min(self.marks[0], min(values))), self.position(max(self.marks[-1], max(values)))

    def position(self, value):
        return math.log10(value) if self.log else value

    def at(self, value):
        return self.start + self.length * (self.position(value) - self.low) / ((self.high - self.low) or 1)


def line_chart(title, x_label, y_label, series, *, x_log=False, y_log=False, x_marks=None, named=()):
    """series: [(name, [(x, y), ...], style)], style "line", "dash" or "points"; logarithmic axes want values above 0. A fourth member of a
    series is the number of its colour: series that belong together share one. named: [(x, y, text)] of points that get a ring and their name."""
    xs = [x for _, points, *_ in series for x, _ in points]
    ys = [y for _, points, *_ in series for _, y in points]
    across = Axis(xs, x_log, LEFT, WIDTH, x_marks)
    up = Axis(ys, y_log, TOP + HEIGHT, -HEIGHT)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + LEGEND}" height="{TOP + HEIGHT + BOTTOM}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>',
           f'<text x="{LEFT}" y="22" font-size="{min(TITLE, (WIDTH + LEGEND - 10) / (TITLE_WIDTH * len(title))):.1f}" font-weight="bold">{escape(title)}</text>']
    for mark in up.marks:
        y = up.at(mark)
        out.append(f'<line x1="{LEFT}" x2="{LEFT + WIDTH}" y1="{y:.1f}" y2="{y:.1f}" stroke="#dddddd"/>'
                   f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{mark:.6g}</text>')
    for mark in across.marks:
        x = across.at(mark)
        out.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{TOP}" y2="{TOP + HEIGHT}" stroke="#eeeeee"/>'
                   f'<text x="{x:.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{mark:.6g}</text>')
    out.append(f'<text x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 38}" text-anchor="middle">{escape(x_label)}</text>')
    out.append(f'<text transform="translate(16 {TOP + HEIGHT / 2}) rotate(-90)" text-anchor="middle">{escape(y_label)}</text>')
    for n, (name, points, style, *shared) in enumerate(series):
        colour = COLOURS[(shared[0] if shared else n) % len(COLOURS)]
        places = [(across.at(x), up.at(y)) for x, y in points]
        if style != "points":
            dash = ' stroke-dasharray="6 4"' if style == "dash" else ""
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
            out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>')
        if style == "points" or len(points) < 12:
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"><title>{escape(name)}: {px:.4g}, {py:.4g}</title></circle>'
                    for (x, y), (px, py) in zip(places, points)]
        line = TOP + 12 + 18 * n
        key = ' stroke-dasharray="4 3"' if style == "dash" else ""
        out.append(f'<line x1="{LEFT + WIDTH + 10}" x2="{LEFT + WIDTH + 27}" y1="{line - 7}" y2="{line - 7}" stroke="{colour}" stroke-width="4"{key}/>'
                   f'<text x="{LEFT + WIDTH + 32}" y="{line - 3}">{escape(name)}</text>')
    for x, y, text in named:
        # A name above its point would lie upon the ring or the name of one close to the right.
        below = any(0 < across.at(other) - across.at(x) < 130 and abs(up.at(height) - up.at(y)) < 14 for other, height, _ in named)
        out.append(f'<circle cx="{across.at(x):.1f}" cy="{up.at(y):.1f}" r="6" fill="none" stroke="#222222" stroke-width="1.5"/>'
                   f'<text x="{across.at(x) + 9:.1f}" y="{up.at(y) + (16 if below else -6):.1f}" font-size="11">{escape(text)}</text>')
    return "\n".join([*out, "</svg>", ""])
