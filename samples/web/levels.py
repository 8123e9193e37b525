#!/usr/bin/env python3
"""Copies the levels that the page has, with their maps, and writes levels.json, which tells the page of them.

Usage: levels.py FOLDER. The page's beach has no hand of its own that builds, and waves for as long as anyone plays."""
import json
import pathlib
import re
import sys

LEVELS = pathlib.Path(__file__).resolve().parent.parent / "levels"
# Title, camera (samples/levels/README.md#picture), accuracy by threads or without, how the sun stands, presets' names.
PAGE = {
    "beach": {"title": "beach", "camera": [-20, -32, 0.62, 0.5, 0.74], "accuracy": ["draft", "draft"], "sun": [250, 26],
              "about": "A castle of damp sand, and a wave every 6.5 s.", "hint": "Drag to dig a moat"},
    "castle": {"title": "castle", "camera": [-35, -28, 0.62, 0.42, 0.5], "accuracy": ["balanced", "draft"], "sun": [250, 38],
               "about": "A wave 3.5 m high meets a castle of damp sand.", "hint": "Drag to dig; R sends the wave again"},
    "canyon": {"title": "canyon", "camera": [18, -44, 0.86, 0.5, 0.6], "accuracy": ["balanced", "balanced"], "sun": [250, 38],
               "about": "A flood fills a canyon and cuts three dams of sand.", "foam": False, "hint": "Drag to dig a gap into a dam, or wall the flood off"},
    "piles": {"title": "piles", "camera": [-22, -42, 0.96, 0.5, 0.55], "accuracy": ["draft", "draft"], "sun": [250, 38],
              "about": "Six heaps, from dry to soaked.", "hint": "Pour water onto a heap, or dig its foot away"},
}
PERIOD, WAVES, CRESTS = 6.5, 180, [0.55, 0.65, 0.5, 0.75, 0.6, 0.8]  # [s], number, heights above the sea at rest [m]


def endless_waves(text):
    """The beach's level with a series of its own for the sea, and without its edits."""
    series = [[0, 0]]
    for wave in range(WAVES):
        begin, crest = 2 + PERIOD * wave, CRESTS[wave % len(CRESTS)]
        series += [[round(begin - 0.9, 3), 0], [begin, crest], [round(begin + 0.8, 3), round(crest - 0.1, 3)], [round(begin + 2, 3), -0.05]]
    text, changed = re.subn(r'"wave": \[.*?\]\s*\] \}', f'"wave": {json.dumps(series)} }}', text, flags=re.DOTALL)
    text, emptied = re.subn(r'"edits": \[.*?\n    \]', '"edits": []', text, flags=re.DOTALL)
    text, longer = re.subn(r'"duration": \d+', f'"duration": {int(PERIOD * WAVES)}', text)
    text, without = re.subn(r',\s*"variants": \{.*\}\s*\}\s*$', "\n}\n", text, flags=re.DOTALL)
    if (changed, emptied, longer, without) != (1, 1, 1, 1):
        raise ValueError("the beach's level is not written as this script expects it")
    return text


def variants_of(text):
    """Names and descriptions, from a level's text with its comments."""
    plain = json.loads(re.sub(r'^(\s*)//.*$', "", text, flags=re.MULTILINE))
    return {name: variant["description"] for name, variant in plain.get("variants", {}).items()}


def main():
    out = pathlib.Path(sys.argv[1])
    told = {}
    for name, page in PAGE.items():
        text = (LEVELS / name / "level.json").read_text(encoding="utf-8")
        if name == "beach":
            text = endless_waves(text)
        folder = out / "levels" / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "level.json").write_text(text, encoding="utf-8")
        files = re.findall(r'"file": "([^"]+)"', text)
        for file in files:
            (folder / file).write_bytes((LEVELS / name / file).read_bytes())
        told[name] = {**page, "files": files, "variants": variants_of(text)}
        if name == "beach":
            told[name]["waves"] = {"first": 2, "period": PERIOD}
    (out / "levels.json").write_text(json.dumps(told), encoding="utf-8")


if __name__ == "__main__":
    main()
