#!/usr/bin/env python3
"""Draws levels that nobody tuned anything for, for judge.py --drawn. Usage: drawn_levels.py BIN --seed S [--count N] [--out DIR]; needs numpy.

A level follows from seed, number and try alone, the same on every machine. Eight kinds of scene, in an order that the seed shuffles; all of
them come before one comes again. Sizes, amounts, slopes, materials, method and duration are drawn for each. A level is drawn again, with
the next try, where the recorder does not run it to its end with finite values, or where hardly anything moves: on 48 cells along the
shorter side, the visible surface of less than 3 % of the cells moves by over 2 % of the greatest depth of sand or water, until half or all of
its time. The ranges were chosen, and committed, before the tuner ran on any of these levels; whoever changes one makes other levels."""
import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy

TRIES = 20
CHECK_SIDE, MOVED_DEPTHS, LEAST_MOVED = 48, 0.02, 0.03  # cells; of the greatest depth; of the cells
GRAVITY, SAND_WEIGHT = 9.81, 2000 * 9.81


def rounded(value):
    """To three digits, as a designer would write it."""
    return float(f"{value:.3g}")


class Scene:
    """A level in the making: places along its length and across it, in shares of the short side, turned to one of four sides."""

    def __init__(self, dice, name):
        self.dice = dice
        cells, aspect = 16 * dice.randrange(6, 13), self.between(1, 2)
        self.dx = float(f"{self.log(10, 60) / cells:.2g}")
        self.long_cells, self.short_cells = 16 * round(aspect * cells / 16), cells
        self.side = self.dx * cells  # the short one [m]
        self.length = self.long_cells / cells  # in short sides
        self.turn = dice.randrange(4)  # what is at 0 along it lies in the west, south, east or north
        nx, ny = (self.long_cells, cells) if self.turn % 2 == 0 else (cells, self.long_cells)
        self.level = {"format_version": 1, "name": name, "grid": {"nx": nx, "ny": ny, "dx": self.dx}, "duration": rounded(self.between(3, 10)),
                      "terrain": [], "sand": [], "water": [], "material": {}, "method": {}}
        self.wall = 0  # highest cut of damp sand [m]
        self.depth = 0  # of what falls or runs [m]
        self.relief = 0  # of the terrain [m]

    def between(self, low, high):
        return low + (high - low) * self.dice.random()

    def log(self, low, high):
        return low * (high / low) ** self.dice.random()

    def chance(self, share):
        return self.dice.random() < share

    def metres(self, share):
        return rounded(share * self.side)

    def at(self, along, across):
        """[x, y] of a place."""
        along, across = along * self.side, across * self.side
        if self.turn >= 2:
            along = self.length * self.side - along
        return [rounded(along), rounded(across)] if self.turn % 2 == 0 else [rounded(across), rounded(along)]

    def slope(self, per_metre):
        """Keys of a plane that rises so along the scene from height 0 at its start; and its height in the south-west corner."""
        key = "slope_x" if self.turn % 2 == 0 else "slope_y"
        return ({key: rounded(per_metre)}, 0.0) if self.turn < 2 else ({key: rounded(-per_metre)}, rounded(per_metre * self.length * self.side))

    def rises(self, layer, per_metre, height, key="height"):
        """Puts a plane into a layer: height [m] at the scene's start."""
        keys, corner = self.slope(per_metre)
        layer.append({"shape": "plane", key: rounded(height + corner), **keys})
        return layer[-1]

    def box(self, along, across, to_along, to_across):
        a, b = self.at(along, across), self.at(to_along, to_across)
        return {"shape": "box", "from": [min(a[0], b[0]), min(a[1], b[1])], "to": [max(a[0], b[0]), max(a[1], b[1])]}

    def side_name(self, end):
        """Of the start (0) or the end (1) of the scene."""
        return [("west", "east"), ("south", "north"), ("east", "west"), ("north", "south")][self.turn][end]

    def noise(self, layer, amplitude, where=None):
        noise = {"shape": "noise", "amplitude": rounded(amplitude), "wavelength": self.metres(self.between(0.1, 0.4)), "octaves": self.dice.randrange(1, 5),
                 "seed": self.dice.randrange(1000)}
        layer.append(noise | ({"where": where} if where else {}))

    def hills(self, count, low, high, start):
        for _ in range(count):
            place, height = self.at(self.between(start, self.length), self.between(0, 1)), self.metres(self.log(low, high))
            if self.chance(0.5):
                hill = {"shape": "cone", "center": place, "radius": self.metres(self.between(0.08, 0.25)), "height": height}
            else:
                hill = {"shape": "cylinder", "center": place, "radius": self.metres(self.between(0.03, 0.1)), "height": height, "side_slope": rounded(self.log(0.5, 4))}
            self.level["terrain"].append(hill)
            self.relief += height

    def heap(self, along, across, height, wet=None):
        """A heap, a column or a block of sand; damp where its water is told as a share of its depth."""
        kind = self.dice.randrange(4 if wet is None else 3)  # a cone takes no wetness
        size = self.between(0.06, 0.18)
        if kind == 0:
            shape = {"shape": "cylinder", "center": self.at(along, across), "radius": self.metres(size)}
        elif kind == 1:
            shape = self.box(along - size, across - self.between(0.06, 0.18), along + size, across + self.between(0.06, 0.18))
        elif kind == 2:
            bend = self.between(-0.15, 0.15)
            points = [self.at(along, across - 0.2), self.at(along + bend, across), self.at(along, across + 0.2)]
            shape = {"shape": "ridge", "points": points, "width": self.metres(self.between(0.05, 0.15))}
        else:
            shape = {"shape": "cone", "center": self.at(along, across), "radius": self.metres(size)}
        self.level["sand"].append({**shape, "height": rounded(height)})
        if wet is not None:
            self.level["water"].append({**shape, "wet": rounded(wet)})
        self.depth = max(self.depth, height)
        self.wall = max(self.wall, height)

    def finish(self):
        """Material, method and time step: of what stands there, as the levels' page advises, or somewhat off."""
        level, material, method = self.level, self.level["material"], self.level["method"]
        wall = max(self.wall, 0.3)
        material["friction"] = rounded(self.between(0.2, 0.75))
        material["young_modulus"] = rounded(self.between(5, 15) * SAND_WEIGHT * wall)
        cohesion = rounded(0.17 * SAND_WEIGHT * wall * self.log(0.3, 3))
        material |= {"cohesion_dry": rounded(cohesion * self.between(0, 0.05)) if self.chance(0.6) else 0, "cohesion_wet": cohesion, "cohesion_capillary": cohesion}
        material["exchange_rate"] = rounded(self.log(1e4, 3e5))
        material["diffusion_rate"] = rounded(self.log(0.002, 0.03))
        if self.chance(0.5):
            material["bed_friction"] = rounded(self.log(0.003, 0.02))
        if self.chance(0.35):
            material["bed_shear"] = rounded(self.log(0.005, 0.05))
        if self.chance(0.2):
            material["retention"] = 0
        method["substeps"] = self.dice.randrange(2, 4)
        method["saturation_smoothing"] = self.dice.randrange(3)
        if self.chance(0.3):
            method["bulk_viscosity"] = 0.1
        method["largest_height"] = 2.0 ** math.ceil(math.log2(2 * (self.depth + self.relief) + 1))
        fastest = 2 * math.sqrt(GRAVITY * max(self.depth, 0.2))  # a dam break's front [m/s]
        level["dt"] = rounded(0.35 * self.dx / fastest * self.between(0.8, 1.8))
        return {key: value for key, value in level.items() if value != []}


