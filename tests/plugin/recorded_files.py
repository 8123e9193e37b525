"""Reads what wadi-recorder writes: PNG, NPY, CSV, and the boxes of an MP4."""

import csv
import struct
import zlib


def png_size(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    assert data[-8:-4] == b"IEND", f"{path} is cut off"
    return struct.unpack(">II", data[16:24])


def png_pixels(path):
    """Rows of (r, g, b), by the PNG specification and zlib; every checksum must fit."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        name, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert zlib.crc32(name + body) == struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0], f"{path}: {name}"
        packed += body if name == b"IDAT" else b""
        at += 12 + length
    width, height = png_size(path)
    assert data[24:29] == b"\x08\x02\x00\x00\x00", f"{path}: not 8-bit RGB"
    lines = zlib.decompress(packed)
    assert len(lines) == height * (1 + 3 * width), path
    rows, above = [], bytes(3 * width)
    for y in range(height):
        line = lines[y * (1 + 3 * width) : (y + 1) * (1 + 3 * width)]
        assert line[0] in (0, 2), f"{path}: filter {line[0]} in row {y}"
        above = bytes((a + b) & 255 for a, b in zip(line[1:], above)) if line[0] == 2 else line[1:]
        rows.append([tuple(above[k : k + 3]) for k in range(0, 3 * width, 3)])
    return rows


def read_npy(path):
    data = path.read_bytes()
    assert data[:8] == b"\x93NUMPY\x01\x00", path
    length = struct.unpack("<H", data[8:10])[0]
    assert (10 + length) % 64 == 0 and data[9 + length] == ord("\n"), path
    header = eval(data[10 : 10 + length], {"__builtins__": {}})  # a Python literal by the format's definition
    assert header["descr"] == "<f4" and header["fortran_order"] is False, header
    ny, nx = header["shape"]
    assert len(data) == 10 + length + 4 * nx * ny, path
    return nx, ny, struct.unpack(f"<{nx * ny}f", data[10 + length :])


def read_table(path):
    with path.open(encoding="utf-8", newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def boxes(data, start=0, end=None):
    """The boxes of an MP4, or of a box's contents: kind, first byte and last byte + 1 of what is inside."""
    end = len(data) if end is None else end
    while start < end:
        size, kind = struct.unpack(">I4s", data[start : start + 8])
        assert size >= 8 and start + size <= end, (kind, size)
        yield kind, start + 8, start + size
        start += size


def inside(data, *path):
    start, end = 0, len(data)
    for kind in path:
        start, end = next((s, e) for k, s, e in boxes(data, start, end) if k == kind)
    return data[start:end]
