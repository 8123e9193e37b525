#!/usr/bin/env python3
"""Small maps of all formats, as GIS, engines and editors write them: each loads with its heights, or is refused in words, as the table
here says. Usage: maps.py WADI_IMPORT WADI_RECORDER [--tiff]"""
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

IMPORT, RECORDER = sys.argv[1:3]
NX, NY = 24, 16
SOUTH_UP = [[100.0 + 2 * i + 3 * j + (i * j % 5) * 0.25 for i in range(NX)] for j in range(NY)]  # row 0 in the south
NORTH_DOWN = SOUTH_UP[::-1]
HEADER = f"ncols {NX}\nnrows {NY}\nxllcorner 600000.5\nyllcorner 5200000\ncellsize 2\n"


def text_of(rows, line=" ", end="\n"):
    return end.join(line.join(f"{h:g}" for h in row) for row in rows) + end


def asc(header=HEADER, rows=NORTH_DOWN, **form):
    return (header + text_of(rows, **form)).encode()


def with_hole(value, header=""):
    """A hole inside and three at the north-west corner."""
    rows = [[f"{h:g}" for h in row] for row in NORTH_DOWN]
    for j, i in ((8, 10), (0, 0), (0, 1), (1, 0)):
        rows[j][i] = value
    return (HEADER + header + "\n".join(" ".join(row) for row in rows) + "\n").encode()