def gate(s):
    """A pool behind a wall with a gate that is gone: the water runs into a valley with hills."""
    level, depth, wall = s.level, s.between(0.04, 0.15), s.between(0.3, 0.5)
    s.rises(level["terrain"], -s.between(0, 0.06), 0.06 * s.length * s.side)
    s.relief += 0.06 * s.length * s.side
    s.hills(s.dice.randrange(2, 7), 0.05, 0.2, wall + 0.15)
    s.noise(level["terrain"], s.side * s.log(0.002, 0.02))
    gap, middle, thick = s.between(0.12, 0.45), s.between(0.3, 0.7), s.between(0.06, 0.1)
    top = rounded(0.06 * s.length * s.side + 1.3 * depth * s.side)
    for low, high in ((0, middle - gap / 2), (middle + gap / 2, 1)):
        level["terrain"].append({**s.box(wall, low, wall + thick, high), "height": top, "combine": "max"})
    if s.chance(0.6):
        s.heap(wall + thick + s.between(0.15, 0.35), middle + s.between(-0.15, 0.15), s.side * s.between(0.03, 0.1), s.between(0.05, 0.25) if s.chance(0.5) else None)
    level["water"].append({**s.box(0, 0, wall + thick / 2, 1), "surface": rounded(0.06 * s.length * s.side + depth * s.side)})
    s.depth = max(s.depth, (depth + 0.06 * wall) * s.side)


