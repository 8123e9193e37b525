#!/usr/bin/env python3
"""Writes from the headers what bindings and hosts without a linker want: wadi_api.json (types, fields, enums, functions, texts) and wadi_loader.h
(the library opened at run time; without the calls of wadi_vulkan.h, which not every build has).
Usage: write_api.py [--check]; --check changes nothing and exits with 1 where a file is old."""
import json
import pathlib
import re
import sys

folder = pathlib.Path(__file__).resolve().parent
HEADERS = ["wadi.h", *sorted(p.name for p in folder.glob("include/wadi/*.h") if p.name not in ("wadi.h", "wadi_loader.h"))]
LOADED = ("wadi.h", "wadi_cuda.h")  # whose calls every build has
# What the types of vulkan_core.h are on 64-bit systems, for bindings that know no Vulkan.
FOREIGN = {
    **dict.fromkeys(("VkInstance", "VkPhysicalDevice", "VkDevice", "VkQueue", "VkCommandBuffer", "PFN_vkGetInstanceProcAddr"), "void*"),
    **dict.fromkeys(("VkSemaphore", "VkImage"), "uint64_t"), **dict.fromkeys(("VkFormat", "VkImageLayout"), "int32_t"), "VkBool32": "uint32_t"}


def plain(comment):
    """A comment's words without its marks."""
    return " ".join(re.sub(r"(?m)^\s*\*(?!/) ?|/\*+|\*/", " ", comment or "").split())


def arguments(text):
    found = []
    for part in text.split(","):
        part = " ".join(part.split())
        if part in ("", "void"):
            continue
        kind, name, array = re.fullmatch(r"(.*?[ *])(\w+)((?:\[\d+\])?)", part).groups()
        found.append({"name": name, "type": kind.strip() + ("*" if array else "")} | ({"count": int(array[1:-1])} if array else {}))
    return found


def fields(body):
    found = []
    for line in re.finditer(r"([^;]+);[ \t]*(/\*.*?\*/)?", body, re.DOTALL):
        declared = " ".join(re.sub(r"/\*.*?\*/", " ", line[1], flags=re.DOTALL).split())
        kind, names = re.fullmatch(r"((?:const )?(?:struct )?\w+\**) (.*)", declared).groups()
        for name in names.split(","):
            name, array = re.fullmatch(r"(\w+)((?:\[\d+\])?)", name.strip()).groups()
            found.append({"name": name, "type": kind, "text": plain(line[2])} | ({"count": int(array[1:-1])} if array else {}))
    return found


def enumerators(body):
    """(name, number, comment behind it) of each value of an enum."""
    return re.findall(r"(WADI_\w+) = (-?\d+),?[ \t]*(/\*.*?\*/)?", body, re.DOTALL)


def read(header):
    """What a header declares."""
    api = {"abi_version": int(re.search(r"#define WADI_ABI_VERSION (\d+)u", header)[1])}
    api["version"] = [int(re.search(rf"#define WADI_VERSION_{part} (\d+)u", header)[1]) for part in ("MAJOR", "MINOR", "PATCH")]
    api["constants"] = {name: int(value, 0) for name, value in re.findall(r"^#define (WADI_(?!VERSION|ABI)\w+) (0x[0-9A-Fa-f]+|\d+)u?$", header, re.MULTILINE)}
    comment = r"(/\*\*(?:(?!\*/).)*\*/\n)?"
    api["typedefs"] = {name: kind for kind, name in re.findall(r"^typedef (u?int32_t) (wadi_\w+);", header, re.MULTILINE)}
    api["enums"] = [
        {"name": name, "text": plain(text), "values": {key: int(value) for key, value, _ in enumerators(body)}, "texts": {key: plain(note) for key, _, note in enumerators(body) if note}}
        for text, body, name in re.findall(comment + r"typedef enum \w+(?: WADI_ENUM)? \{(.*?)\} (\w+);", header, re.DOTALL)
    ]
    defaults = {
        name: {field: value.strip('"') if value.startswith(('"', "VK_")) else float(value.split()[-1].rstrip("f")) for field, value in re.findall(r"value\.([\w\[\]]+) = ([^;]+);", body)}
        for name, body in re.findall(r"^static inline (\w+) wadi_default_\w+\(void\) \{(.*?)^\}", header, re.MULTILINE | re.DOTALL)
    }
    api["structs"] = [
        {"name": name, "text": plain(text), "grows": "struct_size;" in body, "fields": fields(body)}
        | ({"defaults": defaults[name]} if name in defaults else {})
        for text, body, name in re.findall(comment + r"typedef struct \w+ \{(.*?)\n\} (\w+);", header, re.DOTALL)
    ]
    api["callbacks"] = [
        {"name": name, "returns": returns, "arguments": arguments(given), "text": plain(text)}
        for text, returns, name, given in re.findall(comment + r"typedef (\w+\**) \(\*(\w+)\)\(([^)]*)\);", header, re.DOTALL)
    ]
    api["functions"] = [
        {"name": name, "returns": returns.strip(), "arguments": arguments(given), "text": plain(text)}
        for text, returns, name, given in re.findall(comment + r"WADI_API ([^(;]*?[ *])(wadi_\w+)\(([^)]*)\);", header, re.DOTALL)
    ]
    return api


