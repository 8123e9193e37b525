#!/usr/bin/env python3
"""Writes sand.png: a castle of sand, 512 x 256 samples of 0.1 m, 16 bits, black 0 m, white 4 m.

Four round towers, curtain walls with battlements, a gatehouse towards the sea in the west and a keep, all on one mound: sand
that stands on bare ground in single walls would be pushed away piece by piece.
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from map_writer import write_png  # noqa: E402

NX, NY, DX = 512, 256, 0.1
WHITE = 4.0
MIDDLE = (19.6, 12.8)   # of the castle [m]
HALF = 4.6              # from the middle to the axes of the walls [m]
MOUND, MOUND_TOP, MOUND_SLOPE = 6.1, 1.15, 1.2
WALL, WALL_TOP = 0.8, 2.15          # half width, height [m]
TOWER, TOWER_TOP = 1.55, 3.1        # radius, height
KEEP, KEEP_TOP = 1.8, 3.5           # half width, height
GATE, GATE_TOP, GATE_FLOOR = 1.3, 2.8, 1.35
EDGE = 0.25             # width over which the walls rise [m]
TOOTH, MERLON = 0.9, 0.25           # period and height of the battlements [m]


def rise(distance):
    """0 ... 1 across a wall's face; distance is positive inside."""
    t = min(max(distance / EDGE + 0.5, 0.0), 1.0)
    return t * t * (3 - 2 * t)


def teeth(along):
    return MERLON * (0.5 + 0.5 * math.tanh(6 * math.cos(2 * math.pi * along / TOOTH)))


def raise_to(ground, top, distance):
    return max(ground, ground + (top - ground) * rise(distance))


def height(x, y):
    x -= MIDDLE[0]
    y -= MIDDLE[1]
    ring = max(abs(x), abs(y))
    outside = math.hypot(max(abs(x) - HALF, 0.0), max(abs(y) - HALF, 0.0)) - (MOUND - HALF)
    h = min(MOUND_TOP, max(0.0, MOUND_TOP - MOUND_SLOPE * outside))
    along = y if abs(x) > abs(y) else x
    outer = teeth(along) if ring > HALF + 0.25 * WALL else 0.0
    h = raise_to(h, WALL_TOP + outer, WALL - abs(ring - HALF))
    gate = min(GATE - abs(y), GATE - abs(x + HALF))
    h = raise_to(h, GATE_TOP, gate)
    if x < -HALF + 2 * GATE and abs(y) < 0.45 and x > -HALF - GATE - 0.1:
        h = min(h, GATE_FLOOR)
    for corner_x in (-HALF, HALF):
        for corner_y in (-HALF, HALF):
            radius = math.hypot(x - corner_x, y - corner_y)
            rim = teeth(math.atan2(y - corner_y, x - corner_x) * TOWER) if radius > TOWER - 0.5 else 0.0
            h = raise_to(h, TOWER_TOP + rim, TOWER - radius)
    keep = KEEP - max(abs(x - 0.6), abs(y))
    rim = teeth(y if abs(x - 0.6) > abs(y) else x - 0.6) if keep < 0.45 else -0.15
    return raise_to(h, KEEP_TOP + rim, keep)


def main():
    write_png(os.path.join(HERE, "sand.png"), NX, NY, WHITE, lambda column, row: height((column + 0.5) * DX, (row + 0.5) * DX))


if __name__ == "__main__":
    main()
