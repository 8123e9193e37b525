#!/usr/bin/env python3
"""Hosts compiled with an older and a newer header run on this library and get the same state; a field that it does not know is refused.

The older header is the first of this ABI version, kept in 1/; the newer one is the present one with a field at the end of every struct that
can grow. Usage: versions.py LIBRARY SOURCE_DIR"""
import pathlib
import re
import subprocess
import sys
import tempfile

library, source = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
here = pathlib.Path(__file__).resolve().parent
header = (source / "plugin/include/wadi/wadi.h").read_text(encoding="utf-8")
grown, structs = re.subn(r"(typedef struct (wadi_\w+) \{\n    uint32_t struct_size;.*?)\n\} \2;", r"\1\n    uint64_t grown;\n} \2;", header, flags=re.DOTALL)
sized = len(re.findall(r"^static inline wadi_\w+ wadi_default_", header, re.MULTILINE))
if structs != sized or structs == 0:
    sys.exit(f"{structs} structs were grown, {sized} have an initialiser")


def run(folder, name, *options):
    program = folder / "host"
    subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *options, "-I", folder, here / "host.c", "-o", program, library,
                    f"-Wl,-rpath,{library.parent}"], check=True)
    done = subprocess.run([program], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"a host with the {name} header: {done.stderr.strip()} (exit status {done.returncode})")
    return done.stdout.strip()


with tempfile.TemporaryDirectory() as work:
    said = {}
    for name, text in (("present", header), ("first", (here / "1/wadi/wadi.h").read_text(encoding="utf-8")), ("future", grown)):
        folder = pathlib.Path(work) / name
        (folder / "wadi").mkdir(parents=True)
        (folder / "wadi/wadi.h").write_text(text, encoding="utf-8")
        said[name] = run(folder, name)
    refused = run(pathlib.Path(work) / "future", "future", "-DSET_UNKNOWN")
if len(set(said.values())) != 1 or refused != "refused":
    sys.exit(f"hashes by header: {said}; a field that is not known: {refused}")
print(f"{structs} structs; hosts with the first, present and a future header: hash {said['present']}; a field that is not known is refused")
