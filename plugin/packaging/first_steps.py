#!/usr/bin/env python3
"""Does what the site's first page says, word for word, in an empty folder beside the zip, against the clock.

Usage: first_steps.py PAGE ZIP [--limit SECONDS] [--wine COMMAND]
PAGE is plugin/docs/hello.md. On Linux all its blocks for the shell that come before the viewer's are run, with --wine its block for Windows.
What they print must hold the lines that the page shows. Exit status 1 says what did not happen."""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

SHOWN = re.compile(r"<!-- hello.c prints from here -->\n```text\n(.*?)```", re.DOTALL)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("zip", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--wine")
    options = parser.parse_args()
    text = options.page.read_text(encoding="utf-8")
    shown = SHOWN.search(text)[1]
    ours = text[:text.index("\n## 4.")]
    language = "bat" if options.wine else ""
    blocks = [body for found, body in FENCE.findall(ours) if found == language]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copy(options.zip, folder)
        begin = time.monotonic()
        if options.wine:
            subprocess.run(["unzip", "-q", options.zip.name], cwd=folder, check=True)
            (folder / "steps.bat").write_text("@echo off\n" + "\n".join(blocks), encoding="ascii")
            command = [options.wine, "cmd", "/c", "steps.bat"]
        else:
            command = ["bash", "-e", "-c", "\n".join(blocks)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=10 * options.limit)
        took = time.monotonic() - begin
        times = done.stdout.replace("\r", "").count(shown)
        if done.returncode != 0 or times != len(blocks):
            sys.exit(f"first_steps.py: status {done.returncode}, the page's lines came {times} times:\n{done.stdout}{done.stderr}")
        if took > options.limit:
            sys.exit(f"first_steps.py: {took:.0f} s, {options.limit:.0f} s are allowed")
        print(f"{options.zip.name}: the first page's {len(blocks)} blocks show its water after {took:.1f} s")


if __name__ == "__main__":
    main()
