#!/usr/bin/env python3
"""Writes terrain.png: a winding canyon cut into a plateau, 200 x 256 samples of 0.5 m, 16 bits, black 0 m, white 24 m.

The stream enters in the north and falls towards the south by BED_SLOPE per metre along its line. Its line is a cosine, so
that it runs due south at the bends, which is where level.json puts the dams.
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.dirname(HERE))
from map_writer import write_png  # noqa: E402

NX, NY, DX = 200, 256, 0.5
WHITE = 24.0            # height of white [m]
MIDDLE, SWING, WAVE = 50.0, 12.0, 64.0  # of the stream line [m]
BED_END = 0.6           # bed at the south end [m]
BED_SLOPE = 0.05
FLOOR = 5.0             # half width of the flat floor [m]
WALL = 9.0              # width of the walls [m]
DEPTH = 10.5            # of the canyon below the plateau [m]


def stream_line():
    """Points (x, y, bed elevation) of the stream from south to north, every 0.25 m of y, a little beyond the map."""
    points = []
    along = 0.0
    step = 0.25
    for n in range(-40, int(NY * DX / step) + 41):
        y = n * step
        x = MIDDLE + SWING * math.cos(2 * math.pi * (NY * DX - y) / WAVE)
        if points:
            along += math.hypot(x - points[-1][0], step)
        points.append((x, y, BED_END + BED_SLOPE * along))
    return points


def smooth(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3 - 2 * t)


def relief(x, y):
    """Gentle furrows on the plateau [m]."""
    return 0.5 * math.sin(0.30 * x + 0.22 * y) + 0.4 * math.sin(0.17 * x - 0.26 * y + 1.0)


def height(points, x, y):
    near = [p for p in points if abs(p[1] - y) < FLOOR + WALL + 2]
    square, bed = min(((p[0] - x) ** 2 + (p[1] - y) ** 2, p[2]) for p in near)
    plateau = BED_END + BED_SLOPE * 1.35 * y + DEPTH + relief(x, y)
    return bed + (plateau - bed) * smooth((math.sqrt(square) - FLOOR) / WALL)


def main():
    points = stream_line()
    write_png(os.path.join(HERE, "terrain.png"), NX, NY, WHITE,
              lambda column, row: height(points, (column + 0.5) * DX, (row + 0.5) * DX))


if __name__ == "__main__":
    main()
