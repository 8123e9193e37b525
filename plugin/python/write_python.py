#!/usr/bin/env python3
"""Writes from plugin/wadi_api.json the part of the Python binding that repeats wadi.h and wadi_cuda.h: wadi/_native.py.
Usage: write_python.py [--check] [--api FILE] [--to FILE]; --check changes nothing and exits with 1 where the file is old."""
import argparse
import json
import os
import pathlib
import sys
import textwrap

here = pathlib.Path(__file__).resolve().parent
NUMBERS = {"uint32_t": "c_uint32", "int32_t": "c_int32", "uint64_t": "c_uint64", "int64_t": "c_int64", "float": "c_float", "double": "c_double",
           "size_t": "c_size_t", "wadi_bool": "c_int32", "wadi_output_mask": "c_uint32"}
KEYWORDS = {"from", "in", "is", "as"}

HEAD = '''"""What wadi.h and wadi_cuda.h declare, for ctypes: enums, structs, callbacks and calls. Written by plugin/python/write_python.py from
plugin/wadi_api.json."""
from __future__ import annotations

from ctypes import (CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p)
from enum import IntEnum
from typing import Any

from ._struct import Flag, Member, Row, Struct, Text, Whole
'''


def pascal(name):
    return "".join(word[:1].upper() + word[1:] for word in name.removeprefix("wadi_").split("_"))


