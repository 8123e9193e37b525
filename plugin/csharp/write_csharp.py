#!/usr/bin/env python3
"""Writes from plugin/wadi_api.json the part of the C# binding that repeats wadi.h: Wadi/Enums.cs, Structs.cs and Native.cs.
Usage: write_csharp.py [--check] [--api FILE] [--to FOLDER]; --check changes nothing and exits with 1 where a file is old."""
import argparse
import json
import os
import pathlib
import re
import sys
import textwrap

here = pathlib.Path(__file__).resolve().parent
NUMBERS = {"uint32_t": "uint", "int32_t": "int", "uint64_t": "ulong", "int64_t": "long", "float": "float", "double": "double",
           "size_t": "UIntPtr", "char": "byte", "void": "void", "wadi_bool": "int"}
KEYWORDS = {"in", "out", "ref", "object", "string", "params", "fixed", "lock", "base", "event", "is", "as"}
AXES = "XYZW"


def pascal(name):
    """WADI's names as C# writes them; words with digits and pairs of axes stay upper case."""
    words = [w.upper() if re.search(r"\d[A-Za-z]|^[RX]\d|^[XYxy]{1,2}$", w) else w[:1].upper() + w[1:].lower() for w in name.split("_") if w]
    return "".join(words)


def camel(name):
    text = pascal(name)
    text = text[:1].lower() + text[1:]
    return "@" + text if text in KEYWORDS else text


def comment(text, indent=""):
    """A text of the header as an XML comment."""
    if not text:
        return ""
    text = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    lines = textwrap.wrap(text, 130 - len(indent), break_long_words=False, break_on_hyphens=False)
    if len(lines) == 1 and len(indent) + len(lines[0]) < 110:
        return f"{indent}/// <summary>{lines[0]}</summary>\n"
    return f"{indent}/// <summary>\n" + "".join(f"{indent}/// {line}\n" for line in lines) + f"{indent}/// </summary>\n"


