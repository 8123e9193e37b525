#!/usr/bin/env python3
"""Who may use whom: includes of C, C++ and GLSL, imports of Python, calls of the Godot extension's C. Usage: include_rules.py SOURCE_DIR.
Exit status 1 names every breach."""
import pathlib
import re
import sys
import tempfile

# folder -> prefixes that its files may include; the longest matching folder decides. "<...>" headers are checked by LIBRARIES.
RULES = {
    "shaders": ["effects.h", "shaders/"],
    "shaders/stages": ["../../physics/"],
    "shaders/physics": ["../physics/"],
    "shaders/language": ["../effects.h", "../step_params.h"],
    "shaders/stagec": ["shaders/stage_table.hpp", "shaders/effect_rows.hpp"],
    # The rooms of the engine, floor by floor; the facade in the hall includes all of them.
    "engine": ["engine/"],
    "engine/compute": ["engine/compute/"],
    "engine/threads": ["engine/threads/", "engine/compute/"],
    "engine/settings/data": ["engine/settings/data/", "engine/compute/"],
    "engine/settings/rules": ["engine/settings/", "engine/threads/", "engine/compute/", "shaders/effect_rows.hpp"],
    "engine/image": ["engine/image/", "engine/settings/rules/messages.hpp", "engine/threads/", "engine/compute/"],
    "engine/level": ["engine/level/", "engine/image/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/step/plan": ["engine/step/plan/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/step/run": ["engine/step/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/saves": ["engine/saves/", "engine/step/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "engine/edits": ["engine/edits/", "engine/saves/", "engine/step/", "engine/settings/", "engine/compute/"],
    "engine/frames": ["engine/frames/", "engine/step/", "engine/settings/", "engine/compute/"],
    "engine/reads": ["engine/reads/", "engine/step/", "engine/settings/", "engine/threads/", "engine/compute/"],
    "backends": ["backends/", "engine/compute/"],
    "plugin": ["wadi/"],
    "plugin/src": ["plugin/src/", "plugin/include/", "engine/", "backends/registry.hpp"],
    "plugin/godot/source": ["engine/", "scene/"],
    "plugin/godot/source/engine": ["engine_methods.h"],
    "plugin/godot/source/scene": ["engine/"],
    "samples/common": [],
    "samples/recorder": ["wadi/", "../common/"],
    "samples/import": ["wadi/", "../common/"],
    "samples/tune": ["wadi/", "../common/"],
    "samples/mesh_host": ["wadi/", "../common/"],
    "samples/viewer": ["wadi/", "../common/", "../tune/print.hpp", "../tune/write_variant.hpp", "shaders/", "viewer_shaders/"],
    "samples": ["wadi/"],
}
# What shaders/ says to the host; engine and backends are built on it.
FOR_THE_HOST = ["shaders/params.hpp", "shaders/stage_table.hpp", "shaders/physics/limit_marks.glsl"]
# What a folder of samples/ or tests/ may use of the others; nobody else uses either. Samples never use tests.
FOR_ALL_TESTS = ("tests/support", "tests/reference")
LAB = "tests/lab"  # uses all, and is used by nothing
USES = {
    "samples/recorder": ("samples/common",),
    "samples/import": ("samples/common",),
    "samples/tune": ("samples/common",),
    "samples/mesh_host": ("samples/common",),
    "samples/viewer": ("samples/common", "samples/tune"),
    "tests/faults": ("tests/unit",),
    "tests/web": ("samples/web",),
    "tests/fuzz": ("tests/conformance",),
    "tests/latency": ("samples/vulkan_host_minimal",),
    "tests/mesh_host": ("tests/viewer",),
    "tests/plugin": ("samples/vulkan_host_minimal", "tests/unit"),
    "tests/recorder": ("samples/common",),
    "tests/stability": ("tests/fuzz", "tests/unit"),
    "tests/tune": ("samples/tune",),
    "tests/unit": ("tests/fuzz",),
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
    "tiffio.h": ["samples/import"],
    "vulkan/": ["backends/vulkan", "plugin/include", "plugin/godot", "samples", "tests"],
    "volk.h": ["backends/vulkan"],
    "cuda": ["backends/cuda"],
    "CLI/": ["samples", "tests"],
    "doctest/": ["tests"],
}
# What a library that Wadi is built with lacks: LLVM's before version 14 is Emscripten's in Debian 12.
LACKING = re.compile(r"std::bit_cast[<(]")
LIBRARY = ("engine/", "backends/cpu/", "backends/common/", "plugin/src/")
SOURCES = {".c", ".h", ".cpp", ".hpp", ".cu", ".cuh", ".stage", ".glsl", ".comp", ".inl", ".in"}
# Sources in C, whose calls count as arrows; comments and texts in them; what a file defines for others.
C_SOURCES = "plugin/godot/source"
NO_CODE = re.compile(r'/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', re.DOTALL)
DEFINITION = re.compile(r"^(?!static|typedef|extern|else|return)[A-Za-z][\w \t*]*?[\s*](\w+)(?:\([^;{}]*\)\s*\{|(?:\[\w*\])? =)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]')
IMPORT = re.compile(r"^\s*(?:from (\w+) import|import (\w+(?:\s*,\s*\w+)*))", re.M)


def breaches(root, path):
    relative = path.relative_to(root).as_posix()
    folder = max((f for f in RULES if relative.startswith(f + "/")), key=len, default=None)
    allowed = RULES.get(folder, [])
    if folder == "backends" and relative.count("/") > 1:
        folder = room(relative)
        allowed = [folder + "/"] + SHARED + BACKENDS.get(folder, [])
    if relative.startswith(("engine/", "backends/")):
        allowed = allowed + FOR_THE_HOST
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if relative.startswith(LIBRARY) and LACKING.search(line):
            yield f"{relative}:{number}: {LACKING.search(line)[0][:-1]} is not in every C++ library that this is built with"
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
            for target in (path.parent / found.group(2), root / found.group(2), root / "shaders" / found.group(2), root / C_SOURCES / found.group(2)):
                if target.is_file():
                    yield path.relative_to(root).as_posix(), target.resolve().relative_to(root.resolve()).as_posix()
                    break


def calls(root):
    """(calling file, called file) of the sources in C, where one header declares what several files define: a name that one file defines
    for the others, function or constant, and another one mentions."""
    texts = {}
    for path in sorted((root / C_SOURCES).rglob("*.c")):
        texts[path.relative_to(root).as_posix()] = NO_CODE.sub(" ", path.read_text(encoding="utf-8"))
    home = {}
    for file, text in texts.items():
        home.update((name, file) for name in DEFINITION.findall(text))
    for file, text in texts.items():
        for name in set(re.findall(r"\w+", text)):
            if home.get(name, file) != file:
                yield file, home[name]


def imports(root, files):
    """(importing file, imported file) of the project's own Python. Of modules of one name in several folders, that of the file's own folder, then
    those of folders that its lines with sys.path name; all of them where no line does."""
    modules = {}
    for path in files:
        modules.setdefault(path.stem, []).append(path)
    for path in files:
        text = path.read_text(encoding="utf-8")
        named = ["/".join(re.findall(r'"([\w/]+)"', line)) for line in text.splitlines() if "sys.path" in line]
        for found in IMPORT.finditer(text):
            for name in re.split(r"\s*,\s*", found[1] or found[2]):
                there = modules.get(name, [])
                own = [other for other in there if other.parent == path.parent]
                told = [other for other in there if any(folder and other.parent.as_posix().endswith("/" + folder) for folder in named)]
                for other in own or told or there:
                    yield path.relative_to(root).as_posix(), other.relative_to(root).as_posix()


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


def place(name):
    """samples/NAME or tests/NAME, "" of a file elsewhere."""
    return "/".join(name.split("/")[:2]) if name.startswith(("samples/", "tests/")) else ""


def misuses(edges):
    for a, b in edges:
        user, used = place(a), place(b)
        if used in ("", user) or user == LAB:
            continue
        if used == LAB:
            yield f"{a}: uses {b}: nothing uses {LAB}"
        elif used.startswith("tests/") and not user.startswith("tests/"):
            yield f"{a}: uses {b}: only tests may use tests"
        elif user == "":
            yield f"{a}: uses {b}: only samples and tests may use samples"
        elif used not in USES.get(user, ()) and not (user.startswith("tests/") and used in FOR_ALL_TESTS):
            yield f"{a}: uses {b}: {user} may use only {', '.join((*USES.get(user, ()), *(FOR_ALL_TESTS if user.startswith('tests/') else ()))) or 'itself'}"


def check(root):
    there = [p for top in ("engine", "backends", "shaders", "plugin", "samples", "tests") for p in sorted((root / top).rglob("*"))]
    files, scripts = [p for p in there if p.suffix in SOURCES], [p for p in there if p.suffix == ".py"]
    found = [b for p in files for b in breaches(root, p)]
    edges = list(arrows(root, files))
    uses = edges + list(imports(root, scripts))
    found += dict.fromkeys(misuses(uses))
    product = [(a, b) for a, b in edges if a.startswith(("engine/", "backends/", "plugin/", "shaders/"))]
    called = list(calls(root))
    around_tests = circle((place(a), place(b)) for a, b in uses if place(a) and place(b))
    for what, around in (
        ("files", circle(edges)),
        ("scripts", circle(imports(root, scripts))),
        ("rooms", circle((room(a), room(b)) for a, b in product + called)),
        ("calls", circle(called)),
        ("samples and tests", around_tests),
    ):
        if around:
            found.append(f"a circle of {what}: " + " > ".join(around))
    return files + scripts, found


CONTROLS = (  # (planted files, what must be said of them)
    ({
        "engine/bad.cpp": '#include "backends/cpu/device.hpp"\n#include <vulkan/vulkan.h>\n',
        "backends/one/bad.cpp": '#include "backends/other/device.hpp"\n',
        "engine/settings/rules/upward.hpp": '#include "engine/step/below.hpp"\n',
        "engine/step/below.hpp": '#include "engine/settings/rules/upward.hpp"\n',
        "engine/settings/data/upward.hpp": '#include "engine/settings/rules/effects.hpp"\n',
        "engine/step/plan/upward.hpp": '#include "engine/step/run/stepper.hpp"\n',
    }, ("only backends may name a backend", "only backends/vulkan", "engine/settings/rules may include only", "engine/settings/data may include only",
        "engine/step/plan may include only", "backends/one may include only", "circle of files", "circle of rooms")),
    ({
        "plugin/godot/source/engine/low.c": "int low(int n) { return n > 0 ? high(n - 1) : 0; }\n",
        "plugin/godot/source/scene/high.c": "int high(int n) { return n > 0 ? low(n - 1) : 0; }\n",
    }, ("circle of rooms", "circle of calls")),
    ({
        "samples/tune/judge.py": "import sys\nimport measures\n",
        "samples/levels/judge_all.py": "from judge import all\n",
        "engine/settings/write.py": "import judge\n",
        "tests/levels/measures.py": "import judge\n",
        "tests/lab/report/page.py": "import measures\n",
        "tests/unit/pages.py": 'import sys\nsys.path.insert(0, str(ROOT / "lab" / "report"))\nimport page\n',
        "tests/unit/other/page.py": "",
        "tests/golden/bad.cpp": '#include "tests/fuzz/bad.hpp"\n',
        "tests/fuzz/bad.hpp": "",
    }, ("samples/tune/judge.py: uses tests/levels/measures.py: only tests", "samples/levels may use only itself", "engine/settings/write.py: uses samples/tune/judge.py: only",
        "tests/unit/pages.py: uses tests/lab/report/page.py: nothing", "tests/golden may use only tests/support, tests/reference", "circle of scripts",
        "circle of samples and tests")),
)


def unseen():
    """Planted breaches that are not said."""
    for files, signs in CONTROLS:
        with tempfile.TemporaryDirectory() as folder:
            planted = pathlib.Path(folder).resolve()
            for name, text in files.items():
                (planted / name).parent.mkdir(parents=True, exist_ok=True)
                (planted / name).write_text(text)
            seen = "\n".join(check(planted)[1])
        yield from (sign for sign in signs if sign not in seen)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    files, found = check(root)
    for text in unseen():
        print(f"the checker does not see a planted breach: {text}")
        return 1
    for breach in found:
        print(breach)
    print(f"{len(files)} files, {len(found)} breaches")
    return 1 if found or len(files) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
