#!/usr/bin/env python3
"""wadi-import on TIFFs written here, and the recorder on what it makes of them. Usage: import_tiff.py WADI_IMPORT WADI_RECORDER"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

IMPORT, RECORDER = sys.argv[1:3]
SHORT, LONG, DOUBLE, ASCII = 3, 4, 12, 2
NX, NY = 20, 12
HEIGHTS = [[100.0 + 0.5 * i + 2.0 * j for i in range(NX)] for j in range(NY)]  # rows from the north


def tiff(code, rows, tags=(), tile=None, packed=False, format=3):
    """A little-endian TIFF of one sample; `code`: of struct for it. `tile`: its side, else one strip."""
    bits = 8 * struct.calcsize(code)
    nx, ny = len(rows[0]), len(rows)
    if tile:
        blocks = [[[rows[min(y + j, ny - 1)][min(x + i, nx - 1)] for i in range(tile)] for j in range(tile)]
                  for y in range(0, ny, tile) for x in range(0, nx, tile)]
    else:
        blocks = [rows]
    blocks = [b"".join(struct.pack("<%d%s" % (len(row), code), *row) for row in block) for block in blocks]
    if packed:
        blocks = [zlib.compress(block) for block in blocks]
    fields = [(256, LONG, [nx]), (257, LONG, [ny]), (258, SHORT, [bits]), (259, SHORT, [8 if packed else 1]), (262, SHORT, [1]),
              (277, SHORT, [1]), (339, SHORT, [format])] + list(tags)
    starts, at = [], 8
    for block in blocks:
        starts.append(at)
        at += len(block) + len(block) % 2
    sizes = [len(block) for block in blocks]
    fields += [(322, LONG, [tile]), (323, LONG, [tile]), (324, LONG, starts), (325, LONG, sizes)] if tile else \
        [(273, LONG, starts), (278, LONG, [ny]), (279, LONG, sizes)]
    fields.sort()
    data = b"".join(block + b"\0" * (len(block) % 2) for block in blocks)
    entries, extra = b"", b""
    extra_at = at + 2 + 12 * len(fields) + 4
    for tag, kind, values in fields:
        raw = values if kind == ASCII else struct.pack("<%d%s" % (len(values), {SHORT: "H", LONG: "I", DOUBLE: "d"}[kind]), *values)
        entries += struct.pack("<HHI", tag, kind, len(values))
        if len(raw) <= 4:
            entries += raw.ljust(4, b"\0")
        else:
            entries += struct.pack("<I", extra_at + len(extra))
            extra += raw + b"\0" * (len(raw) % 2)
    return b"II*\0" + struct.pack("<I", at) + data + struct.pack("<H", len(fields)) + entries + b"\0\0\0\0" + extra


def run(folder, name, content, wanted=0):
    path = folder / (name + ".tif")
    path.write_bytes(content)
    made = subprocess.run([IMPORT, path, "--out", folder / name], capture_output=True, text=True)
    assert made.returncode == wanted, (name, made)
    return made


def heights_of(folder, name):
    """The ground that the recorder has, rows from the south, and what it warned of."""
    out = folder / (name + "_out")
    ran = subprocess.run([RECORDER, folder / name / "level.json", "--backend", "cpu", "--no-frames", "--seconds", "0.1", "--dump", "H@0",
                          "--out", out], capture_output=True, text=True)
    assert ran.returncode == 0, (name, ran.stderr)
    raw = (out / "H_0.npy").read_bytes()
    start = 10 + struct.unpack_from("<H", raw, 8)[0]
    values = struct.unpack("<%df" % ((len(raw) - start) // 4), raw[start:])
    return values, ran.stderr


def main():
    scale = (33550, DOUBLE, [2.5, 2.5, 0])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        flat = [h for row in reversed(HEIGHTS) for h in row]
        for case, more in {"strip": {}, "tiles": {"tile": 16}, "packed": {"packed": True, "tile": 16}, "double": {"code": "d"}}.items():
            said = run(folder, case, tiff(more.pop("code", "f"), HEIGHTS, [scale], **more))
            assert "20 x 12 cells of 2.5 m, heights 100 ... 131.5 m" in said.stdout and "NODATA" not in said.stderr, said
            values, _ = heights_of(folder, case)
            assert max(abs(a - b) for a, b in zip(values, flat)) < 1e-3, case
        rows = [[int(h) - 200 for h in row] for row in HEIGHTS]
        rows[3][4] = -9999
        said = run(folder, "signed", tiff("h", rows, [scale, (42113, ASCII, b"-9999\0")], format=2))
        assert "1 of 240 cells hold NODATA_value" in said.stderr, said
        values, warned = heights_of(folder, "signed")
        assert min(values) > -110 and max(values) < 0 and "1 of 240 cells hold NODATA_value" in warned, (min(values), warned)
        degrees = [(33550, DOUBLE, [1 / 3600, 1 / 3600, 0]), (33922, DOUBLE, [0, 0, 0, 7, 46.5, 0]),
                   (34735, SHORT, [1, 1, 0, 1, 1024, 0, 1, 2])]
        said = run(folder, "degrees", tiff("f", HEIGHTS, degrees))
        assert "degrees are taken as metres at latitude 46.49" in said.stderr and "20 x 17 cells of 21.2" in said.stdout, said
        values, warned = heights_of(folder, "degrees")
        assert len(values) == 20 * 17 and "resampled to 17" in warned, (len(values), warned)
        # Damaged and foreign files are refused in words.
        good = tiff("f", HEIGHTS, [scale], packed=True)
        refused = 0
        for cut in range(8, len(good), 7):
            (folder / "cut.tif").write_bytes(good[:cut])
            refused += subprocess.run([IMPORT, folder / "cut.tif", "--out", folder / "cut"], capture_output=True).returncode == 2
        assert refused > 10, refused
        said = run(folder, "foreign", b"P5 2 2 255 abcd", wanted=2)
        assert "cannot be read as a TIFF" in said.stderr, said
    print("strips, tiles, packed data, doubles, holes, degrees, damage: right")


main()