class Binding:
    def __init__(self, api):
        # The calls of wadi_vulkan.h take handles that native code makes: they have no binding.
        self.api = api = api | {part: [entry for entry in api[part] if entry.get("header") != "wadi_vulkan.h"] for part in ("functions", "structs")}
        self.callbacks = {c["name"] for c in api["callbacks"]}
        self.enums = {e["name"] for e in api["enums"]}
        self.structs = {s["name"] for s in api["structs"]}
        self.raw = {s["name"] for s in api["structs"] if any(self.is_pointer(f["type"]) for f in s["fields"])}

    def is_pointer(self, kind):
        return kind.endswith("*") or kind in self.callbacks

    def type_name(self, name):
        """Structs that hold pointers are Raw...: the classes without it are written by hand."""
        return ("Raw" if name in self.raw else "") + pascal(name.removeprefix("wadi_"))

    def type(self, kind):
        kind = kind.removeprefix("const ").strip()
        stars = len(kind) - len(kind.rstrip("*"))
        base = kind.rstrip("*").strip()
        if base in NUMBERS:
            return NUMBERS[base] + "*" * stars
        if base in self.enums | self.structs | self.callbacks | set(self.api["typedefs"]):
            return self.type_name(base) + "*" * stars
        sys.exit(f"write_csharp.py: no C# type for {kind}")

    def argument(self, given, inside_callback):
        kind = self.type(given["type"])
        if given["type"] in self.callbacks and inside_callback:
            kind = "IntPtr"
        return f"{kind} {camel(given['name'])}"

    # Enums.cs

    def enum(self, enum):
        prefix = os.path.commonprefix(list(enum["values"]))
        prefix = prefix[:prefix.rfind("_") + 1]
        last = pascal(prefix.split("_")[-2])
        text = comment(enum["text"], "    ") + f"    public enum {self.type_name(enum['name'])}\n    {{\n"
        for name, value in enum["values"].items():
            short = pascal(name[len(prefix):])
            text += comment(enum["texts"].get(name, ""), "        ") + f"        {last if short[0].isdigit() else ''}{short} = {value},\n"
        return text + "    }\n"

    def mask(self):
        """The bits of wadi_output_mask: one per output, and that of the tiles."""
        outputs = next(e for e in self.api["enums"] if e["name"] == "wadi_output")
        text = "    /// <summary>Outputs, one bit each.</summary>\n    [Flags]\n    public enum OutputMask : uint\n    {\n        None = 0,\n"
        for name, value in outputs["values"].items():
            if name != "WADI_OUTPUT_COUNT":
                text += f"        {pascal(name.removeprefix('WADI_OUTPUT_'))} = 1u << {value},\n"
        text += "        /// <summary>For World.SetOutputs: lowest and highest elevation of tiles and their changes.</summary>\n"
        return text + f"        Tiles = 0x{self.api['constants']['WADI_OUTPUT_TILES_BIT']:x}u,\n    }}\n"

    def enums_file(self):
        major, minor, patch = self.api["version"]
        text = "    /// <summary>What this binding was written from.</summary>\n    public static class Header\n    {\n"
        text += "        /// <summary>The library that is loaded must have this one.</summary>\n"
        text += f"        public const uint AbiVersion = {self.api['abi_version']};\n"
        text += "        /// <summary>As wadi_get_version gives it: at least this has all that this binding names.</summary>\n"
        text += f"        public const uint Version = ({major}u << 22) | ({minor}u << 12) | {patch}u;\n    }}\n"
        return "using System;\n", [text, *[self.enum(e) for e in self.api["enums"]], self.mask()]

    # Structs.cs

    def field(self, field):
        """Declarations of one field. Texts and flags are properties over what the library sees; short arrays of floats are fields x, y, z, w."""
        kind, name = field["type"], pascal(field["name"])
        note, pad = comment(field["text"], "        "), "        "
        own = camel(field["name"])
        if field["name"] == "struct_size":
            return pad + "uint structSize;\n"
        if kind == "char" and "count" in field:
            count = field["count"]
            return f"{pad}unsafe fixed byte {own}[{count}];\n{note}{pad}public unsafe string {name} {{ get {{ fixed (byte* text = {own}) return Text.Of(text, {count}); }} }}\n"
        if kind == "wadi_bool":
            return f"{pad}int {own};\n{note}{pad}public bool {name} {{ get {{ return {own} != 0; }} set {{ {own} = value ? 1 : 0; }} }}\n"
        if "count" in field:
            if kind not in ("float", "double") or field["count"] > len(AXES):
                sys.exit(f"write_csharp.py: no way to write {field['name']}[{field['count']}] of {kind}")
            return note + pad + f"public {kind} " + ", ".join(name + AXES[n] for n in range(field["count"])) + ";\n"
        return f"{note}{pad}public {'IntPtr' if self.is_pointer(kind) else self.type(kind)} {name};\n"

    def default(self, struct):
        name = self.type_name(struct["name"])
        text = f"        /// <summary>A struct with the size that the library asks for and the header's defaults{'; texts stay null' if struct['name'] in self.raw else ''}.</summary>\n"
        text += f"        public static unsafe {name} Default\n        {{\n            get\n            {{\n                var value = new {name}();\n"
        text += f"                value.structSize = (uint)sizeof({name});\n"
        kinds = {f["name"]: f["type"] for f in struct["fields"]}
        for field, value in struct["defaults"].items():
            base, _, index = field.partition("[")
            if isinstance(value, str):
                continue
            member = pascal(base) + (AXES[int(index[:-1])] if index else "")
            text += f"                value.{member} = {value:g}{'f' if kinds[base] == 'float' else ''};\n"
        return text + "                return value;\n            }\n        }\n"

    def struct(self, struct):
        text = comment(struct["text"], "    ")
        text += f"    [StructLayout(LayoutKind.Sequential)]\n    public struct {self.type_name(struct['name'])}\n    {{\n"
        text += "".join(self.field(f) for f in struct["fields"])
        return text + (self.default(struct) if struct["grows"] else "") + "    }\n"

    def structs_file(self):
        return "using System;\nusing System.Runtime.InteropServices;\n#pragma warning disable 169, 649 // fields that only the library fills\n", [self.struct(s) for s in self.api["structs"]]

    # Native.cs

    def native_file(self):
        parts = []
        for call in self.api["callbacks"]:
            given = ", ".join(self.argument(a, True) for a in call["arguments"])
            parts.append(comment(call["text"], "    ") + "    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]\n"
                         f"    public unsafe delegate {self.type(call['returns'])} {self.type_name(call['name'])}({given});\n")
        text = "    /// <summary>The calls of wadi.h under their own names. World and Library are what programs use.</summary>\n    public static unsafe class Native\n    {\n"
        text += "        /// <summary>libwadi.so on Linux, libwadi.dll on Windows.</summary>\n        public const string Library = \"libwadi\";\n"
        for call in self.api["functions"]:
            given = ", ".join(self.argument(a, False) for a in call["arguments"])
            text += "\n" + comment(call["text"], "        ") + "        [DllImport(Library, CallingConvention = CallingConvention.Cdecl, ExactSpelling = true)]\n"
            text += "\n".join(textwrap.wrap(f"public static extern {self.type(call['returns'])} {call['name']}({given});", 138, initial_indent=" " * 8,
                                            subsequent_indent=" " * 12, break_long_words=False)) + "\n"
        return "using System;\nusing System.Runtime.InteropServices;\n", parts + [text + "    }\n"]


def files(api):
    binding = Binding(api)
    for name, (head, parts) in (("Enums.cs", binding.enums_file()), ("Structs.cs", binding.structs_file()), ("Native.cs", binding.native_file())):
        yield name, f"// Written by plugin/csharp/write_csharp.py from plugin/wadi_api.json.\n{head}\nnamespace Wadi\n{{\n" + "\n".join(parts) + "}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--api", type=pathlib.Path, default=here.parent / "wadi_api.json")
    parser.add_argument("--to", type=pathlib.Path, default=here / "Wadi")
    options = parser.parse_args()
    old = []
    for name, text in files(json.loads(options.api.read_text(encoding="utf-8"))):
        path = options.to / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        old.append(name)
        if not options.check:
            path.write_text(text, encoding="utf-8")
    print(f"{'old' if options.check else 'written'}: {', '.join(old)}" if old else "nothing is old")
    sys.exit(1 if old and options.check else 0)


if __name__ == "__main__":
    main()
