#!/usr/bin/env python3
"""Writes engine_methods.h: the engine's methods that the C sources use, with the hashes by which the engine knows them; and class_docs.c:
the texts of the class documentation.

Usage: generate.py EXTENSION_API_JSON SOURCE_FOLDER DOC_FOLDER OUTPUT_FOLDER
The sources name a method ENGINE_Class_method or, of a built-in type, BUILTIN_Type_method; a name that the engine lacks is an error.
"""
import json
import pathlib
import re
import sys


# The oldest engine that is to run the add-on, 4.4, has another hash of these, which later ones know beside their own; all other methods in use
# have one hash since then (the engine's misc/extension_api_validation lists the changes).
OLDEST = {("RenderingDevice", "texture_create_from_extension"): 1397171480}


def snake(name: str) -> str:
    """PackedFloat32Array -> PACKED_FLOAT32_ARRAY, as in GDExtensionVariantType."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).upper()


def used(sources: list[pathlib.Path], prefix: str) -> list[tuple[str, str]]:
    names = set()
    for source in sources:
        names.update(re.findall(rf"\b{prefix}_([A-Z][A-Za-z0-9]*)_([a-z_0-9]+)\b", source.read_text()))
    return sorted(names)


def hash_of(owners: dict, owner: str, method: str) -> int:
    for entry in owners.get(owner, {}).get("methods", []):
        if entry["name"] == method:
            known = [entry["hash"], *entry.get("hash_compatibility", [])]
            wanted = OLDEST.get((owner, method), entry["hash"])
            if wanted not in known:
                sys.exit(f"generate.py: {owner}.{method} has the hashes {known} in this engine, and not {wanted}")
            return wanted
    sys.exit(f"generate.py: this engine has no {owner}.{method}")


def table(macro: str, enum: str, prefix: str, names: list, owners: dict) -> list[str]:
    lines = [f"typedef enum {enum} {{"]
    lines += [f"    {prefix}_{owner}_{method}," for owner, method in names]
    lines += [f"    {prefix}_METHOD_COUNT", f"}} {enum};", f"#define {macro} \\"]
    lines += [f'    {{"{owner}", "{method}", INT64_C({hash_of(owners, owner, method)})}}, \\' for owner, method in names]
    return lines + [""]


def class_docs(folder: pathlib.Path) -> str:
    """The XML files as bytes: a text of C may not be that long."""
    lines = ["/* Written by generate.py from doc_classes. */", '#include "engine/class_docs.h"', ""]
    names = []
    for path in sorted(folder.glob("*.xml")):
        names.append(path.stem)
        data = path.read_bytes()
        lines.append(f"static const char {path.stem}[] = {{")
        lines += ["    " + ", ".join(str(byte) for byte in data[at : at + 32]) + "," for at in range(0, len(data), 32)]
        lines.append("};")
    lines += ["const ClassDoc class_docs[] = {", *[f"    {{{name}, sizeof {name}}}," for name in names], "    {0},", "};", ""]
    return "\n".join(lines)


def main() -> None:
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    api = json.loads(pathlib.Path(sys.argv[1]).read_text())
    folder, docs, output = (pathlib.Path(word) for word in sys.argv[2:])
    sources = sorted([*folder.rglob("*.c"), *folder.rglob("*.h")])
    classes = {entry["name"]: entry for entry in api["classes"]}
    types = {entry["name"]: entry for entry in api["builtin_classes"]}
    builtin = used(sources, "BUILTIN")
    lines = ["/* Written by generate.py from the engine's extension_api.json. */", "#include <stdint.h>", ""]
    lines += table("ENGINE_METHODS", "EngineMethod", "ENGINE", used(sources, "ENGINE"), classes)
    lines += table("BUILTIN_METHODS", "BuiltinMethod", "BUILTIN", builtin, types)
    lines += ["#define BUILTIN_TYPES \\", *[f"    GDEXTENSION_VARIANT_TYPE_{snake(owner)}, \\" for owner, _ in builtin], "", ""]
    (output / "engine_methods.h").write_text("\n".join(lines))
    (output / "class_docs.c").write_text(class_docs(docs))


if __name__ == "__main__":
    main()
