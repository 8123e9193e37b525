#!/usr/bin/env python3
"""Hosts compiled with an older and a newer header run on this library and get the same state; a field that it does not know is refused.
What the older header lays out lies where it did: names may change, places, sizes and numbers may not.

The older header is the first of this ABI version, kept in 1/; the newer one is the present one with a field at the end of every struct that
can grow. Usage: versions.py LIBRARY SOURCE_DIR"""
import pathlib
import re
import subprocess
import sys
import tempfile

library, source = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(source / "plugin"))
import write_api
here = pathlib.Path(__file__).resolve().parent
header = (source / "plugin/include/wadi/wadi.h").read_text(encoding="utf-8")
grown, structs = re.subn(r"(typedef struct (wadi_\w+) \{\n    uint32_t struct_size;.*?)\n\} \2;", r"\1\n    uint64_t grown;\n} \2;", header, flags=re.DOTALL)
sized = len(re.findall(r"^static inline wadi_\w+ wadi_default_", header, re.MULTILINE))
if structs != sized or structs == 0:
    sys.exit(f"{structs} structs were grown, {sized} have an initialiser")


# What the first header calls otherwise.
NEW_NAMES = {"WADI_FIELD_SAND_HEIGHT": "WADI_FIELD_SAND_DEPTH", "WADI_FIELD_WATER_HEIGHT": "WADI_FIELD_TOTAL_WATER_DEPTH",
             "wadi_world_stats.largest_sand": "wadi_world_stats.largest_sand_depth",
             "wadi_world_stats.largest_water": "wadi_world_stats.largest_total_water_depth",
             "wadi_world_stats.smallest_height": "wadi_world_stats.smallest_depth"}


def present_name(name):
    return NEW_NAMES.get(name, name)


def layout(folder, api):
    """Offset and size of every field and size of every argument."""
    wanted = [(present_name(f"{struct['name']}.{field['name']}"), f"offsetof({struct['name']}, {field['name']})", f"sizeof((({struct['name']}*)0)->{field['name']})")
              for struct in api["structs"] for field in struct["fields"]]
    wanted += [(struct["name"], "0", f"sizeof({struct['name']})") for struct in api["structs"] if not struct["grows"]]
    for call in api["functions"] + api["callbacks"]:
        types = [call["returns"]] + [a["type"] for a in call["arguments"]]
        wanted += [(f"{call['name']} {n}", str(len(types)), "0" if kind == "void" else f"sizeof({kind})") for n, kind in enumerate(types)]
    lines = "".join(f'    printf("{label}:%u %u\\n", (unsigned)({at}), (unsigned)({size}));\n' for label, at, size in wanted)
    (folder / "layout.c").write_text(f"#include <stdio.h>\n#include <wadi/wadi.h>\nint main(void) {{\n{lines}    return 0;\n}}\n", encoding="utf-8")
    subprocess.run(["cc", "-std=c99", "-I", folder, folder / "layout.c", "-o", folder / "layout"], check=True)
    return dict(line.split(":") for line in subprocess.run([folder / "layout"], check=True, capture_output=True, text=True).stdout.splitlines())


def numbers(api):
    return api["constants"] | {name: value for enum in api["enums"] for name, value in enum["values"].items()}


def moved(folders, first, present):
    """What a host that was compiled with the first header would find elsewhere."""
    old, new = layout(folders["first"], first), layout(folders["present"], present)
    found = [f"{label}: {place}, now {new.get(label)}" for label, place in old.items() if new.get(label) != place]
    known = numbers(present)
    return found + [f"{name}: {value}, now {known.get(present_name(name))}" for name, value in numbers(first).items()
                    if known.get(present_name(name)) != value and not name.endswith("_COUNT")]


def run(folder, name, *options):
    program = folder / "host"
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *options, "-I", folder, here / "host.c", "-o", program, library,
                    f"-Wl,-rpath,{library.parent}"], check=True)
    done = subprocess.run([program], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"a host with the {name} header: {done.stderr.strip()} (exit status {done.returncode})")
    return done.stdout.strip()


with tempfile.TemporaryDirectory() as work:
    said, folders = {}, {}
    for name, text in (("present", header), ("first", (here / "1/wadi/wadi.h").read_text(encoding="utf-8")), ("future", grown)):
        folder = pathlib.Path(work) / name
        (folder / "wadi").mkdir(parents=True)
        (folder / "wadi/wadi.h").write_text(text, encoding="utf-8")
        said[name], folders[name] = run(folder, name), folder
    apis = {name: write_api.read((folder / "wadi/wadi.h").read_text(encoding="utf-8")) for name, folder in folders.items()}
    if found := moved(folders, apis["first"], apis["present"]):
        sys.exit("hosts with the first header find elsewhere: " + "; ".join(found))
    # Negative control: a field in the middle and a new number are found.
    text = (folders["present"] / "wadi/wadi.h").read_text(encoding="utf-8")
    spoilt = text.replace("    double time; ", "    double time, before; ").replace("WADI_LAYER_SAND = 1", "WADI_LAYER_SAND = 7")
    (folders["future"] / "wadi/wadi.h").write_text(spoilt, encoding="utf-8")
    found = moved({"first": folders["first"], "present": folders["future"]}, apis["first"], write_api.read(spoilt))
    if not any(f.startswith("wadi_world_stats.steps:") for f in found) or not any(f.startswith("WADI_LAYER_SAND:") for f in found):
        sys.exit(f"a header that lays out otherwise is not found: {found}")
    (folders["future"] / "wadi/wadi.h").write_text(grown, encoding="utf-8")
    refused = run(pathlib.Path(work) / "future", "future", "-DSET_UNKNOWN")
if len(set(said.values())) != 1 or refused != "refused":
    sys.exit(f"hashes by header: {said}; a field that is not known: {refused}")
print(f"{structs} structs; hosts with the first, present and a future header: hash {said['present']}, the same layout; a field that is not known is refused")
