#!/usr/bin/env python3
"""Reads a library for macOS, and a program linked to it, as macOS would before it runs them. Usage: mach_o.py LIBRARY PROGRAM [SYSTEM].
Exit status 1 says what is wrong. SYSTEM is the newest system that the library may ask for (13.0). Needs PyPI's macholib."""
import sys

from macholib.mach_o import LC_BUILD_VERSION, LC_CODE_SIGNATURE, LC_ID_DYLIB, LC_LOAD_DYLIB
from macholib.MachO import MachO

CPU_TYPE_ARM64 = 0x0100000C


def commands(path, kind):
    (header,) = MachO(path).headers
    return [(command, data) for load, command, data in header.commands if load.cmd == kind]


def names(path, kind):
    return [data.rstrip(b"\0").decode() for _, data in commands(path, kind)]


def version(number):
    return number >> 16, number >> 8 & 255


def main():
    library, program = sys.argv[1:3]
    newest = tuple(int(part) for part in (sys.argv[3] if len(sys.argv) > 3 else "13.0").split("."))
    wrong = []
    if not (names(library, LC_ID_DYLIB) or [""])[0].startswith("@rpath/libwadi."):
        wrong.append(f"its name is {names(library, LC_ID_DYLIB)}, not @rpath/libwadi...")
    foreign = [name for name in names(library, LC_LOAD_DYLIB) if not name.startswith(("/usr/lib/", "/System/"))]
    if foreign:
        wrong.append(f"it needs {foreign}")
    if not set(names(library, LC_ID_DYLIB)) <= set(names(program, LC_LOAD_DYLIB)):
        wrong.append(f"the program was linked to {names(program, LC_LOAD_DYLIB)}")
    if MachO(library).headers[0].header.cputype == CPU_TYPE_ARM64 and not commands(library, LC_CODE_SIGNATURE):
        wrong.append("it is not signed, and Apple's own processors run nothing without a signature")
    asked = [version(command.minos) for command, _ in commands(library, LC_BUILD_VERSION)]
    if not asked or max(asked) > newest:
        wrong.append(f"it asks for macOS {asked}, newer than {newest}")
    if wrong:
        sys.exit("\n".join(f"mach_o.py: {library}: {text}" for text in wrong))
    print(f"{library}: for macOS {'.'.join(map(str, max(asked)))} and later, needs {', '.join(names(library, LC_LOAD_DYLIB))}")


if __name__ == "__main__":
    main()
