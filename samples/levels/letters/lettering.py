"""Words of sand for height maps: glyphs from font.pbm, whose comment lists them in their order (Python, standard library only).

They are magnified with the corners of their pixels rounded, and their edges rise over less than two pixels of the font.
"""
import os

GAP, SPACE = 2, 9       # between letters and between words [pixels of the font]


class Font:
    def __init__(self):
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "font.pbm"), encoding="ascii") as file:
            lines = file.read().split("\n")
        self.order = lines[1].split()[1].rstrip(":")
        width, self.height = map(int, lines[2].split())
        self.width = width // len(self.order)
        self.rows = lines[3:3 + self.height]

    def ink(self, glyph, column, row):
        """1 where the glyph has ink; row 0 is its lowest."""
        if not (0 <= column < self.width and 0 <= row < self.height):
            return 0
        return int(self.rows[self.height - 1 - row][self.order.index(glyph) * self.width + column])


def line_width(font, text):
    """Of a line of text [pixels of the font]."""
    return sum(SPACE if letter == " " else font.width + GAP for letter in text) - GAP


def draw_line(cells, dx, font, text, centre, bottom, pixel, height):
    """Raises cells[row][column] (row 0 in the south) to a line of text whose middle is at x = centre [m]."""
    ny, nx = len(cells), len(cells[0])
    pen = centre / pixel - 0.5 * line_width(font, text)
    for letter in text:
        if letter == " ":
            pen += SPACE
            continue
        for row in range(max(0, int((bottom - pixel) / dx)), min(ny, int((bottom + (font.height + 1) * pixel) / dx) + 1)):
            for column in range(max(0, int((pen - 1) * pixel / dx)), min(nx, int((pen + font.width + 1) * pixel / dx) + 1)):
                x = (column + 0.5) * dx / pixel - pen
                y = ((row + 0.5) * dx - bottom) / pixel
                cells[row][column] = max(cells[row][column], height * edge(font, letter, x, y))
        pen += font.width + GAP


def edge(font, letter, x, y):
    """0 ... 1 across the outline of a glyph: its pixels blurred by a tent two pixels wide on each side, then steepened."""
    share = total = 0.0
    for row in range(int(y) - 2, int(y) + 3):
        for column in range(int(x) - 2, int(x) + 3):
            weight = max(0.0, 2 - abs(column + 0.5 - x)) * max(0.0, 2 - abs(row + 0.5 - y))
            share += weight * font.ink(letter, column, row)
            total += weight
    t = min(max((share / total - 0.35) / 0.3, 0.0), 1.0)
    return t * t * (3 - 2 * t)
