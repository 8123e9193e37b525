#!/usr/bin/env python3
"""Writes terrain.asc and sand.asc: a dry valley in a dissected plateau and the dunes in it, 224 x 144 cells of 2 m.

The plateau starts as noise with a winding ditch from west to east. Rain that runs off cuts it by the stream power law,
dz/dt = -K A^m S, solved implicitly from the outlet upwards, while slopes creep; then the main valley gets its flat floor.
Deterministic, standard library only; about 20 s.
"""
import heapq
import math
import os

NX, NY, CELL = 224, 144, 2.0
BASE = 412.0            # elevation of the valley's mouth [m]; level.json takes it off again
FALL = 0.02             # of the valley floor, per metre to the east
PLATEAU = 22.0          # above the floor [m]
FLOOR = (11.0, 19.0)    # half width of the floor, narrowest and widest [m]
WALL = 16.0             # over which the valley's sides reach the eroded land [m]
ROUNDS, EROSION, AREA_POWER, CREEP = 36, 0.05, 0.45, 0.05
SPACING = 46.0          # of the dunes [m]
INFLOW = 3000.0         # cells that drain into the valley's west end


def mix(n):
    n = (n ^ (n >> 15)) * 0x2C1B3C6D & 0xFFFFFFFF
    n = (n ^ (n >> 12)) * 0x297A2D39 & 0xFFFFFFFF
    return (n ^ (n >> 15)) / 0xFFFFFFFF


def smooth(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3 - 2 * t)


def noise(x, y, wavelength, octaves, seed):
    """Value noise within about +-1."""
    total, scale, weight = 0.0, 1 / wavelength, 1.0
    for octave in range(octaves):
        u, v = x * scale, y * scale
        i, j = math.floor(u), math.floor(v)
        a, b = smooth(u - i), smooth(v - j)
        corner = [2 * mix((i + di) * 0x9E3779B1 + (j + dj) * 0x85EBCA6B + (seed + octave) * 0xC2B2AE35 & 0xFFFFFFFF) - 1 for dj in (0, 1) for di in (0, 1)]
        total += weight * ((corner[0] * (1 - a) + corner[1] * a) * (1 - b) + (corner[2] * (1 - a) + corner[3] * a) * b)
        scale, weight = 2 * scale, weight / 2
    return total


def centre(x):
    """y of the valley's middle line [m]."""
    return 144 + 38 * math.sin(2 * math.pi * x / 290 + 0.6) + 9 * math.sin(2 * math.pi * x / 118 + 2) + 7 * noise(x, 0, 80, 3, 40)


def floor_height(x):
    return FALL * (NX * CELL - x)


def places():
    for j in range(NY):
        for i in range(NX):
            yield i + j * NX, (i + 0.5) * CELL, (j + 0.5) * CELL


def neighbours(cell):
    i, j = cell % NX, cell // NX
    for dj in (-1, 0, 1):
        for di in (-1, 0, 1):
            if (di or dj) and 0 <= i + di < NX and 0 <= j + dj < NY:
                yield cell + di + dj * NX, CELL * math.hypot(di, dj)


def distances():
    """Of every cell from the valley's middle line [m], and x of the nearest point of the line."""
    line = [(2.0 * n, centre(2.0 * n)) for n in range(-20, int(NX * CELL / 2) + 21)]
    found = []
    for _, x, y in places():
        near = line[max(0, int(x / 2) - 20) : int(x / 2) + 62]
        square, at = min(((px - x) ** 2 + (py - y) ** 2, px) for px, py in near)
        found.append((math.sqrt(square), at))
    return found


def drain(height, outlets):
    """Cells from the outlets upwards and where each drains to; hollows drain over their lowest rim."""
    queue = [(height[c], c) for c in outlets]
    receiver = {c: (c, CELL) for c in outlets}
    heapq.heapify(queue)
    order = []
    while queue:
        level, cell = heapq.heappop(queue)
        order.append(cell)
        for other, length in neighbours(cell):
            if other not in receiver:
                receiver[other] = (cell, length)
                heapq.heappush(queue, (max(level, height[other]), other))
    for cell in order:  # steepest descent where there is one
        best = max(((height[cell] - height[o]) / l, o, l) for o, l in neighbours(cell))
        if best[0] > 0 and receiver[cell][0] != cell:
            receiver[cell] = best[1:]
    return order, receiver


