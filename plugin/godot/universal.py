#!/usr/bin/env python3
"""Puts Mach-O files of several processors into one, as macOS loads it and as games for all Macs want it.

Usage: universal.py OUTPUT FILE ...; one file alone is copied."""
import pathlib
import struct
import sys

ALIGNMENT = 14  # bits: pages of 16 KiB
MACH_O_64 = 0xFEEDFACF
FAT = 0xCAFEBABE


def universal(files: list[pathlib.Path]) -> bytes:
    slices = []
    for file in files:
        data = file.read_bytes()
        magic, processor, kind = struct.unpack_from("<III", data)
        if magic != MACH_O_64:
            sys.exit(f"universal.py: {file}: begins with {magic:#x}, not as a 64-bit Mach-O file does ({MACH_O_64:#x})")
        if processor in [known for known, _, _ in slices]:
            sys.exit(f"universal.py: {file}: there is a file for processor {processor:#x} already")
        slices.append((processor, kind, data))
    if len(slices) == 1:
        return slices[0][2]
    header, body = struct.pack(">II", FAT, len(slices)), b""
    start = page_up(len(header) + 20 * len(slices))
    for processor, kind, data in slices:
        at = start + len(body)
        header += struct.pack(">IIIII", processor, kind, at, len(data), ALIGNMENT)
        body += data.ljust(page_up(len(data)), b"\0")
    return header.ljust(start, b"\0") + body


def page_up(size: int) -> int:
    return -(-size >> ALIGNMENT) << ALIGNMENT


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[1]).write_bytes(universal([pathlib.Path(word) for word in sys.argv[2:]]))
