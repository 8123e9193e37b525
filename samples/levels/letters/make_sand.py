#!/usr/bin/env python3
"""Writes sand.png: the words SAND & WATER as sand, 640 x 320 samples of 0.1 m, 16 bits, black 0 m, white 1 m."""
import os
import sys

from lettering import Font, draw_line

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.dirname(HERE))
from map_writer import write_png  # noqa: E402

NX, NY, DX = 640, 320, 0.1
WHITE = 1.0
HEIGHT = 0.8            # of the letters [m]
PIXEL = 0.22            # side of a pixel of the font [m]
FOOT = 14.0             # of the line of text, from the south [m]


def main():
    cells = [[0.0] * NX for _ in range(NY)]
    draw_line(cells, DX, Font(), "SAND & WATER", 0.5 * NX * DX, FOOT, PIXEL, HEIGHT)
    write_png(os.path.join(HERE, "sand.png"), NX, NY, WHITE, lambda column, row: cells[row][column])


if __name__ == "__main__":
    main()
