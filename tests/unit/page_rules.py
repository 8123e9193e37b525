#!/usr/bin/env python3
"""Pages (*.md): no line over 140 columns but rows of tables, no link to a file or heading that is not there, no file and no identifier named in backquotes that is
not there.
Usage: page_rules.py SOURCE_DIR. Exit status 1 names every breach."""
import fnmatch
import pathlib
import re
import sys
import tempfile

WIDTH = 140
FOLDERS = ("engine", "backends", "shaders", "plugin", "samples", "tests")
# What a program writes may be wider: pages written as a whole, and the parts of others between these marks.
WRITTEN = tuple(f"tests/lab/report/{page}/README.md" for page in ("effects", "prices_cpu", "prices_h100"))
BEGINS, ENDS = re.compile(r"<!-- (table: |\S+ writes from here)"), re.compile(r"<!-- (end|to here)")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`]+)`")
PATH = re.compile(r"[\w.*-]+(/[\w.*-]+)*/?$")
MADE = ("build/", "generated/", "out/")  # by builds and by programs
SOURCE = re.compile(r"\.(hpp|cpp|h|c|cu|py|sh|stage|fused|glsl|inl|comp|cmake|md|in|\*)$")
# Identifiers are asked for that have an underscore inside; pages may shorten them to how they end (`_get_hash`) or begin (`evolve_`).
IDENTIFIER = re.compile(r"(?:[A-Za-z]\w*(?:::|\.|->))*(_?[A-Za-z][A-Za-z0-9]*_\w*)(?:\(.*\))?")
OF_OTHERS = ("PF_", "FORMAT_")  # texture formats of engines
HISTORY = "CHANGELOG.md"  # names what has gone


def pages(root):
    return sorted([*root.glob("*.md"), *(p for top in FOLDERS for p in (root / top).rglob("*.md"))])


def lines_of(text):
    """(number, line, written by a program, inside a code block) of every line."""
    written = code = False
    for number, line in enumerate(text.splitlines(), 1):
        written = written or BEGINS.match(line) is not None
        fence = line.lstrip().startswith("```")
        code = code != fence
        yield number, line, written, code or fence
        written = written and not ENDS.match(line)


def anchors(path):
    """The fragments by which the headings of a page are linked."""
    found = []
    for _, line, _, code in lines_of(path.read_text(encoding="utf-8")):
        if not code and line.startswith("#"):
            found.append(re.sub(r"[^\w\- ]", "", line.lstrip("# ").lower()).replace(" ", "-"))
    return found


def link_breach(root, page, target):
    if re.match(r"[a-z]+:", target):
        return None
    name, _, heading = target.partition("#")
    to = (page.parent / name).resolve() if name else page
    if not to.exists() or root not in [to, *to.parents]:
        return f"links to {target}, which is not there"
    if heading and (to.suffix != ".md" or heading not in anchors(to)):
        return f"links to {target}, but {name or 'the page'} has no such heading"
    return None


def path_breach(names, page_folder, quoted):
    """Paths from the root, from the page, or their last parts; NAME and ROOM stand for any."""
    quoted = re.sub("NAME|ROOM", "*", quoted.rstrip("/"))
    if not PATH.match(quoted) or quoted.startswith(MADE):
        return None
    known = "/" in quoted and quoted.split("/")[0] in FOLDERS
    if not known and not SOURCE.search(quoted):
        return None
    patterns = [quoted, f"{page_folder}/{quoted}", f"*/{quoted}"]
    if any(pattern in names or ("*" in pattern and fnmatch.filter(names, pattern)) for pattern in patterns):
        return None
    return f"names {quoted}, which is not there"


def identifiers(root):
    """Every word of the files that are no pages, and how those with underscores begin and end."""
    words = set()
    for path in (p for top in FOLDERS for p in (root / top).rglob("*") if p.is_file()):
        words.add(path.stem)
        if path.suffix not in {".md", ".png", ".jpg", ".webp", ".csv", ".svg", ".npy", ".mp4"}:
            words.update(re.findall(r"[A-Za-z_]\w*", path.read_text(encoding="utf-8", errors="ignore")))
    for path in root.iterdir():
        if path.is_file() and path.suffix in {".txt", ".json"}:
            words.update(re.findall(r"[A-Za-z_]\w*", path.read_text(encoding="utf-8", errors="ignore")))
    parts = set()
    for word in words:
        for at in (n for n, c in enumerate(word) if c == "_"):
            parts.update((word[at:], word[at + 1:], word[:at + 1]))
    return words | parts


def identifier_breach(known, quoted):
    named = IDENTIFIER.fullmatch(quoted)
    if not named or "NAME" in quoted or named[1].startswith(OF_OTHERS) or named[1] in known:
        return None
    return f"names {named[1]}, which no source has"


def check(root):
    found = []
    known = identifiers(root)
    names = {p.relative_to(root).as_posix() for top in FOLDERS for p in (root / top).rglob("*")}
    names |= {p.name for p in root.iterdir()}
    for page in pages(root):
        relative = page.relative_to(root).as_posix()
        for number, line, written, code in lines_of(page.read_text(encoding="utf-8")):
            breaches = []
            table = line.startswith("|") and not code
            if len(line) > WIDTH and not table and not written and relative not in WRITTEN:
                breaches.append(f"{len(line)} columns, {WIDTH} are allowed")
            if not code:
                words = [word for quoted in CODE.findall(line) for word in quoted.split()]
                breaches += [link_breach(root, page, target) for target in LINK.findall(line)]
                breaches += [path_breach(names, page.parent.relative_to(root).as_posix(), word) for word in words]
                if relative != HISTORY:
                    breaches += [identifier_breach(known, quoted) for quoted in CODE.findall(line) if " " not in quoted]
            found += [f"{relative}:{number}: {breach}" for breach in dict.fromkeys(breaches) if breach]
    return found


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    # Negative controls: planted breaches must be seen, and nothing else.
    with tempfile.TemporaryDirectory() as folder:
        planted = pathlib.Path(folder).resolve()
        (planted / "engine").mkdir()
        (planted / "engine/there.cpp").write_text("int whole_name(int right_one);")
        (planted / "engine/README.md").write_text(
            "# A heading\n" + "x" * WIDTH + "\n" + "y" * (WIDTH + 1) + "\n[no file](gone.md) [no heading](#gone) [right](#a-heading)\n"
            "`engine/there.cpp`, `there.*`, `engine/gone.cpp` and `gone.hpp`\n"
            "`whole_name(1)`, `_name`, `whole_`, `a.right_one` and `no_such_name`\n"
            "<!-- table: wide -->\n" + "z" * (WIDTH + 1) + "\n<!-- end -->\n| " + "z" * WIDTH + " |\n")
        seen = check(planted)
        for sign in ("141 columns", "gone.md, which", "#gone, but", "engine/gone.cpp", "gone.hpp", "no_such_name"):
            if sum(sign in breach for breach in seen) != 1:
                print(f"the checker does not see a planted breach: {sign}")
                return 1
        if len(seen) != 6:
            print("the checker sees what is none:", *seen, sep="\n")
            return 1
    found = check(root)
    print(*found, f"{len(pages(root))} pages, {len(found)} breaches", sep="\n")
    return 1 if found or len(pages(root)) < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
