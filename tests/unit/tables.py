#!/usr/bin/env python3
"""Compares the tables in pages and the schema of levels with what the build prints.

Usage: tables.py RECORDER SOURCE_DIR [--update]     --update rewrites them. Exit status 1 names every difference.

In a page a table stands between `<!-- table: NAME -->` and `<!-- end -->`; NAME is one of --print-tables, "settings OBJECT" for the
rows of one object of level files ("root": those beside them), or "effects content" without the choices of method.
"""
import json
import pathlib
import re
import subprocess
import sys

PLACES = {
    "engine/step/STEP.md": ["fields"],
    "engine/settings/README.md": ["effects"],
    "shaders/stages/README.md": ["stages"],
    "samples/levels/README.md": ["settings root", "settings material", "settings method", "settings surface", "effects content"],
}
SCHEMA = "samples/levels/level.schema.json"
WIDEST_SCHEMA_LINE = 190
MARKED = re.compile(r"(<!-- table: ([a-z ]+) -->\n)(.*?)(<!-- end -->)", re.S)


def of_object(row, wanted):
    path = row.split("`")[1]
    named = path.split(".")[0] if path.startswith(("material.", "method.", "surface.")) else "root"
    return named == wanted


def table(name, printed):
    """The text of a marked table."""
    kind, _, part = name.partition(" ")
    lines = printed[kind].splitlines()
    if part == "content":
        lines = lines[: lines.index("")]
    elif part:
        lines = lines[:2] + [row for row in lines[2:] if of_object(row, part)]
    return "\n".join(["```text", *lines, "```"] if kind == "stages" else lines) + "\n"


def compare(path, text, printed):
    """What is wrong with the marked tables of one page."""
    found = {name: body for _, name, body, _ in MARKED.findall(text)}
    for name in PLACES[path]:
        if name not in found:
            yield f"{path}: no table \"{name}\" between markers"
        elif found[name] != table(name, printed):
            ours, theirs = found[name].splitlines(), table(name, printed).splitlines()
            row = next((b for a, b in zip(ours, theirs) if a != b), "another number of rows")
            yield f"{path}: table \"{name}\" is not what the build prints: {row}"


def schema_rows(text):
    """The properties by object; numbers of a list, "name[0]" and on, as one property."""
    rows = json.loads(text)
    for properties in rows.values():
        for key in [k for k in properties if k.endswith("[0]")]:
            parts = [properties.pop(f"{key[:-3]}[{n}]") for n in range(sum(k.startswith(key[:-2]) for k in properties))]
            items = {k: parts[0][k] for k in ("type", "minimum", "maximum")}
            properties[key[:-3]] = {"type": "array", "items": items, "minItems": len(parts), "maxItems": len(parts),
                                    "description": "; ".join(p["description"] for p in parts), "default": [p["default"] for p in parts]}
    return rows


def with_rows(schema, rows):
    """The schema with the properties that the library knows; keys that it has besides stay."""
    for name, properties in rows.items():
        holder = schema["properties"] if name == "" else schema["properties"][name]["properties"]
        holder.update(properties)
    return schema


def compare_schema(schema, rows):
    for name, properties in rows.items():
        holder = schema["properties"] if name == "" else schema["properties"][name]["properties"]
        where = f"{SCHEMA}: {name + '.' if name else ''}"
        for key, value in properties.items():
            if holder.get(key) != value:
                yield f"{where}{key} is {json.dumps(holder.get(key))}, not {json.dumps(value)}"
        if name:  # beside the objects stand keys that are no settings
            yield from (f"{where}{key} is no setting" for key in set(holder) - set(properties) - ({"name"} if name == "method" else set()))


def layout(value, indent=0, before=0):
    """JSON with what fits on a line in one line."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or not value or indent + before + len(line) <= WIDEST_SCHEMA_LINE:
        return line
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        rows = [f"{json.dumps(k)}: {layout(v, indent + 2, len(k) + 4)}" for k, v in value.items()]
        return "{\n" + ",\n".join(pad + row for row in rows) + "\n" + " " * indent + "}"
    return "[\n" + ",\n".join(pad + layout(v, indent + 2) for v in value) + "\n" + " " * indent + "]"


def problems(printed, texts, schema):
    for path in PLACES:
        yield from compare(path, texts[path], printed)
    yield from compare_schema(schema, schema_rows(printed["schema"]))


def main():
    recorder, root = sys.argv[1], pathlib.Path(sys.argv[2])
    printed = {}
    for kind in ("settings", "fields", "effects", "stages", "schema"):
        run = subprocess.run([recorder, "--print-tables", kind], capture_output=True, text=True)
        if run.returncode != 0:
            print(run.stderr.strip())
            return 1
        printed[kind] = run.stdout
    if "--update" in sys.argv:
        for path in PLACES:
            text = (root / path).read_text()
            (root / path).write_text(MARKED.sub(lambda m: m[1] + table(m[2], printed) + m[4], text))
        schema = with_rows(json.loads((root / SCHEMA).read_text()), schema_rows(printed["schema"]))
        (root / SCHEMA).write_text(layout(schema) + "\n")
    texts = {path: (root / path).read_text() for path in PLACES}
    schema = json.loads((root / SCHEMA).read_text())
    # Negative controls: what is planted must be seen.
    planted = {path: text.replace("`material.friction`", "`material.frict`").replace("compute_bed_load", "compute_bed") for path, text in texts.items()}
    seen = "\n".join(problems(printed, planted, {"properties": {n: {"properties": {"no": 1}} for n in ("grid", "material", "method", "surface", "effects")}}))
    for sign in ('table "settings material"', 'table "stages"', "grid.nx is null", "method.no is no setting"):
        if sign not in seen:
            print(f"the checker does not see a planted fault: {sign}")
            return 1
    found = list(problems(printed, texts, schema))
    for problem in found:
        print(problem)
    if found:
        print(f"to rewrite the tables: {sys.argv[0]} RECORDER SOURCE_DIR --update")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