def slide(s):
    """Heaps of dry sand, some damp, on a slope that ends on level ground."""
    level, steep, foot = s.level, s.between(0.15, 0.7), s.between(0.3, 0.6) * s.length
    s.rises(level["terrain"], -steep, steep * foot * s.side)
    level["terrain"].append({"shape": "plane", "height": 0, "combine": "max"})
    s.relief += steep * foot * s.side
    if s.chance(0.5):
        s.hills(s.dice.randrange(1, 4), 0.03, 0.1, foot)
    for _ in range(s.dice.randrange(1, 5)):
        s.heap(s.between(0.15, foot), s.between(0.15, 0.85), s.side * s.between(0.05, 0.2), s.between(0.05, 0.3) if s.chance(0.3) else None)
    s.noise(level["sand"], s.side * s.log(0.001, 0.01), "present")


def wave(s):
    """A wave of water that meets blocks of damp sand on nearly level ground."""
    level, height = s.level, s.between(0.05, 0.18)
    s.rises(level["terrain"], s.between(0, 0.04), 0)
    s.relief += 0.04 * s.length * s.side
    if s.chance(0.4):
        s.hills(s.dice.randrange(1, 4), 0.03, 0.1, 0.5 * s.length)
    for _ in range(s.dice.randrange(1, 4)):
        s.heap(s.between(0.45, 0.85) * s.length, s.between(0.2, 0.8), s.side * s.between(0.04, 0.15), s.between(0.1, 0.25))
    level["water"].append({**s.box(0, 0, s.between(0.2, 0.35) * s.length, 1), "height": s.metres(height)})
    s.depth = max(s.depth, height * s.side)


def spring(s):
    """A spring near the top of a hill under a layer of sand; what runs down leaves over the sides."""
    level, top = s.level, s.between(0.1, 0.3)
    middle = (s.between(0.35, 0.65) * s.length, s.between(0.35, 0.65))
    level["terrain"].append({"shape": "cone", "center": s.at(*middle), "radius": s.metres(s.between(0.5, 0.9)), "height": s.metres(top)})
    s.relief += top * s.side
    s.noise(level["terrain"], s.side * s.log(0.003, 0.02))
    layer = s.between(0.01, 0.05)
    level["sand"].append({"shape": "plane", "height": s.metres(layer)})
    s.noise(level["sand"], s.side * layer * s.between(0.1, 0.5), "present")
    radius, rate = s.between(0.03, 0.08), s.log(0.01, 0.08) * s.side
    end = level["duration"] * s.between(0.5, 1.2)
    level["sources"] = [{"shape": "disc", "center": s.at(middle[0] + s.between(-0.1, 0.1), middle[1] + s.between(-0.1, 0.1)), "radius": s.metres(radius),
                         "rate": [[0, rounded(rate)], [rounded(end), rounded(rate)], [rounded(1.1 * end), 0]]}]
    level["sides"] = {side: {"kind": "outflow"} for side in ("west", "east", "south", "north")}
    s.depth = s.wall = max(0.05, layer) * s.side


