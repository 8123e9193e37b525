#!/usr/bin/env python3
"""What takes how many bytes in the files of a release. Usage: sizes.py FILE ... (zip or tgz)"""
import collections
import pathlib
import sys
import tarfile
import zipfile

KINDS = ((".so", "library"), (".dll", "library"), (".dylib", "library"), (".so.1", "library"), (".a", "library"), (".exe", "program"), ("/wadi-hello", "program"))


def kind(name):
    found = next((what for suffix, what in KINDS if name.endswith(suffix)), None)
    if found:
        return found
    parts = name.split("/")
    return next((part for part in parts[:-1] if part in ("levels", "include", "demo", "icons", "Shaders", "Samples~", "Runtime")), "rest")


def members(path):
    """(name, bytes, bytes as packed) of each file; a tgz is packed as a whole."""
    if path.suffix == ".zip":
        with zipfile.ZipFile(path) as archive:
            return [(m.filename, m.file_size, m.compress_size) for m in archive.infolist() if not m.is_dir()]
    with tarfile.open(path) as archive:
        return [(m.name, m.size, None) for m in archive if m.isfile()]


def main():
    print(f"{'file':38} {'what':10} {'files':>6} {'bytes':>12} {'packed':>12}")
    for path in map(pathlib.Path, sys.argv[1:]):
        groups = collections.defaultdict(list)
        for name, size, packed in members(path):
            groups[kind(name)].append((size, packed))
        for what, files in sorted(groups.items(), key=lambda item: -sum(size for size, _ in item[1])):
            packed = "" if files[0][1] is None else sum(p for _, p in files)
            print(f"{path.name:38} {what:10} {len(files):6} {sum(size for size, _ in files):12} {packed:>12}")
        print(f"{path.name:38} {'all':10} {sum(map(len, groups.values())):6} {sum(size for files in groups.values() for size, _ in files):12} {path.stat().st_size:12}")


if __name__ == "__main__":
    main()