def erode(height, inlet, outlets):
    for _ in range(ROUNDS):
        order, receiver = drain(height, outlets)
        order.sort(key=lambda c: height[c])
        area = [1.0] * (NX * NY)
        area[inlet] += INFLOW
        for cell in reversed(order):
            if receiver[cell][0] != cell:
                area[receiver[cell][0]] += area[cell]
        for cell in order:
            to, length = receiver[cell]
            if to == cell or height[to] >= height[cell]:
                continue
            share = EROSION * area[cell] ** AREA_POWER * CELL / length
            height[cell] = (height[cell] + share * height[to]) / (1 + share)
        crept = list(height)
        for cell in range(NX * NY):
            around = [height[o] for o, l in neighbours(cell) if l == CELL]
            crept[cell] += CREEP * (sum(around) - len(around) * height[cell])
        for cell in outlets:
            crept[cell] = height[cell]
        height = crept
    return height


def make_terrain(line):
    height = []
    for cell, x, y in places():
        rise = PLATEAU + 5 * noise(x, y, 120, 5, 1) + 0.03 * abs(y - centre(x))
        height.append(floor_height(x) + rise * smooth(line[cell][0] / 60 + 0.08))
    row = lambda x: int(centre(x) / CELL)
    inlet = row(0) * NX
    outlets = [j * NX + NX - 1 for j in range(row(NX * CELL) - 3, row(NX * CELL) + 4)]
    height = erode(height, inlet, outlets)
    terrain = []
    for cell, x, y in places():
        distance, at = line[cell]
        half = FLOOR[0] + (FLOOR[1] - FLOOR[0]) * (0.5 + 0.5 * noise(at, 0, 70, 2, 7))
        floor = floor_height(x) + 0.25 * noise(x, y, 25, 3, 9)
        bank = smooth((distance - half) / WALL)
        land = max(height[cell], floor + 0.3)
        terrain.append(floor + (land - floor) * bank)
    return terrain


def make_sand(line, terrain):
    """Dunes in the valley and thin sand between them, slip faces to the east. Every third crosses it, the others leave a way round."""
    sand = []
    for cell, x, y in places():
        distance, at = line[cell]
        across = (y - centre(at)) / FLOOR[1]
        along = (at + 5 * noise(x, y, 30, 2, 21) - 6 * across * across) / SPACING
        number, phase = math.floor(along), along % 1
        profile = phase / 0.65 if phase < 0.65 else (1 - phase) / 0.35
        height = (2.5 + 0.6 * noise(x, y, 50, 2, 33)) * smooth((profile - 0.25) / 0.75)
        if number % 3:
            height *= smooth(((1 if number % 3 == 1 else -1) * across + 0.75) / 0.7)
        bank = 1 - smooth((terrain[cell] - floor_height(x) - 1) / 2.5)
        ends = smooth((x - 60) / 20) * smooth((NX * CELL - 30 - x) / 20)
        sand.append(bank * max(0.0, 0.25 * noise(x, y, 22, 3, 50) - 0.05 + height * ends))
    return sand


def write(name, values):
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), name)
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"ncols {NX}\nnrows {NY}\nxllcorner 0\nyllcorner 0\ncellsize {CELL:g}\nNODATA_value -9999\n")
        for j in reversed(range(NY)):
            file.write(" ".join(f"{v:.2f}" for v in values[j * NX : (j + 1) * NX]) + "\n")


def main():
    line = distances()
    terrain = make_terrain(line)
    write("terrain.asc", [BASE + h for h in terrain])
    write("sand.asc", make_sand(line, terrain))


if __name__ == "__main__":
    main()