def beach(s):
    """A lake with a wave that runs up a beach of sand."""
    level, rise, depth = s.level, s.between(0.05, 0.25), s.between(0.04, 0.12)
    s.rises(level["terrain"], rise, 0)
    s.relief += rise * s.length * s.side
    s.noise(level["terrain"], s.side * s.log(0.002, 0.015))
    layer = s.between(0.015, 0.06)
    s.rises(level["sand"], rise, layer * s.side, "surface")
    if s.chance(0.5):
        s.heap(depth / rise + s.between(0.05, 0.3), s.between(0.25, 0.75), s.side * s.between(0.03, 0.08), s.between(0.05, 0.25))
    height = s.between(0.3, 1) * depth
    level["water"].append({"shape": "plane", "surface": s.metres(depth)})
    if s.chance(0.5):
        hump = s.box(0, 0, s.between(0.1, 0.25), 1) if s.chance(0.5) else {"shape": "cylinder", "center": s.at(0.15, s.between(0.2, 0.8)), "radius": s.metres(s.between(0.1, 0.2))}
        level["water"].append({**hump, "height": s.metres(height)})
    else:
        period, times = s.between(1.5, 4), []
        for n in range(math.ceil(level["duration"] / period)):
            times += [[rounded(n * period), 0], [rounded((n + 0.5) * period), s.metres(height)]]
        level["sides"] = {s.side_name(0): {"kind": "waves", "value": s.metres(depth), "wave": times}}
    s.depth = max(s.depth, s.wall, (depth + height) * s.side)


def rain(s):
    """Heavy rain on a basin with hills and a skin of sand."""
    level, rim = s.level, s.between(0.08, 0.3)
    level["terrain"].append({"shape": "plane", "height": s.metres(rim)})
    level["terrain"].append({"shape": "cylinder", "center": s.at(s.between(0.4, 0.6) * s.length, s.between(0.4, 0.6)), "radius": s.metres(s.between(0.1, 0.25)),
                             "height": s.metres(rim), "side_slope": rounded(rim / s.between(0.2, 0.4)), "combine": "subtract"})
    s.relief += rim * s.side
    s.hills(s.dice.randrange(1, 5), 0.03, 0.12, 0)
    s.noise(level["terrain"], s.side * s.log(0.005, 0.03))
    if s.chance(0.7):
        level["sand"].append({"shape": "plane", "height": s.metres(s.between(0.003, 0.02))})
        s.noise(level["sand"], s.side * 0.003, "present")
    if s.chance(0.5):
        level["water"].append({"shape": "plane", "surface": s.metres(rim * s.between(0.2, 0.5)), "inside_sand": True})
    rate = s.log(0.003, 0.03)
    level["rain"] = rounded(rate) if s.chance(0.5) else [[0, rounded(rate)], [rounded(level["duration"] * s.between(0.3, 0.7)), rounded(rate)], [level["duration"], 0]]
    s.depth, s.wall = 0.3 * rim * s.side, 0.02 * s.side


def slump(s):
    """Sand on a steep bank above a lake slides in and raises a wave."""
    level, steep, shore, depth = s.level, s.between(0.3, 0.9), s.between(0.3, 0.5), s.between(0.05, 0.15)
    s.rises(level["terrain"], -steep, steep * shore * s.side)
    level["terrain"].append({"shape": "plane", "height": s.metres(-depth), "combine": "max"})
    level["terrain"].append({"shape": "plane", "height": s.metres(depth)})  # the bottom is 0
    s.relief += (steep * shore + depth) * s.side
    for _ in range(s.dice.randrange(1, 4)):
        s.heap(s.between(0.12, shore), s.between(0.2, 0.8), s.side * s.between(0.05, 0.15), s.between(0.05, 0.4) if s.chance(0.4) else None)
    level["water"].append({"shape": "plane", "surface": s.metres(depth)})
    s.depth = max(s.depth, depth * s.side)


def stream(s):
    """A stream comes in at one end, runs between banks round islands of sand and leaves at the other."""
    level, fall, bank = s.level, s.between(0.01, 0.05), s.between(0.15, 0.3)
    s.rises(level["terrain"], -fall, fall * s.length * s.side)
    s.relief += fall * s.length * s.side
    for across in (0, 1):
        points = [s.at(n / 4 * s.length, across + s.between(-0.08, 0.08)) for n in range(5)]
        level["terrain"].append({"shape": "ridge", "points": points, "width": s.metres(2 * bank), "height": s.metres(0.12), "side_slope": rounded(s.log(0.4, 2))})
    s.relief += 0.12 * s.side
    s.noise(level["terrain"], s.side * s.log(0.002, 0.01))
    if s.chance(0.5):
        level["sand"].append({"shape": "plane", "height": s.metres(s.between(0.005, 0.03))})
    for _ in range(s.dice.randrange(1, 4)):
        s.heap(s.between(0.2, 0.7) * s.length, s.between(0.35, 0.65), s.side * s.between(0.03, 0.08), s.between(0.1, 0.3) if s.chance(0.6) else None)
    depth = s.between(0.02, 0.06) * s.side
    flow = s.between(0.5, 1.5) * depth ** 1.5 * math.sqrt(GRAVITY) * 0.4 * s.side
    level["sides"] = {s.side_name(0): {"kind": "discharge", "value": rounded(flow), "from": s.metres(0.3), "to": s.metres(0.7)},
                      s.side_name(1): {"kind": "outflow"}}
    s.depth = max(s.depth, 2 * depth)