def png(rows, bits, colour):
    """`rows` from the north, of tuples of samples."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    data = b"".join(b"\0" + b"".join(sample.to_bytes(bits // 8, "big") for pixel in row for sample in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, colour, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def packed(rows, unit, low, hole=None):
    pixels = []
    for j, row in enumerate(rows):
        pixels.append([])
        for i, h in enumerate(row):
            n = 0 if (i, j) == hole else round((h - low) / unit)
            pixels[-1].append((n >> 16, n >> 8 & 255, n & 255))
    return png(pixels, 8, 2)


def square(n, code, value, order="<"):
    """n x n samples from the north."""
    return b"".join(struct.pack(order + code, value(i, n - 1 - j)) for j in range(n) for i in range(n))


def exr(rows, code="f", names=("Y",), tiled=False):
    """An OpenEXR picture without compression, rows from the north; every channel holds them, all but the first times 2."""
    kind = {"f": 2, "e": 1, "I": 0}[code]
    nx, ny = len(rows[0]), len(rows)

    def attribute(name, sort, data):
        return name.encode() + b"\0" + sort.encode() + b"\0" + struct.pack("<I", len(data)) + data

    channels = b"".join(name.encode() + b"\0" + struct.pack("<IBBBBII", kind, 0, 0, 0, 0, 1, 1) for name in sorted(names)) + b"\0"
    box = struct.pack("<4i", 0, 0, nx - 1, ny - 1)
    head = struct.pack("<II", 20000630, 2 | (0x200 if tiled else 0)) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0") + \
        attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0") + \
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) + \
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    lines = [b"".join(struct.pack(f"<{nx}{code}", *((int if code == "I" else float)(h if name == names[0] else 2 * h) for h in row)) for name in sorted(names))
             for row in rows]
    starts = len(head) + 8 * ny
    offsets = b"".join(struct.pack("<Q", starts + y * (8 + len(lines[y]))) for y in range(ny))
    return head + offsets + b"".join(struct.pack("<iI", y, len(line)) + line for y, line in enumerate(lines))


def npy(descr, code, rows, order=False):
    header = f"{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({len(rows)}, {len(rows[0])}), }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(header)) + header.encode() + b"".join(
        struct.pack("<" + code, h) for row in rows for h in row)


def hill(i, j):
    return 20000 + 300 * i + 200 * j + (i * j) % 7


def grey(rows, white):
    """What --terrain makes of grey: from the darkest to the brightest, an eighth of the longer side."""
    low, high = min(map(min, rows)), max(map(max, rows))
    return [[(v - low) / (high - low) * white for v in row] for row in rows]


SQUARE = [[float(hill(i, j)) for i in range(32)] for j in range(32)]
GREY = grey(SQUARE, 4)
CORNERS = [[sum(hill(i + a, j + b) for a in (0, 1) for b in (0, 1)) / 4 for i in range(32)] for j in range(32)]
FLOATS = [[hill(i, j) / 100 for i in range(32)] for j in range(32)]
BYTES = [[float(4 * i + 3 * j) for i in range(32)] for j in range(32)]
PIXELS = [[(int(v),) for v in row] for row in SQUARE[::-1]]

# What a map loads as. heights: rows from the south, or None; says: in the warnings; low: the least of all; tolerance [m].
def loads(heights=SOUTH_UP, says=(), **more):
    return dict(heights=heights, says=says, **more)


def refused(*words):
    return dict(refused=words)


TABLE = {
    # Esri ASCII grids
    "plain.asc": (asc(), loads()),
    "bom.asc": (b"\xef\xbb\xbf" + asc(), loads()),
    "crlf.asc": (asc(HEADER.replace("\n", "\r\n"), end="\r\n"), loads()),
    "mac.asc": (asc(HEADER.replace("\n", "\r"), end="\r"), loads()),
    "comments.asc": (b"# from a survey\n" + asc().replace(b"nrows", b"// rows\nnrows"), loads()),
    "dx_dy.asc": (asc(HEADER.replace("cellsize 2", "dx 2\ndy 2")), loads()),
    "dy_twice_dx.asc": (asc(HEADER.replace("cellsize 2", "dx 2\ndy 4")), loads(None, ["cells of 2 by 4 m: its 16 rows are resampled to 32"])),
    "center.asc": (asc(HEADER.replace("corner", "center")), loads(origin=(599999.5, 5199999))),
    "upper_case.ASC": (asc(HEADER.upper()), loads()),
    "tabs.asc": (asc(line="\t"), loads()),
    "one_line.asc": (asc(end=" "), loads()),
    "signs.asc": (asc(HEADER, [[h - 150 for h in row] for row in NORTH_DOWN]).replace(b" 2 ", b" +2.0e+00 "),
                  loads([[h - 150 for h in row] for row in SOUTH_UP])),
    "sea.asc": (asc(rows=[[h - 150 for h in row] for row in NORTH_DOWN]), loads(None, ["% of it lies below 0, down to -", "of a level fills it"])),
    "nodata.asc": (with_hole("-9999", "NODATA_value -9999\n"), loads(None, ["taken for outside", "1 of 384 cells hold NODATA_value"])),
    "nodata_null.asc": (with_hole("null", "NODATA_value null\n"), loads(None, ["taken for outside"], low=90)),
    "nodata_nan.asc": (with_hole("nan"), loads(None, ["taken for outside"], low=90)),
    "nodata_float.asc": (with_hole("-3.4028235e+38", "NODATA_value -3.4028234663852886e+38\n"), loads(None, ["taken for outside"], low=90)),
    "nodata_other.asc": (with_hole("-9999", "NODATA_value -32768\n"), loads(None, ["4 cells hold -9999, which is no ground beside"], low=90)),
    "degrees.asc": (asc(HEADER.replace("cellsize 2", "cellsize 0.000277")), loads(None, ["looks like degrees"])),
    "comma.asc": (asc().replace(b".5", b",5"), refused("decimal comma")),
    "few.asc": (asc(rows=NORTH_DOWN[:-1]), refused("the file ends after 360 values")),
    "many.asc": (asc(rows=NORTH_DOWN + [[1.0]]), refused("more values than")),
    "infinite.asc": (with_hole("1e99"), refused("infinite or too large")),
    "twice.asc": (asc(HEADER + "ncols 24\n"), refused("ncols is given twice")),
    "no_key.asc": (asc("columns 24\n" + HEADER), refused("\"columns\" is no key")),
    "empty.asc": (b"", refused("the header ends")),
    "all_holes.asc": (asc(rows=[[-9999.0] * NX] * NY), refused("every value is NODATA_value")),
    # pictures
    "grey16.png": (png(PIXELS, 16, 0), loads(GREY)),
    "grey8.png": (png([[(int(v),) for v in row] for row in BYTES[::-1]], 8, 0), loads(grey(BYTES, 4), tolerance=0.02)),
    "alpha.png": (png([[(v[0], 65535) for v in row] for row in PIXELS], 16, 4), loads(GREY)),
    "cut.png": (png(PIXELS, 16, 0)[:-30], refused("truncated")),
    "flipped_bit.png": (png(PIXELS, 16, 0).replace(b"IHDR\0\0\0\x20", b"IHDR\0\0\0\x21"), refused("wrong checksum")),
    # samples without a header
    "plain.r16": (square(32, "H", hill), loads(GREY)),
    "swapped.r16": (square(32, "H", hill, ">"), loads(GREY, ["its bytes are swapped"])),
    "below_0.r16": (square(32, "h", lambda i, j: (hill(i, j) - 27000) // 10), loads(GREY, ["samples are signed"], tolerance=0.02)),
    "corners.r16": (square(33, "H", hill), loads(grey(CORNERS, 4), ["taken for the corners of cells"], tolerance=0.02)),
    "plain.raw": (square(32, "H", hill), loads(GREY)),
    "bytes.raw": (square(32, "B", lambda i, j: 4 * i + 3 * j), loads(grey(BYTES, 4), ["read as 32 x 32 samples of 8 bits"])),
    "floats.raw": (square(32, "f", lambda i, j: hill(i, j) / 100), loads(FLOATS, ["samples of 32 bits, floats"])),
    "strip.raw": (square(32, "H", hill)[:2 * 32 * 20], refused("is not a square map")),
    "plain.r32": (square(32, "f", lambda i, j: hill(i, j) / 100), loads(FLOATS)),
    "swapped.r32": (square(32, "f", lambda i, j: hill(i, j) / 100, ">"), loads(FLOATS, ["big-endian floats"])),
    "infinite.r32": (square(32, "f", lambda i, j: float("inf") if i == j else 1.0), refused("infinite")),
    # tiles, arrays
    "N46E007.hgt": (square(33, "h", lambda i, j: 500 + i + j, ">"), loads(None, ["a tile of a degree at latitude 46"], low=500)),
    "tile.hgt": (square(33, "h", lambda i, j: -32768 if i == j == 20 else 500 + i + j, ">"),
                 loads(None, ["its name says no latitude", "1 cells hold -32768"], low=500)),
    "plain.npy": (npy("<f4", "f", SOUTH_UP), loads()),
    "double.npy": (npy("<f8", "d", SOUTH_UP), loads()),
    "whole.npy": (npy("<i4", "i", [[int(h) for h in row] for row in SOUTH_UP]), refused("<i4")),
    "columns.npy": (npy("<f4", "f", SOUTH_UP, True), refused("only arrays in C order")),
    # what none of them is
    "picture.bmp": (b"BM" + bytes(60), refused("maps end in .png")),
    "heights.exr": (b"\x76\x2f\x31\x01" + bytes(60), refused("maps end in .png")), # by wadi-import alone
}

# The same by wadi-import, with options of its own.
MIRROR = [row[::-1] for row in SOUTH_UP]
IMPORTS = {
    "terrarium.png": (packed(NORTH_DOWN, 1 / 256, -32768), ["--packed", "terrarium", "--cell", "2"], loads(tolerance=0.01)),
    "mapbox.png": (packed(NORTH_DOWN, 0.1, -10000), ["--packed", "mapbox", "--cell", "2"], loads(tolerance=0.06)),
    "hole.png": (packed(NORTH_DOWN, 0.1, -10000, (5, 5)), ["--packed", "mapbox"], loads(None, ["1 of 384 cells"], low=100)),
    "grey.png": (png(PIXELS, 16, 0), ["--packed", "mapbox"], refused("colours of 8 bits")),
    "packed.asc": (asc(), ["--packed", "mapbox"], refused("only .png maps")),
    "range.png": (png([[(0,), (65535,)], [(65535,), (0,)]], 16, 0), ["--min", "5", "--max", "9"], loads([[9.0, 5.0], [5.0, 9.0]])),
    "strip.raw": (square(32, "H", hill)[:2 * 32 * 20], ["--size", "32x20", "--min", "0", "--max", "65535"], loads(SQUARE[12:], tolerance=1)),
    "flip_x.asc": (asc(), ["--flip", "x"], loads(MIRROR)),
    "flip_y.asc": (asc(), ["--flip", "y"], loads(SOUTH_UP[::-1])),
    "flip_xy.asc": (asc(), ["--flip", "xy"], loads(MIRROR[::-1])),
    "cells.r16": (square(33, "H", hill), ["--samples", "cells", "--min", "0", "--max", "65535"],
                  loads([[float(hill(i, j)) for i in range(33)] for j in range(33)], tolerance=1)),
    "holes_outside.asc": (with_hole("-9999"), [], loads(None, ["1 of 384 cells hold NODATA_value"], low=90)),
    "holes_filled.asc": (with_hole("-9999"), ["--holes", "filled"], loads(None, ["4 of 384 cells hold NODATA_value"], low=100)),
    "holes_wall.asc": (with_hole("-9999"), ["--holes", "wall"], loads(None, at={(10, 7): 191, (0, 15): 191})),
    "holes_pit.asc": (with_hole("-9999"), ["--holes", "pit"], loads(None, at={(10, 7): 95.45, (0, 15): 95.45})),
}

NAN = float("nan")
EXRS = {
    "plain.exr": (exr(NORTH_DOWN), ["--cell", "2"], loads()),
    "half.exr": (exr(NORTH_DOWN, "e"), ["--cell", "2"], loads(tolerance=0.07)),
    "colours.exr": (exr(NORTH_DOWN, "f", ("R", "B", "G")), ["--cell", "2"], loads(SOUTH_UP)),
    "hole.exr": (exr([[NAN if (i, j) == (5, 5) else h for i, h in enumerate(row)] for j, row in enumerate(NORTH_DOWN)]), [],
                 loads(None, ["1 of 384 cells hold NODATA_value"], low=90)),
    "whole.exr": (exr(NORTH_DOWN, "I"), [], refused("whole numbers are not heights")),
    "tiles.exr": (exr(NORTH_DOWN, tiled=True), [], refused("in tiles")),
    "cut.exr": (exr(NORTH_DOWN)[:-300], [], refused("cannot be read as an OpenEXR picture")),
    "text.exr": (b"no picture", [], refused("cannot be read as an OpenEXR picture")),
}
if "--exr" in sys.argv:
    IMPORTS.update(EXRS)


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert done.returncode in (0, 2), (command, done)
    return done


def read_npy(path):
    raw = path.read_bytes()
    start = 10 + struct.unpack_from("<H", raw, 8)[0]
    rows, columns = map(int, re.search(rb"\((\d+), (\d+)\)", raw).groups())
    values = struct.unpack(f"<{rows * columns}f", raw[start:])
    return [list(values[j * columns:(j + 1) * columns]) for j in range(rows)]


def record(folder, *arguments):
    """The recorder's output and the ground that it has."""
    done = run(RECORDER, *arguments, "--backend", "cpu", "--no-frames", "--seconds", "0", "--dump", "H@0", "--out", folder / "out")
    return done, read_npy(folder / "out/H_0.npy") if done.returncode == 0 else None


