#!/usr/bin/env python3
"""The quick start of plugin/README.md is the compiled sample's, line by line. Usage: quick_start.py SOURCE_DIR."""
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
program = (source / "samples/quick_start/main.c").read_text(encoding="utf-8").split("compares them). */\n")[1]
shown = re.search(r"## Quick start\n.*?```c\n(.*?)```", (source / "plugin/README.md").read_text(encoding="utf-8"), re.DOTALL)
if shown is None or shown.group(1) != program:
    sys.exit("plugin/README.md shows another program than samples/quick_start/main.c; it must read:\n" + program)
print(f"{len(program.splitlines())} lines, the same in both")
