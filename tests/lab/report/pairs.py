"""Frames of the recorder as small PNG files beside each other; and how much of two differs. No packages."""
import math
import struct
import sys
import zlib

import recordings

sys.path.insert(0, str(recordings.ROOT / "tests" / "viewer"))
import pictures  # noqa: E402  reads PNG files

CAPTION = 38  # rows above the map in a frame
WIDTH, GAP = 400, 8  # pixels
LEVELS = 32  # grey levels kept per colour: what the eye hardly sees costs half the file


def map_of(frame, nx, ny):
    """The map of a recorder's frame, averaged over blocks down to WIDTH or less: (width, height, rows of RGB bytes)."""
    width, _, rows = pictures.read_png(frame)
    zoom = width // nx
    block = math.ceil(width / WIDTH)
    rows = rows[CAPTION:CAPTION + ny * zoom]
    small, columns = [], width // block
    for top in range(0, len(rows) - block + 1, block):
        line = bytearray(3 * columns)
        for channel in range(3):
            parts = (rows[y][3 * x + channel:3 * block * columns:3 * block] for y in range(top, top + block) for x in range(block))
            line[channel::3] = bytes(total // (block * block) for total in map(sum, zip(*parts)))
        small.append(bytes(line))
    return len(small[0]) // 3, len(small), small


def differing(one, other, least=24):
    """Share of the pixels of two maps that differ by `least` of 255 or more in a colour [%]."""
    count = sum(1 for a, b in zip(one[2], other[2]) for x in range(one[0]) if max(abs(a[3 * x + c] - b[3 * x + c]) for c in range(3)) >= least)
    return 100 * count / (one[0] * one[1])


def write(path, *parts):
    """Parts from left to right, as high as each other."""
    width, step, before = sum(part[0] for part in parts) + GAP * (len(parts) - 1), 256 // LEVELS, None
    packed = bytearray()
    for row in zip(*(part[2] for part in parts)):
        line = (b"\xff" * (3 * GAP)).join(bytes(value // step * step + step // 2 for value in pixels) for pixels in row)
        above = before or bytes(len(line))
        packed += b"\x02" + bytes((value - up) & 255 for value, up in zip(line, above))  # filter: up
        before = line

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, parts[0][1], 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(bytes(packed), 9))
                     + chunk(b"IEND", b""))