def problem(done, ground, wanted):
    if "refused" in wanted:
        missing = [word for word in wanted["refused"] if word not in done.stderr]
        return "" if done.returncode == 2 and not missing else f"not refused with {missing}: {done.stderr}"
    if done.returncode != 0:
        return f"refused: {done.stderr}"
    missing = [word for word in wanted["says"] if word not in done.stderr]
    if missing:
        return f"says nothing of {missing}: {done.stderr}"
    heights = wanted["heights"]
    if heights is not None:
        if (len(ground), len(ground[0])) != (len(heights), len(heights[0])):
            return f"{len(ground[0])} x {len(ground)} cells"
        off = max(abs(a - b) for row, want in zip(ground, heights) for a, b in zip(row, want))
        if off > wanted.get("tolerance", 1e-3):
            return f"heights are off by {off}"
    least = min(map(min, ground))
    if least < wanted.get("low", -1e9):
        return f"a pit down to {least}"
    wrong = {at: ground[at[1]][at[0]] for at, height in wanted.get("at", {}).items() if abs(ground[at[1]][at[0]] - height) > 0.01}
    return f"other heights: {wrong}" if wrong else ""


def main():
    failures = []

    def tell(name, text):
        if text:
            failures.append(name)
            print(f"{name}: {text.strip()}")

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, (content, wanted) in TABLE.items():
            (folder / file).write_bytes(content)
            done, ground = record(folder, "--terrain", folder / file)
            tell(file, problem(done, ground, wanted))
            if "origin" in wanted:
                made = run(IMPORT, folder / file, "--out", folder / "level")
                tell(file, "" if tuple(json.loads((folder / "level/level.json").read_text())["origin"]) == wanted["origin"] else made.stdout)
        for file, (content, options, wanted) in IMPORTS.items():
            (folder / file).write_bytes(content)
            done, ground = run(IMPORT, folder / file, "--out", folder / file.replace(".", "_"), *options), None
            if done.returncode == 0:
                done, ground = record(folder, folder / file.replace(".", "_") / "level.json")
            tell("import of " + file, problem(done, ground, wanted))
        # An imported grid is the level that --terrain makes, to the bit, and lies where it lay.
        at = [re.search(r"hash +(\w+)", run(RECORDER, *level, "--backend", "cpu", "--no-frames", "--seconds", "1", "--out", folder / "out").stdout)[1]
              for level in (["--terrain", folder / "nodata.asc"], [folder / "holes_outside_asc/level.json"])]
        tell("import", "" if at[0] == at[1] else f"another world than --terrain's: {at}")
        # Dumps lie on the map; what is read back is what was written. Gauges take its coordinates.
        run(IMPORT, folder / "plain.asc", "--out", folder / "plain")
        for kind in ("asc", "tif"):
            if kind == "tif" and "--tiff" not in sys.argv:
                continue
            run(RECORDER, folder / "plain/level.json", "--backend", "cpu", "--no-frames", "--seconds", "0", "--dump", "H@0", "--dump-as", kind,
                "--out", folder / "dumps")
            made = run(IMPORT, folder / f"dumps/H_0.{kind}", "--out", folder / f"again_{kind}")
            level = json.loads((folder / f"again_{kind}/level.json").read_text())
            tell("dump as " + kind, "" if level["origin"] == [600000.5, 5200000] and level["grid"]["dx"] == 2 else made.stdout + made.stderr)
            tell("dump as " + kind, problem(*record(folder, folder / f"again_{kind}/level.json"), loads()))
        gauges = ["--gauge", "600011.5,5200009", "--map-coordinates"]
        done = run(RECORDER, folder / "plain/level.json", "--backend", "cpu", "--no-frames", "--seconds", "0", *gauges, "--out", folder / "out")
        row = (folder / "out/gauges.csv").read_text().splitlines()[1].split(",")
        tell("gauge", "" if [float(row[n]) for n in (2, 3, 6)] == [600011.5, 5200009, SOUTH_UP[4][5]] else str(row))
        done = run(RECORDER, folder / "plain/level.json", "--backend", "cpu", "--no-frames", "--seconds", "0", *gauges[:2], "--out", folder / "out")
        tell("gauge", "" if done.returncode == 2 and "on its map it lies inside: --map-coordinates" in done.stderr else done.stderr)
        # The picture ahead of everything: holes are red there alone.
        done = run(IMPORT, folder / "holes_outside.asc", "--out", folder / "seen", "--preview")
        shown = (folder / "seen/preview.png").read_bytes()
        tell("preview", "" if shown[:4] == b"\x89PNG" and "holes in red" in done.stdout else done.stdout + done.stderr)
    print(f"{len(TABLE) + len(IMPORTS)} maps, {len(failures)} wrong")
    sys.exit(1 if failures else 0)


main()
