#!/usr/bin/env python3
"""Which instruction sets a value of WADI_CPU_SETS names, and that wrong ones end the configure step. Usage: cpu_sets.py CMAKE SOURCE_DIR"""
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = """cmake_minimum_required(VERSION 3.25)
include({source}/shaders/cpu_sets.cmake)
message(STATUS "sets are ${{WADI_INSTRUCTION_SETS}}.")
"""
ALL = "base;avx2;avx512"
X86 = [  # WADI_CPU_SETS, further definitions, what CMake says
    ("all", {}, f"sets are {ALL}."), ("avx2", {}, "sets are avx2."), ("avx512;base", {}, "sets are base;avx512."),
    ("all", {"WADI_CHECK_INDICES": "ON"}, "sets are base."), ("avx2", {"WADI_SANITIZE": "thread"}, "sets are base."),
    ("avx2", {"WADI_CHECK_INDICES": "BASE"}, "sets are base;avx2."), ("avx2", {"WADI_NARROW_MASKS": "largest"}, "sets are base;avx2."),
    ("native", {"CMAKE_CROSSCOMPILING": "ON"}, f"this build is for another one; name all or some of: {ALL}"),
    ("", {}, "is empty"), ("avx", {}, f'names "avx"; it can be all, native, or a list of: {ALL}'), ("all;avx2", {}, 'names "all"'),
]
ARM = [("all", {}, "sets are base."), ("avx2", {}, 'names "avx2"; it can be all, native, or a list of: base')]


def main():
    (cmake, source), bad = sys.argv[1:], 0
    with tempfile.TemporaryDirectory() as folder:
        script = pathlib.Path(folder) / "sets.cmake"
        script.write_text(SCRIPT.format(source=source))
        for processor, cases in (("x86_64", X86), ("aarch64", ARM)):
            for value, further, says in cases:
                given = {"CMAKE_SYSTEM_PROCESSOR": processor, "PROJECT_SOURCE_DIR": source, "WADI_CPU_SETS": value, **further}
                done = subprocess.run([cmake, *(f"-D{name}={word}" for name, word in given.items()), "-P", script], capture_output=True, text=True, check=False)
                said = " ".join((done.stdout + done.stderr).split())
                if says not in said or (done.returncode == 0) != says.startswith("sets are"):
                    bad += 1
                    print(f"FAIL {processor}, WADI_CPU_SETS={value} {further}: {said!r} does not say {says!r}")
    print(f"{len(X86) + len(ARM)} values of WADI_CPU_SETS, {bad} failed")
    return 1 if bad else 0


sys.exit(main())
