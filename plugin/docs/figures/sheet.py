"""The paper that figures are drawn on: SVG on a white sheet, so that pages of any colour show it."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[3]
INK, GROUND, SAND, WET, WATER, FAINT, WARM, BLUE, OCHRE = "#263238", "#8d8378", "#e6cf9a", "#b69a63", "#7fb2d9", "#b0bec5", "#d9542b", "#1f5f91", "#8a6414"


class Figure:
    def __init__(self, width, height, top=0):
        self.size, self.top, self.parts = (width, height), top, []

    def shape(self, points, fill, stroke="none", width=1.5, dash=None, closed=True):
        way = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<{"polygon" if closed else "polyline"} points="{way}" fill="{fill}" stroke="{stroke}" stroke-width="{width}"{dashes}/>')

    def line(self, points, stroke=INK, width=1.5, dash=None):
        self.shape(points, "none", stroke, width, dash, closed=False)

    def box(self, x, y, w, h, fill, stroke=INK, width=1.0):
        self.shape([(x, y), (x + w, y), (x + w, y + h), (x, y + h)], fill, stroke, width)

    def text(self, x, y, words, size=15, anchor="start", fill=INK, slanted=False, bold=False):
        style = (' font-style="italic"' if slanted else "") + (' font-weight="bold"' if bold else "")
        escaped = words.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" fill="{fill}"{style}>{escaped}</text>')

    def arrow(self, a, b, stroke=INK, width=2.0, head=7):
        (ax, ay), (bx, by) = a, b
        length = max(((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5, 1e-9)
        ux, uy = (bx - ax) / length, (by - ay) / length
        self.line([a, (bx - ux * head * 0.8, by - uy * head * 0.8)], stroke, width)
        self.shape([b, (bx - ux * head - uy * head * 0.5, by - uy * head + ux * head * 0.5), (bx - ux * head + uy * head * 0.5, by - uy * head - ux * head * 0.5)], stroke)

    def span(self, x, top, bottom, words):
        """A measure of height with its name."""
        self.line([(x, top), (x, bottom)], INK, 1.2)
        for y in (top, bottom):
            self.line([(x - 4, y), (x + 4, y)], INK, 1.2)
        self.text(x + 8, (top + bottom) / 2 + 5, words, slanted=True)

    def svg(self, title):
        w, h = self.size
        body = "\n".join(self.parts)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {self.top} {w} {h}" width="{w}" height="{h}" font-family="Helvetica, Arial, sans-serif" role="img">\n'
                f'<title>{title}</title>\n<rect y="{self.top}" width="{w}" height="{h}" rx="6" fill="#ffffff"/>\n{body}\n</svg>\n')


class Plot:
    """Axes on a figure. Ticks are numbers, or (number, words)."""

    def __init__(self, figure, left, top, wide, high, across, up, ticks_across, ticks_up, words_across, words_up):
        self.figure, self.box, self.across, self.up = figure, (left, top, wide, high), across, up
        bottom = top + high
        figure.line([(left, top), (left, bottom), (left + wide, bottom)], INK, 1.3)
        for tick in ticks_across:
            value, words = tick if isinstance(tick, tuple) else (tick, f"{tick:g}")
            x = self.at(value, up[0])[0]
            figure.line([(x, bottom), (x, bottom + 4)], INK, 1)
            figure.text(x, bottom + 18, words, 12.5, "middle")
        for tick in ticks_up:
            value, words = tick if isinstance(tick, tuple) else (tick, f"{tick:g}")
            y = self.at(across[0], value)[1]
            figure.line([(left - 4, y), (left, y)], INK, 1)
            figure.text(left - 8, y + 4.5, words, 12.5, "end")
        figure.text(left + wide, bottom + 38, words_across, 13.5, "end")
        figure.text(left - 36, top - 10, words_up, 13.5)

    def at(self, x, y):
        left, top, wide, high = self.box
        return left + wide * (x - self.across[0]) / (self.across[1] - self.across[0]), top + high * (1 - (y - self.up[0]) / (self.up[1] - self.up[0]))

    def curve(self, points, stroke=INK, width=2.2, dash=None):
        self.figure.line([self.at(x, y) for x, y in points], stroke, width, dash)

    def of(self, function, stroke=INK, width=2.2, dash=None, first=None, last=None, count=90):
        """The curve of a function, from `first` to `last`."""
        a = self.across[0] if first is None else first
        b = self.across[1] if last is None else last
        self.curve([(x, function(x)) for x in (a + (b - a) * n / count for n in range(count + 1))], stroke, width, dash)

    def text(self, x, y, words, fill=INK, size=13.5, anchor="start"):
        self.figure.text(*self.at(x, y), words, size, anchor, fill)

    def dot(self, x, y, fill=INK):
        px, py = self.at(x, y)
        self.figure.parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4" fill="{fill}"/>')

    def arrow(self, a, b, stroke=INK):
        self.figure.arrow(self.at(*a), self.at(*b), stroke, 1.6)


def smooth(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3 - 2 * t)


def default(name):
    """A number of Material or Method in engine/settings/data/settings.hpp."""
    text = (ROOT / "engine/settings/data/settings.hpp").read_text(encoding="utf-8")
    return float(re.search(rf"(?:double|int) {name} = ([-\d.e+]+);", text)[1])


def default_saturations():
    text = (ROOT / "engine/settings/data/settings.hpp").read_text(encoding="utf-8")
    return [float(value) for value in re.search(r"saturation\w* ?(?:\[3\])? ?=? ?\{([^}]*)\}", text)[1].split(",")]
