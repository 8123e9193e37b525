"""What claims about levels are made of: fields of a recorded run, and numbers taken from them. Plain Python, no packages."""
import array
import math
import pathlib
import re
import struct


def read_npy(path):
    """A float32 field as (nx, ny, values), row 0 in the south."""
    data = pathlib.Path(path).read_bytes()
    if data[:6] != b"\x93NUMPY" or data[6] != 1:
        raise ValueError(f"{path}: not an NPY file of version 1")
    (length,) = struct.unpack_from("<H", data, 8)
    header = data[10:10 + length].decode()
    shape = re.search(r"'shape': \((\d+), (\d+)\)", header)
    if "'<f4'" not in header or shape is None:
        raise ValueError(f"{path}: want a float32 array of two dimensions, found {header}")
    values = array.array("f")
    values.frombytes(data[10 + length:])
    return int(shape[2]), int(shape[1]), values


class Box:
    """Cells whose centres lie in [west, east) x [south, north), metres."""

    def __init__(self, west, south, east, north):
        self.west, self.south, self.east, self.north = west, south, east, north


class Run:
    """One recorded run. Fields by the recorder's names (H, hs, W, hw, surface, phi, ...) at the times that were dumped."""

    def __init__(self, folder, nx, ny, dx, times):
        self.folder, self.nx, self.ny, self.dx, self.times = pathlib.Path(folder), nx, ny, dx, times
        self.cache = {}

    def field(self, name, time):
        time = f"{time:g}"
        key = (name, time)
        if key not in self.cache:
            nx, ny, values = read_npy(self.folder / f"{name}_{time}.npy")
            if (nx, ny) != (self.nx, self.ny):
                raise ValueError(f"{name} at {time} s has {nx} x {ny} cells, the run {self.nx} x {self.ny}")
            self.cache[key] = values
        return self.cache[key]

    def cells(self, box=None):
        """(index, x, y) of every cell centre, those in the box only."""
        for j in range(self.ny):
            y = (j + 0.5) * self.dx
            if box is not None and not box.south <= y < box.north:
                continue
            for i in range(self.nx):
                x = (i + 0.5) * self.dx
                if box is None or box.west <= x < box.east:
                    yield j * self.nx + i, x, y

    def volume(self, name, time, box=None):
        """Of hs, W or hw [m3]."""
        field = self.field(name, time)
        return math.fsum(field[n] for n, _, _ in self.cells(box)) * self.dx * self.dx

    def standing(self, time, least, box=None):
        """Volume of the sand in cells that hold more than `least` metres of it [m3]: what is still a wall and not a film."""
        sand = self.field("hs", time)
        return math.fsum(sand[n] for n, _, _ in self.cells(box) if sand[n] > least) * self.dx * self.dx

    def emerged(self, time, box=None):
        """Volume of the sand in cells where it rises above the water [m3]."""
        sand, water = self.field("hs", time), self.field("W", time)
        return math.fsum(sand[n] for n, _, _ in self.cells(box) if sand[n] > water[n]) * self.dx * self.dx

    def largest(self, name, time, box=None):
        field = self.field(name, time)
        return max(field[n] for n, _, _ in self.cells(box))

    def mean(self, name, time, box=None):
        field = self.field(name, time)
        values = [field[n] for n, _, _ in self.cells(box)]
        return math.fsum(values) / len(values)

    def center(self, time, box=None):
        """Centre of mass of the sand (x, y) [m]."""
        sand = self.field("hs", time)
        total = sx = sy = 0.0
        for n, x, y in self.cells(box):
            total += sand[n]
            sx += sand[n] * x
            sy += sand[n] * y
        return sx / total, sy / total

    def shift(self, start, end, box=None):
        """How far the sand's centre of mass moves [m]."""
        return math.dist(self.center(start, box), self.center(end, box))

    def spread(self, time, box=None):
        """Root mean square distance of the sand from its centre of mass [m]."""
        sand = self.field("hs", time)
        cx, cy = self.center(time, box)
        total = moment = 0.0
        for n, x, y in self.cells(box):
            total += sand[n]
            moment += sand[n] * ((x - cx) ** 2 + (y - cy) ** 2)
        return math.sqrt(moment / total)

    def radius(self, center, time, box=None, least=0.02):
        """Largest distance from a point of a cell with more than `least` metres of sand [m]."""
        sand = self.field("hs", time)
        return max((math.dist(center, (x, y)) for n, x, y in self.cells(box) if sand[n] > least), default=0.0)

    def relief(self, time, width, box=None):
        """Root mean square of what the sand's depth differs by from its mean over squares of `width` metres: battlements, ripples [m]."""
        sand, reach, wide = self.field("hs", time), max(1, round(width / self.dx / 2)), self.nx + 1
        sums = [0.0] * (wide * (self.ny + 1))  # of all cells to the south-west
        for j in range(self.ny):
            row = 0.0
            for i in range(self.nx):
                row += sand[j * self.nx + i]
                sums[(j + 1) * wide + i + 1] = sums[j * wide + i + 1] + row
        squares = []
        for n, _, _ in self.cells(box):
            i, j = n % self.nx, n // self.nx
            west, east = max(i - reach, 0), min(i + reach + 1, self.nx)
            south, north = max(j - reach, 0), min(j + reach + 1, self.ny)
            total = sums[north * wide + east] - sums[south * wide + east] - sums[north * wide + west] + sums[south * wide + west]
            squares.append((sand[n] - total / ((east - west) * (north - south))) ** 2)
        return math.sqrt(math.fsum(squares) / len(squares))

    def moved(self, start, end, box=None):
        """Volume of sand that lies elsewhere than before: half the integral of |change| [m3]."""
        before, after = self.field("hs", start), self.field("hs", end)
        return 0.5 * math.fsum(abs(after[n] - before[n]) for n, _, _ in self.cells(box)) * self.dx * self.dx

    def crest(self, time, box):
        """What water behind a dam in the box must rise to: the lowest, over the rows along y, of the highest ground along x
        where the box is longer in y, else the other way round [m above the ground's datum]."""
        ground, sand = self.field("H", time), self.field("hs", time)
        lines = {}
        along_y = box.north - box.south > box.east - box.west
        for n, x, y in self.cells(box):
            line = y if along_y else x
            lines[line] = max(lines.get(line, -math.inf), ground[n] + sand[n])
        return min(lines.values())

    def crest_depth(self, time, box):
        """The same in depth of sand: the lowest, over the lines across the dam, of the largest depth [m]."""
        sand = self.field("hs", time)
        lines = {}
        along_y = box.north - box.south > box.east - box.west
        for n, x, y in self.cells(box):
            line = y if along_y else x
            lines[line] = max(lines.get(line, 0.0), sand[n])
        return min(lines.values())

    def ring(self, name, time, center, inner, outer):
        """Mean over the ring between two radii."""
        field = self.field(name, time)
        values = [field[n] for n, x, y in self.cells() if inner <= math.dist(center, (x, y)) < outer]
        return math.fsum(values) / len(values)

    def first(self, condition):
        """The first of the run's times at which the condition holds, else infinity."""
        return next((time for time in self.times if condition(time)), math.inf)
