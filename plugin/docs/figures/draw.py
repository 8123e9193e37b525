#!/usr/bin/env python3
"""Draws the figures of ../concepts.md and of engine/NUMERICS.md as SVG. Usage: draw.py [--check]; --check changes nothing and exits with 1
where a figure is old."""
import pathlib
import sys

import concepts
import numerics

HERE = pathlib.Path(__file__).resolve().parent
FIGURES = concepts.FIGURES | numerics.FIGURES


def main():
    old = []
    for name, draw in FIGURES.items():
        path, text = HERE / f"{name}.svg", draw()
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        old.append(path.name)
        if "--check" not in sys.argv:
            path.write_text(text, encoding="utf-8")
    print(f"{len(FIGURES)} figures" + (f"; {'old' if '--check' in sys.argv else 'written'}: {', '.join(old)}" if old else ""))
    sys.exit(1 if old and "--check" in sys.argv else 0)


if __name__ == "__main__":
    main()
