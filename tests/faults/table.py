#!/usr/bin/env python3
"""Each fault of README.md has a test that is there: the words of a link are words of its file, and that file is part of a program that
ctest or attack.sh runs. Tries planted faults first. Usage: table.py REPOSITORY"""
import pathlib
import re
import sys

FAULTS = 20
GLOBBED = ("tests/unit/", "tests/stability/", "tests/reference/", "tests/plugin/")  # every file there is compiled


def rows_of(page):
    for line in page.splitlines():
        row = re.match(r"\| (\d+) \| (.+) \| (.+) \|$", line)
        if row:
            yield int(row[1]), re.findall(r"\[([^\]]+)\]\(([^)]+)\)", row[3])


def problems(page, read, builds):
    """`read` gives a file's text by its path from the repository's root, or None; `builds`: all that says what is built and run."""
    found = []
    rows = list(rows_of(page))
    if [number for number, _ in rows] != list(range(1, FAULTS + 1)):
        found.append(f"faults {[number for number, _ in rows]}, wanted 1 to {FAULTS} in their order")
    for number, tests in rows:
        if not tests:
            found.append(f"fault {number}: no test")
        for words, link in tests:
            path = pathlib.PurePosixPath("tests/faults")
            for part in link.split("/"):
                path = path.parent if part == ".." else path / part
            text = read(str(path))
            if text is None:
                found.append(f"fault {number}: {path} is gone")
                continue
            # Texts of a C++ program may run over lines; a doctest case must have the words in its name.
            whole = re.sub(r'"\s*\n\s*"', "", text)
            names = "\n".join(re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.)*)"', whole)) if "TEST_CASE(" in whole else whole
            if words not in names:
                found.append(f"fault {number}: {path} has no '{words}'")
            if str(path).startswith("tests/") and not str(path).startswith(GLOBBED) and path.stem not in builds:
                found.append(f"fault {number}: {path} is part of no program")
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    page = (root / "tests/faults/README.md").read_text()

    def read(path):
        return (root / path).read_text() if (root / path).is_file() else None

    builds = "\n".join((root / path).read_text() for path in ("tests/CMakeLists.txt", "tests/faults/CMakeLists.txt", "tests/csharp/check.py"))
    # Controls: each of these must be found.
    renamed = "a private file stays private"
    planted = {
        "a test of another name": problems(page, lambda path: (read(path) or "").replace(renamed, "renamed"), builds),
        "a file that is gone": problems(page, lambda path: None if path.endswith("test_threads.cpp") else read(path), builds),
        "a file that nobody builds": problems(page, read, builds.replace("many_bodies", "")),
        "a fault that is gone": problems(re.sub(r"\| 7 \|.*\n", "", page), read, builds),
        "a fault without a test": problems(page.replace("[step of a world", "step of a world"), read, builds),
        "a case that is no case any more": problems(
            page, lambda path: (read(path) or "").replace('TEST_CASE("level edits: no step', 'inform("level edits: no step'), builds),
    }
    found = problems(page, read, builds)
    unseen = [name for name, noticed in planted.items() if len(noticed) <= len(found)]
    for text in found + [f"not noticed: {name}" for name in unseen]:
        print(text)
    links = sum(len(tests) for _, tests in rows_of(page))
    print(f"{FAULTS} faults, {links} tests, {len(found)} wrong; {len(planted) - len(unseen)} of {len(planted)} planted faults noticed")
    return 1 if found or unseen else 0


sys.exit(main())