KINDS = (gate, slide, wave, spring, beach, rain, slump, stream)


def draw(seed, number, attempt=0):
    """The level of a number, 0 and up, as it goes into its file."""
    kinds = list(KINDS)
    random.Random(f"wadi {seed} order {number // len(KINDS)}").shuffle(kinds)
    kind = kinds[number % len(KINDS)]
    scene = Scene(random.Random(f"wadi {seed} level {number} try {attempt}"), f"Drawn {kind.__name__} {seed}-{number}-{attempt}")
    scene.level["description"] = " ".join(kind.__doc__.split())
    kind(scene)
    return scene.finish()


def write(level, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "level.json").write_text(json.dumps(level, indent=1) + "\n")


def moved_share(before, after, depth):
    """Of the cells, those whose surface moved."""
    return float((numpy.abs(after - before) > MOVED_DEPTHS * depth).mean())


def refusal(recorder, level):
    """Why a level is drawn again, or "" where it is taken."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        write(level, folder)
        grid = level["grid"]
        scale = CHECK_SIDE / min(grid["nx"], grid["ny"])
        nx, ny = round(scale * grid["nx"]), round(scale * grid["ny"])
        dt, end = level["dt"] * grid["nx"] / nx, level["duration"]
        times = [0] + [round(share * end / dt) * dt for share in (0.5, 1)]
        command = [recorder, folder, "--backend", "cpu", "--threads", "1", "--size", f"{nx}x{ny}", "--dt", f"{dt:.9g}", "--seconds", f"{times[-1] + 0.1 * dt:.9g}", "--no-frames",
                   "--dump", "hs,hw,surface@" + ",".join(f"{time:.9g}" for time in times), "--out", folder / "out", "--summary", folder / "summary.json"]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            return "does not run: " + (done.stderr.strip().splitlines() or ["?"])[-1]
        fields = {name: [numpy.load(folder / "out" / f"{name}_{time:.9g}.npy").astype(float) for time in times] for name in ("hs", "hw", "surface")}
        if not all(numpy.isfinite(field).all() for fields_of in fields.values() for field in fields_of):
            return "values that are not finite"
        depth = max(field.max() for name in ("hs", "hw") for field in fields[name])
        share = max(moved_share(fields["surface"][0], after, depth) for after in fields["surface"][1:])
        return "" if share >= LEAST_MOVED else f"the surface of {100 * share:.2g} % of the cells moves"


def drawn(recorder, seed, number, tell=lambda line: None):
    """The first try of a number that is taken."""
    for attempt in range(TRIES):
        level = draw(seed, number, attempt)
        why = refusal(recorder, level)
        if not why:
            return level
        tell(f"{level['name']}: drawn again: {why}")
    raise RuntimeError(f"seed {seed}, number {number}: {TRIES} tries were not taken")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path, help="folder of wadi-recorder")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=len(KINDS))
    parser.add_argument("--out", type=pathlib.Path, help="writes each level to a folder below this one")
    arguments = parser.parse_args()
    for number in range(arguments.count):
        level = drawn(arguments.bin / "wadi-recorder", arguments.seed, number, lambda line: print(line, flush=True))
        grid = level["grid"]
        print(f"{level['name']}: {grid['nx']} x {grid['ny']} cells of {grid['dx']:g} m, {level['duration']:g} s", flush=True)
        if arguments.out:
            write(level, arguments.out / level["name"].lower().replace(" ", "_"))


if __name__ == "__main__":
    sys.exit(main())
