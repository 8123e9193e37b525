#!/usr/bin/env python3
"""Writes the small first inputs of the libFuzzer targets into OUT/TARGET/, and OUT/level.dict, the words of level files. Usage: make.py OUT."""
import json
import pathlib
import struct
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[3]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(depth, colour, channels):
    row = b"\0" + bytes(range(4 * channels * depth // 8))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 3, depth, colour, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(row * 3)) + chunk(b"IEND", b"")


def npy(kind, size):
    header = f"{{'descr': '<f{size}', 'fortran_order': False, 'shape': (3, 4), }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<12{kind}", *range(12))


def sealed(name, body=b""):
    return name + struct.pack("<IIQQ", 2, 0, 32 + len(body), 0) + body


def words(schema):
    """Keys, and values that are words."""
    if isinstance(schema, list):
        return set().union(*map(words, schema))
    if not isinstance(schema, dict):
        return set()
    own = set(schema.get("properties", {})) | {w for w in schema.get("enum", []) + [schema.get("const")] if isinstance(w, str)}
    return own.union(*map(words, schema.values()))


def main():
    out = pathlib.Path(sys.argv[1])

    def put(target, name, data):
        folder = out / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)

    put("png", "grey8", png(8, 0, 1))
    put("png", "grey16", png(16, 0, 1))
    put("png", "rgb8", png(8, 2, 3))
    put("npy", "float32", npy("f", 4))
    put("npy", "float64", npy("d", 8))
    put("asc", "grid", b"ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2.5\nNODATA_value -9999\n1 2 3\n4 -9999 6\n")
    put("r16", "square", bytes(range(32)))
    put("snapshot", "header", sealed(b"WADISNAP", bytes(64)))
    put("commands", "header", sealed(b"WADICMDS", bytes(24)))
    put("calls", "mixed", bytes((n * 37 + n // 7) % 256 for n in range(300)))
    for path in sorted((ROOT / "samples" / "levels").glob("*/level.json")):
        put("level", path.parent.name, path.read_bytes())
    schema = json.loads((ROOT / "samples" / "levels" / "level.schema.json").read_text())
    (out / "level.dict").write_text("".join(f'"\\"{word}\\""\n' for word in sorted(words(schema))))
    put("level", "small", json.dumps({"format_version": 1, "name": "a", "grid": {"nx": 4, "ny": 3, "dx": 1}, "dt": 0.01,
                                      "terrain": [{"file": "map.png", "min": 0, "max": 1}]}).encode())


main()
