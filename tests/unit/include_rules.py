#!/usr/bin/env python3
"""Who may include whom. Usage: include_rules.py SOURCE_DIR. Exit status 1 names every breach."""
import pathlib
import re
import sys

# folder -> prefixes that its files may include; the longest matching folder decides. "<...>" headers are checked by LIBRARIES.
RULES = {
    "shaders": ["../physics/", "effects.h", "step_params.h", "stage_", "division_", "half_"],
    "shaders/tools": ["engine/compute/stage_table.hpp", "engine/effects.hpp"],
    "engine": ["engine/", "shaders/step_params.h", "shaders/effects.h"],
    "backends/cpu": ["backends/cpu/", "engine/compute/"],
    "backends/vulkan": ["backends/vulkan/", "engine/compute/", "volk.h", "self_test.inc", "division_", "half_"],
    "backends/cuda": ["backends/cuda/", "engine/compute/", "shaders/", "stage_cuda.h"],
    "backends": ["backends/", "engine/compute/"],
    "plugin": ["plugin/", "engine/", "wadi/"],
    "samples/recorder": ["wadi/", "samples/recorder/", ""],
    "samples/viewer": ["wadi/", "../recorder/levels.hpp", "shaders/", "viewer_shaders/"],
    "samples": ["wadi/"],
}
# Libraries only some folders may use.
LIBRARIES = {
    "nlohmann/": ["engine/level", "samples", "tests"],
    "stb/": ["engine/image", "samples", "tests"],
    "vulkan/": ["backends/vulkan", "plugin/include", "samples", "tests"],
    "volk.h": ["backends/vulkan"],
    "cuda": ["backends/cuda"],
    "CLI/": ["samples", "tests"],
    "doctest/": ["tests"],
}
SOURCES = {".c", ".h", ".cpp", ".hpp", ".cu", ".cuh", ".stage", ".glsl", ".comp", ".inl", ".in"}
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]')


def breaches(root, path):
    relative = path.relative_to(root).as_posix()
    folder = max((f for f in RULES if relative.startswith(f + "/")), key=len, default=None)
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        kind, name = found.groups()
        where = f"{relative}:{number}: includes {name}"
        if name.startswith("backends/") and not relative.startswith(("backends/", "tests/")):
            yield f"{where}: only backends may name a backend"
        for library, users in LIBRARIES.items():
            if name.startswith(library) and not relative.startswith(tuple(u + "/" for u in users)):
                yield f"{where}: only {', '.join(users)} may use it"
        if kind == '"' and folder is not None and relative.startswith(tuple(RULES)):
            local = (path.parent / name).is_file() and "/" not in name and (relative.startswith("shaders/tools/") or not relative.startswith("shaders/"))
            if not local and not any(name.startswith(p) for p in RULES[folder]):
                yield f"{where}: {folder} may include only {', '.join(RULES[folder])}"


def check(root):
    files = [p for top in ("engine", "backends", "shaders", "plugin", "samples", "tests") for p in sorted((root / top).rglob("*")) if p.suffix in SOURCES]
    return files, [b for p in files for b in breaches(root, p)]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    files, found = check(root)
    # Negative control: the checker must see a planted breach.
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        planted = pathlib.Path(folder)
        (planted / "engine").mkdir()
        (planted / "engine" / "bad.cpp").write_text('#include "backends/cpu/cpu_device.hpp"\n#include <vulkan/vulkan.h>\n')
        if len(check(planted)[1]) < 3:
            print("the checker does not see a planted breach")
            return 1
    for breach in found:
        print(breach)
    print(f"{len(files)} files, {len(found)} breaches")
    return 1 if found or len(files) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
