#!/usr/bin/env python3
"""Writes sand.png: SAND & WATER in two lines and a logo of sand, 512 x 512 samples of 0.1 m, 16 bits, black 0 m, white 1.5 m.

The letters are those of level letters. The logo is a ring that holds the sun over two dunes.
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
LEVELS = os.path.dirname(HERE)
sys.path += [LEVELS, os.path.join(LEVELS, "letters")]
from lettering import Font, draw_line  # noqa: E402
from map_writer import write_png  # noqa: E402

NX, NY, DX = 512, 512, 0.1
WHITE = 1.5
HEIGHT = 1.2            # of letters and logo [m]
PIXEL = 0.27            # side of a pixel of the font [m]
MIDDLE = 27.6           # of the lines of text, from the west [m]
LINES = (("SAND &", 39.0), ("WATER", 27.0))  # with the foot of each line, from the south [m]
LOGO = (27.6, 14.0)     # middle of the ring [m]
RING, BAND = 8.6, 1.4   # its outer radius, its width
SUN, SUN_AT = 1.7, (2.6, 3.0)
EDGE = 0.3              # width over which the logo's faces rise


def crest(x):
    """Line of a dune, from the middle of the ring."""
    return -0.6 + 1.5 * math.sin(0.55 * x)


def logo(x, y):
    """0 ... 1 from the ground beside the logo to its top."""
    radius = math.hypot(x, y)
    inside = min(RING - radius, radius - (RING - BAND))
    inside = max(inside, SUN - math.hypot(x - SUN_AT[0], y - SUN_AT[1]))
    if radius < RING:
        for fall in (0.0, 3.4):
            inside = max(inside, 0.75 - 0.8 * abs(y + fall - crest(x - 0.6 * fall)))
    t = min(max(inside / EDGE + 0.5, 0.0), 1.0)
    return t * t * (3 - 2 * t)


def main():
    cells = [[0.0] * NX for _ in range(NY)]
    font = Font()
    for text, foot in LINES:
        draw_line(cells, DX, font, text, MIDDLE, foot, PIXEL, HEIGHT)
    for row in range(NY):
        for column in range(NX):
            share = logo((column + 0.5) * DX - LOGO[0], (row + 0.5) * DX - LOGO[1])
            cells[row][column] = max(cells[row][column], HEIGHT * share)
    write_png(os.path.join(HERE, "sand.png"), NX, NY, WHITE, lambda column, row: cells[row][column])


if __name__ == "__main__":
    main()
