"""PNG files as rows of bytes, and what tests ask of them. Needs nothing but Python."""
import functools
import struct
import zlib


def read_png(path):
    """8-bit RGB as (width, height, rows of bytes)."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    width, height, depth, colour = struct.unpack(">IIBB", data[16:26])
    assert (depth, colour) == (8, 2), f"{path}: not 8-bit RGB"
    packed, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        how, line = raw[start], raw[start + 1:start + 1 + 3 * width]
        above = line if how == 0 else sum_of_bytes(line, above) if how == 2 else unfiltered(how, line, above)
        rows.append(above)
    return width, height, tuple(rows)


def sum_of_bytes(a, b):
    """Byte by byte modulo 256, as two long numbers: the filter that our programs write, and a picture has a million bytes."""
    x, y, low = int.from_bytes(a, "little"), int.from_bytes(b, "little"), int.from_bytes(b"\x7f" * len(a), "little")
    return (((x & low) + (y & low)) ^ ((x ^ y) & ~low)).to_bytes(len(a), "little")


def unfiltered(how, line, above):
    """A row stored as differences to its left neighbours (1), to the mean of left and upper ones (3), or by Paeth's guess (4)."""
    line = bytearray(line)
    for k, up in enumerate(above):
        left, corner = (line[k - 3], above[k - 3]) if k >= 3 else (0, 0)
        if how == 1:
            guess = left
        elif how == 3:
            guess = (left + up) // 2
        else:
            p = left + up - corner
            a, b, c = abs(p - left), abs(p - up), abs(p - corner)
            guess = left if a <= b and a <= c else up if b <= c else corner
        line[k] = (line[k] + guess) & 255
    return bytes(line)


def pixels(picture):
    width, _, rows = picture
    for row in rows:
        for x in range(width):
            yield row[3 * x], row[3 * x + 1], row[3 * x + 2]


def share(picture, test):
    """Share of the pixels for which test(r, g, b) holds."""
    width, height, _ = picture
    return sum(1 for pixel in pixels(picture) if test(*pixel)) / (width * height)


def blue(r, g, b):
    """Deep water."""
    return b > r + 35 and g > r


def sandy(r, g, b):
    return r > b + 45 and r >= g > b


def black_pixels(picture):
    """NaN and missing results are stored as black; nothing in a lit scene is."""
    return sum(1 for pixel in pixels(picture) if max(pixel) == 0)


@functools.cache # each stored picture is compared with many
def blocks(picture, size=6):
    """Mean colours of size x size pixels: what the eye compares at a distance."""
    width, height, rows = picture
    means = []
    for y in range(0, height - size + 1, size):
        for x in range(0, width - size + 1, size):
            sums = [0, 0, 0]
            for row in rows[y:y + size]:
                for k in range(3):
                    sums[k] += sum(row[3 * x + k:3 * (x + size):3])
            means.append(tuple(s / (size * size) for s in sums))
    return means


def difference(a, b):
    """Of two pictures of one size: (mean, 98th percentile) of the blocks' largest channel differences, in steps of 255."""
    assert a[:2] == b[:2], f"sizes {a[:2]} and {b[:2]}"
    differences = sorted(max(abs(p - q) for p, q in zip(m, n)) for m, n in zip(blocks(a), blocks(b)))
    return sum(differences) / len(differences), differences[int(0.98 * len(differences))]


def alike(a, b):
    mean, most = difference(a, b)
    return mean < 3 and most < 24
