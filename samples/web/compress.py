#!/usr/bin/env python3
"""Compresses each file of a folder beside itself, by gzip and brotli, and says what a visitor fetches. Usage: compress.py FOLDER"""
import gzip
import pathlib
import subprocess
import sys

ENDINGS = (".gz", ".br")


def packed(path):
    """The sizes of a file: as it is, by gzip, by brotli. Compresses it unless that is done and newer than it."""
    sizes = [path.stat().st_size]
    for ending in ENDINGS:
        to = path.with_name(path.name + ending)
        if not to.exists() or to.stat().st_mtime < path.stat().st_mtime:
            if ending == ".gz":
                to.write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
            else:
                subprocess.run(["brotli", "-f", "-q", "11", "-w", "24", "-o", to, path], check=True)
        sizes.append(to.stat().st_size)
    return sizes


def part_of(path):
    """What a file is for: a visitor fetches one program and one level at a time."""
    return path.parts[0] if path.parts[0] in ("single", "threads") else "levels" if path.parts[0] == "levels" else "page"


def main():
    folder = pathlib.Path(sys.argv[1])
    sums = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix not in ENDINGS:
            part = part_of(path.relative_to(folder))
            sums[part] = [a + b for a, b in zip(sums.get(part, [0, 0, 0]), packed(path))]
    sums["all"] = [sum(column) for column in zip(*sums.values())]
    print(f"{'kB':10}{'plain':>8}{'gzip':>8}{'brotli':>8}")
    for part, sizes in sums.items():
        print(f"{part:10}" + "".join(f"{size / 1000:8.0f}" for size in sizes))


if __name__ == "__main__":
    main()
