"""Writes a height map as a PNG with 16 bits of grey (Python, standard library only); the map makers of the levels share it."""
import struct
import zlib


def write_png(path, nx, ny, white, height):
    """height(column, row) in metres, row 0 in the south; black is 0 m, white `white` m. Row 0 of a PNG is the north side."""
    raw = bytearray()
    for row in range(ny):
        raw.append(0)  # PNG filter: none
        for column in range(nx):
            raw += struct.pack(">H", round(height(column, ny - 1 - row) / white * 65535))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", nx, ny, 16, 0, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b""))