def wrapped(text, indent, first=""):
    return textwrap.wrap(text, 138, initial_indent=indent + first, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def docstring(text, indent):
    if not text:
        return ""
    lines = wrapped(text, indent, '"""')
    lines[-1] += '"""'
    return "\n".join(lines) + "\n"


def note(text, indent):
    return "".join(line + "\n" for line in wrapped(text, indent + "#: ", "")) if text else ""


class Binding:
    def __init__(self, api):
        # The calls of wadi_vulkan.h take handles that native code makes: they have no binding.
        self.api = api = api | {part: [entry for entry in api[part] if entry.get("header") != "wadi_vulkan.h"] for part in ("functions", "structs")}
        self.enums = {e["name"] for e in api["enums"]}
        self.structs = {s["name"] for s in api["structs"]}
        self.callbacks = {c["name"] for c in api["callbacks"]}

    def type(self, kind):
        """The type of an argument or a field. Arrays of numbers, bytes and foreign structs are addresses."""
        kind = kind.removeprefix("const ").removeprefix("struct ").strip()
        base, stars = kind.rstrip("*"), len(kind) - len(kind.rstrip("*"))
        if stars == 0:
            if base == "void":
                return "None"
            if base in self.enums:
                return "c_int32"
            if base in self.structs | self.callbacks:
                return pascal(base)
            if base in NUMBERS:
                return NUMBERS[base]
        elif stars == 2:
            return "POINTER(c_void_p)"
        elif base == "char":
            return "c_char_p"
        elif base in self.structs:
            return f"POINTER({pascal(base)})"
        elif base in ("void", "float", "wadi_vulkan_host"):
            return "c_void_p"
        elif base in NUMBERS:
            return f"POINTER({NUMBERS[base]})"
        sys.exit(f"write_python.py: no ctypes type for {kind}")

    def enum(self, enum):
        prefix = os.path.commonprefix(list(enum["values"]))
        prefix = prefix[:prefix.rfind("_") + 1]
        last = prefix.split("_")[-2]
        text = f"class {pascal(enum['name'])}(IntEnum):\n" + docstring(enum["text"] or f"As {enum['name']}.", "    ")
        for name, value in enum["values"].items():
            short = name[len(prefix):]
            text += note(enum["texts"].get(name, ""), "    ") + f"    {last + '_' if short[0].isdigit() else ''}{short} = {value}\n"
        return text

    def field(self, field):
        """(entry of _fields_, what the class shows of it)"""
        kind, name, count = field["type"], field["name"], field.get("count")
        own = name + "_" if name in KEYWORDS else name
        shown = note(field["text"], "    ")
        if kind == "char" or kind == "const char*":
            return f'("_{own}", {f"c_char * {count}" if count else "c_char_p"})', f'{shown}    {own}: Text = Text("_{own}")\n'
        if kind == "wadi_bool":
            return f'("_{own}", c_int32)', f'{shown}    {own}: Flag = Flag("_{own}")\n'
        if kind in self.enums:
            return f'("_{own}", c_int32)', f'{shown}    {own}: Member[{pascal(kind)}] = Member("_{own}", {pascal(kind)})\n'
        if count:
            return f'("_{own}", {self.type(kind)} * {count})', f'{shown}    {own}: Row = Row("_{own}")\n'
        number = self.type(kind)
        if number.startswith(("c_int", "c_uint")) and name != "struct_size":
            return f'("_{own}", {number})', f'{shown}    {own}: Whole = Whole("_{own}", {number})\n'
        hint = {"c_float": "float", "c_double": "float", "c_uint32": "int", "c_void_p": "int | None"}.get(number, "Any")
        return f'("{own}", {number})', f"{shown}    {own}: {hint}\n"

    def struct(self, struct):
        fields = [self.field(f) for f in struct["fields"]]
        text = f"class {pascal(struct['name'])}(Struct):\n" + docstring(struct["text"] or f"As {struct['name']}.", "    ")
        text += "    _fields_ = [" + ",\n                ".join(entry for entry, _ in fields) + "]\n"
        defaults = {}
        for name, value in struct.get("defaults", {}).items():
            base, _, index = name.partition("[")
            field = next(f for f in struct["fields"] if f["name"] == base)
            value = int(value) if NUMBERS.get(field["type"], "c_float") not in ("c_float", "c_double") else value
            if index:
                defaults.setdefault(base, [0] * field["count"])[int(index[:-1])] = value
            else:
                defaults[base] = value
        if defaults:
            entries = ",\n                  ".join(f'"{name}": {json.dumps(value)}' for name, value in defaults.items())
            text += f"    _defaults_ = {{{entries}}}\n"
        return text + "".join(shown for _, shown in fields)

    def callback(self, call):
        given = ", ".join(["c_void_p" if a["type"] in self.callbacks else self.type(a["type"]) for a in call["arguments"]])
        return f"{note(call['text'], '')}{pascal(call['name'])} = CFUNCTYPE({self.type(call['returns'])}, {given})\n"

    def function(self, call):
        given = ", ".join(self.type(a["type"]) for a in call["arguments"])
        return "\n".join(textwrap.wrap(f'"{call["name"]}": ({self.type(call["returns"])}, [{given}]),', 138, initial_indent=" " * 4,
                                       subsequent_indent=" " * 8, break_long_words=False)) + "\n"

    def order(self):
        """Structs behind those that they name, callbacks with the first struct that names them."""
        left, done = list(self.api["structs"]), set()
        while left:
            struct = next(s for s in left if not any(f["type"].removeprefix("const ").rstrip("*") in {o["name"] for o in left} - {s["name"]} for f in s["fields"]))
            left.remove(struct)
            done.add(struct["name"])
            yield struct

    def text(self):
        major, minor, patch = self.api["version"]
        parts = [HEAD, "#: What this file was written from: the library that is loaded must have this number.\n"
                 f"ABI_VERSION: int = {self.api['abi_version']}\n"
                 "#: As wadi_get_version gives it: at least this has all that is named here.\n"
                 f"VERSION: int = {major << 22 | minor << 12 | patch}\n"
                 + "".join(f"{name.removeprefix('WADI_')}: int = {value}\n" for name, value in self.api["constants"].items())]
        parts += [self.enum(e) for e in self.api["enums"]]
        parts += [self.callback(c) for c in self.api["callbacks"]]
        parts += [self.struct(s) for s in self.order()]
        parts.append("#: Each call: what it returns, what it takes.\nCALLS: dict[str, tuple[Any, list[Any]]] = {\n"
                     + "".join(self.function(f) for f in self.api["functions"]) + "}\n")
        return "\n\n".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--api", type=pathlib.Path, default=here.parent / "wadi_api.json")
    parser.add_argument("--to", type=pathlib.Path, default=here / "wadi/_native.py")
    options = parser.parse_args()
    text = Binding(json.loads(options.api.read_text(encoding="utf-8"))).text()
    old = not options.to.exists() or options.to.read_text(encoding="utf-8") != text
    if old and not options.check:
        options.to.write_text(text, encoding="utf-8")
    print(f"{'old' if options.check else 'written'}: {options.to.name}" if old else "nothing is old")
    sys.exit(1 if old and options.check else 0)


if __name__ == "__main__":
    main()
