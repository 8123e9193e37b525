#!/usr/bin/env python3
"""Who may include whom. Usage: include_rules.py SOURCE_DIR. Exit status 1 names every breach."""
import pathlib
import re
import sys

# folder -> prefixes that its files may include; the longest matching folder decides. "<...>" headers are checked by LIBRARIES.
RULES = {
    "shaders": ["effects.h"],
    "shaders/stages": ["../../physics/"],
    "shaders/physics": ["../physics/"],
    "shaders/language": ["../effects.h", "../step_params.h"],
    "shaders/stagec": ["engine/compute/stage_table.hpp", "shaders/effect_rows.hpp"],
    # The rooms of the engine, floor by floor; the facade in the hall includes all of them.
    "engine": ["engine/"],
    "engine/compute": ["engine/compute/", "shaders/step_params.h", "shaders/effects.h"],
    "engine/threads": ["engine/threads/", "engine/compute/"],
    "engine/settings": ["engine/settings/", "engine/threads/", "engine/compute/", "shaders/effect_rows.hpp"],
    "engine/image": ["engine/image/", "engine/threads/", "engine/compute/"],
    "engine/level": ["engine/level/", "engine/image/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/step": ["engine/step/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/saves": ["engine/saves/", "engine/step/", "engine/settings/", "engine/compute/"],
    "engine/edits": ["engine/edits/", "engine/saves/", "engine/step/", "engine/settings/", "engine/compute/"],
    "engine/frames": ["engine/frames/", "engine/step/", "engine/settings/", "engine/compute/"],
    "engine/reads": ["engine/reads/", "engine/step/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "backends": ["backends/", "engine/compute/"],
    "plugin": ["plugin/", "engine/", "wadi/", "backends/registry.hpp"],
    "plugin/godot": ["engine_methods.h"],
    "samples/common": [],
    "samples/recorder": ["wadi/", "../common/"],
    "samples/tune": ["wadi/", "../common/"],
    "samples/viewer": ["wadi/", "../common/", "../tune/print.hpp", "../tune/write_variant.hpp", "shaders/", "viewer_shaders/"],
    "samples": ["wadi/"],
}
# A folder of backends/ may include itself, what all backends share, the interface, how the stages compiled for the host's processor
# are found and run, and this.
SHARED = ["backends/common/", "engine/compute/", "backends/cpu/stages.hpp", "backends/cpu/active_tiles.hpp"]
BACKENDS = {
    "backends/vulkan": ["volk.h", "self_test.inc", "language/"],
    "backends/cuda": ["shaders/", "language/"],
}
# Libraries only some folders may use.
LIBRARIES = {
    "nlohmann/": ["engine/level", "samples", "tests"],
    "stb/": ["engine/image", "samples/common", "tests"],
    "libdeflate.h": ["samples/common"],
    "vulkan/": ["backends/vulkan", "plugin/include", "plugin/godot", "samples", "tests"],
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
    allowed = RULES.get(folder, [])
    if folder == "backends" and relative.count("/") > 1:
        folder = room(relative)
        allowed = [folder + "/"] + SHARED + BACKENDS.get(folder, [])
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        kind, name = found.groups()
        where = f"{relative}:{number}: includes {name}"
        if name.startswith("backends/") and name != "backends/registry.hpp" and not relative.startswith(("backends/", "tests/")):
            yield f"{where}: only backends may name a backend"
        for library, users in LIBRARIES.items():
            if name.startswith(library) and not relative.startswith(tuple(u + "/" for u in users)):
                yield f"{where}: only {', '.join(users)} may use it"
        if kind == '"' and folder is not None and relative.startswith(tuple(RULES)):
            local = (path.parent / name).is_file() and "/" not in name and not relative.startswith("shaders/stages/")
            if not local and not any(name.startswith(p) for p in allowed):
                yield f"{where}: {folder} may include only {', '.join(allowed)}"


def arrows(root, files):
    """(including file, included file) of the project's own files."""
    for path in files:
        for line in path.read_text(encoding="utf-8").splitlines():
            found = INCLUDE.match(line)
            if not found or found.group(1) != '"':
                continue
            for target in (path.parent / found.group(2), root / found.group(2), root / "shaders" / found.group(2)):
                if target.is_file():
                    yield path.relative_to(root).as_posix(), target.resolve().relative_to(root.resolve()).as_posix()
                    break


def circle(edges):
    """A circle of arrows as a list of names, or nothing."""
    graph = {}
    for a, b in edges:
        if a != b:
            graph.setdefault(a, set()).add(b)
    done, way = set(), []

    def visit(name):
        if name in way:
            return way[way.index(name):] + [name]
        if name in done:
            return None
        way.append(name)
        for following in sorted(graph.get(name, ())):
            found = visit(following)
            if found:
                return found
        way.pop()
        done.add(name)
        return None

    for name in sorted(graph):
        found = visit(name)
        if found:
            return found
    return None


def room(name):
    """The folder of a file; a folder of stages or of one backend is a room like one of the engine."""
    return name.rsplit("/", 1)[0]


def check(root):
    files = [p for top in ("engine", "backends", "shaders", "plugin", "samples", "tests") for p in sorted((root / top).rglob("*")) if p.suffix in SOURCES]
    found = [b for p in files for b in breaches(root, p)]
    edges = list(arrows(root, files))
    product = [(a, b) for a, b in edges if a.startswith(("engine/", "backends/", "plugin/"))]
    for what, around in (("files", circle(edges)), ("rooms", circle((room(a), room(b)) for a, b in product))):
        if around:
            found.append(f"a circle of {what}: " + " > ".join(around))
    return files, found


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    files, found = check(root)
    # Negative controls: planted breaches must be seen.
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        planted = pathlib.Path(folder).resolve()
        for name, text in {
            "engine/bad.cpp": '#include "backends/cpu/device.hpp"\n#include <vulkan/vulkan.h>\n',
            "backends/one/bad.cpp": '#include "backends/other/device.hpp"\n',
            "engine/settings/upward.hpp": '#include "engine/step/below.hpp"\n',
            "engine/step/below.hpp": '#include "engine/settings/upward.hpp"\n',
        }.items():
            (planted / name).parent.mkdir(parents=True, exist_ok=True)
            (planted / name).write_text(text)
        seen = "\n".join(check(planted)[1])
        for sign in ("only backends may name a backend", "only backends/vulkan", "engine/settings may include only", "backends/one may include only", "circle of files", "circle of rooms"):
            if sign not in seen:
                print(f"the checker does not see a planted breach: {sign}")
                return 1
    for breach in found:
        print(breach)
    print(f"{len(files)} files, {len(found)} breaches")
    return 1 if found or len(files) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