def loader(api):
    """A table of all functions, filled from an opened library."""
    lines = []
    for function in (f for f in api["functions"] if f.get("header", "wadi.h") in LOADED):
        given = ", ".join(a["type"].removesuffix("*") + f" {a['name']}[{a['count']}]" if "count" in a else f"{a['type']} {a['name']}" for a in function["arguments"])
        lines.append(f"    X({function['returns']}, {function['name'].removeprefix('wadi_')}, ({given or 'void'}))")
    return f'''/* Written by plugin/write_api.py from wadi.h and wadi_cuda.h. For hosts that open the library at run time and run on without it; C99.
 *
 * Define WADI_LOADER_IMPLEMENTATION in one file ahead of including this. The functions are members of a table:
 *   wadi_functions wadi;
 *   const char* missing = wadi_load_functions(&wadi, find, user);   NULL: all are there, and the library's ABI is the header's
 *   wadi.create_world_from_level(...)
 * `find` gives the address of a name: dlsym, GetProcAddress, or the engine's own. wadi.h gives types and initialisers. */
#ifndef WADI_LOADER_H
#define WADI_LOADER_H

#include <wadi/wadi_cuda.h>

#define WADI_FUNCTIONS(X) \\
{(" " + chr(92) + chr(10)).join(lines)}

typedef struct wadi_functions {{
#define WADI_MEMBER(RETURNS, NAME, ARGUMENTS) RETURNS (*NAME) ARGUMENTS;
    WADI_FUNCTIONS(WADI_MEMBER)
#undef WADI_MEMBER
}} wadi_functions;

/** The address of a function of the library, or NULL. */
typedef void (*(*wadi_find_function)(void* user, const char* name))(void);

#ifdef __cplusplus
extern "C" {{
#endif
/** Fills the table. NULL, or the name of the first function that the library lacks: it is older than this header; or
 *  "wadi_get_abi_version" where its ABI version is another, and it must not be used. */
const char* wadi_load_functions(wadi_functions* functions, wadi_find_function find, void* user);
#ifdef __cplusplus
}}
#endif

#ifdef WADI_LOADER_IMPLEMENTATION
const char* wadi_load_functions(wadi_functions* functions, wadi_find_function find, void* user) {{
#define WADI_FIND(RETURNS, NAME, ARGUMENTS) \\
    functions->NAME = (RETURNS (*) ARGUMENTS)find(user, "wadi_" #NAME); \\
    if (!functions->NAME) return "wadi_" #NAME;
    WADI_FUNCTIONS(WADI_FIND)
#undef WADI_FIND
    return functions->get_abi_version() == WADI_ABI_VERSION ? (const char*)0 : "wadi_get_abi_version";
}}
#endif
#endif
'''


def read_all(texts):
    """What all headers declare; what is not of wadi.h names its header, and `foreign` the types that are none of ours."""
    api = read("".join(texts.values()))
    kinds = set()
    for entry in (*api["functions"], *api["structs"]):
        header = next(name for name, text in texts.items() if re.search(rf"^WADI_API[^;(]*\b{entry['name']}\(|^}} {entry['name']};", text, re.MULTILINE))
        if header != "wadi.h":
            entry["header"] = header
        kinds |= {value["type"].removeprefix("const ").rstrip("*") for value in (*entry.get("arguments", ()), *entry.get("fields", ()))}
    api["foreign"] = {kind: FOREIGN[kind] for kind in sorted(kinds) if kind.startswith(("Vk", "PFN_vk"))}
    return api


def main():
    texts = {name: (folder / f"include/wadi/{name}").read_text(encoding="utf-8") for name in HEADERS}
    header = "".join(texts.values())
    api = read_all(texts)
    declared = set(re.findall(r"^WADI_API[^;(]*?(wadi_\w+)\(", header, re.MULTILINE))
    if declared != {f["name"] for f in api["functions"]}:
        sys.exit(f"functions that were not read: {declared ^ {f['name'] for f in api['functions']}}")
    counted = (header.count("typedef struct"), header.count("typedef enum"), len(re.findall(r"^typedef [^;(]*\(\*", header, re.MULTILINE)))
    if counted != tuple(len(api[part]) for part in ("structs", "enums", "callbacks")):
        sys.exit("a struct, an enum or a callback was not read")
    flags = [f"{s['name']}.{f['name']}" for s in api["structs"] for f in s["fields"] if f["type"] in ("int32_t", "uint32_t") and re.search(r"(?<![-\d])1 = ", f["text"])]
    flags += [f"{c['name']}({a['name']})" for c in api["functions"] + api["callbacks"] for a in c["arguments"] if a["type"] == "int" or ["on", "int32_t"] == [a["name"], a["type"]]]
    if flags:
        sys.exit(f"numbers that stand for a choice, without its type: {flags}")
    old = []
    for path, text in ((folder / "wadi_api.json", json.dumps(api, indent=1) + "\n"), (folder / "include/wadi/wadi_loader.h", loader(api))):
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        old.append(path.name)
        if "--check" not in sys.argv:
            path.write_text(text, encoding="utf-8")
    counts = ", ".join(f"{len(api[part])} {part}" for part in ("functions", "structs", "enums", "callbacks", "constants"))
    print(counts + (f"; {'old' if '--check' in sys.argv else 'written'}: {', '.join(old)}" if old else ""))
    sys.exit(1 if old and "--check" in sys.argv else 0)


if __name__ == "__main__":
    main()
