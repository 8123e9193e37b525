#!/usr/bin/env python3
"""Makes the gallery: a contact sheet of six pictures for every level and variant, preview.png and preview_VARIANT.png beside the level,
and the list of them in samples/levels/README.md.

usage: samples/levels/gallery.py RECORDER [LEVEL ...] [--backend auto]
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import tempfile

LEVELS = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- gallery.py writes from here -->\n", "<!-- to here -->\n"
PICTURES = 6


def read_level(folder):
    """JSON without its // and /* */ comments, which no string of a level contains."""
    text = (folder / "level.json").read_text()
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or "", text, flags=re.S))


def merged(level, patch):
    """JSON Merge Patch (RFC 7396)."""
    result = dict(level)
    for key, value in patch.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict):
            result[key] = merged(result.get(key, {}) if isinstance(result.get(key), dict) else {}, value)
        else:
            result[key] = value
    return result


def sheets(folder):
    """(variant or None, level as JSON, picture) of a level."""
    level = read_level(folder)
    yield None, level, folder / "preview.png"
    for variant, patch in sorted(level.get("variants", {}).items()):
        yield variant, merged(level, patch), folder / f"preview_{variant}.png"


def record(recorder, backend, folder, variant, level, picture):
    with tempfile.TemporaryDirectory() as scratch:
        command = [recorder, str(folder), "--backend", backend, "--out", scratch, "--every", str(level.get("duration", 10) / (PICTURES - 1))]
        if variant is not None:
            command += ["--variant", variant]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        shutil.copy(pathlib.Path(scratch) / "contact_sheet.png", picture)


def gallery(folders):
    lines = []
    for folder in folders:
        for variant, level, picture in sheets(folder):
            title = folder.name if variant is None else f"{folder.name}, `--variant {variant}`"
            lines += [f"**{title}**: {level.get('description', '')}\n", f"![{title}]({folder.name}/{picture.name})\n"]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recorder")
    parser.add_argument("levels", nargs="*", help="default: all")
    parser.add_argument("--backend", default="auto")
    options = parser.parse_args()
    folders = sorted(path.parent for path in LEVELS.glob("*/level.json"))
    for folder in folders:
        if options.levels and folder.name not in options.levels:
            continue
        for variant, level, picture in sheets(folder):
            print(folder.name, variant or "", flush=True)
            record(options.recorder, options.backend, folder, variant, level, picture)
    readme = LEVELS / "README.md"
    text = readme.read_text()
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    readme.write_text(text[:start] + gallery(folders) + text[end:])


if __name__ == "__main__":
    main()
