#!/usr/bin/env python3
"""Pages (*.md) read quickly: on average fewer than 17 words a sentence, fewer than 12 semicolons and colons per 1000 words of prose.
Usage: page_style.py SOURCE_DIR [--table]     --table prints what each page has. Exit status 1 names every breach.

Prose is what is left without headings, tables, code blocks, pictures and what a program writes; a word in backquotes counts as one. Pages that
do not keep the rule yet stand in page_style.csv with ceilings of their own, which may only fall: a page that has got well below its ceiling
must have it lowered, and one that keeps the rule must leave the list."""
import csv
import math
import pathlib
import re
import sys
import tempfile

import page_rules

WORDS, MARKS = 17.0, 12.0  # a sentence; per 1000 words
FEW_MARKS = 3  # are no breach on a page however short
SLACK = 2  # a ceiling may be above what the page has by less than this
CEILINGS = "tests/unit/page_style.csv"
ITEM = re.compile(r"\s*(?:[-*]|\d+\.)\s+")
ENDS = re.compile(r"[.!?][)\"*_]*\s+(?=[*_(\"]*[A-Z0-9])")


def blocks_of(text):
    """Paragraphs and items of lists, as one line each."""
    found, current = [], []

    def end():
        if current:
            found.append(" ".join(current))
            current.clear()

    for _, line, written, code in page_rules.lines_of(text):
        bare = line.strip()
        if written or code or not bare or bare.startswith(("#", "|", "![", "<!--")):
            end()
            continue
        item = ITEM.match(line)
        if item:
            end()
        current.append(line[item.end() if item else 0:].strip())
    end()
    return found


def plain(block):
    block = re.sub(r"`[^`]*`", "Code", block)
    block = re.sub(r"\$[^$]*\$", "Formula", block)
    block = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", block)
    return re.sub(r"\s\.\.\.?(?=\s)", " to", block)


def measure(text):
    """(words, words a sentence, semicolons and colons per 1000 words) of the prose of a page."""
    words = sentences = marks = 0
    for block in map(plain, blocks_of(text)):
        marks += len(re.findall(r"[;:](?=\s|$|\*)", block))
        counts = [sum(any(c.isalnum() for c in word) for word in sentence.split()) for sentence in ENDS.split(block)]
        sentences += sum(count > 0 for count in counts)
        words += sum(counts)
    return words, words / max(sentences, 1), 1000 * marks / max(words, 1)


def breaches_of(page, measured, ceiling):
    words, sentence, marks = measured
    most_marks = max(MARKS, 1000 * FEW_MARKS / max(words, 1))
    keeps = sentence < WORDS and (marks < MARKS or marks <= most_marks)
    if ceiling is None:
        if sentence >= WORDS:
            yield f"{page}: {sentence:.1f} words a sentence, fewer than {WORDS:g} are asked for"
        if not (marks < MARKS or marks <= most_marks):
            yield f"{page}: {marks:.1f} semicolons and colons per 1000 words, fewer than {MARKS:g} are asked for"
        return
    if keeps:
        yield f"{page}: keeps the rule; take it off {CEILINGS}"
        return
    for what, has, most, limit in (("words a sentence", sentence, ceiling[0], WORDS), ("semicolons and colons", marks, ceiling[1], MARKS)):
        if has > most:
            yield f"{page}: {has:.1f} {what}; its ceiling is {most:g}"
        elif most - max(has, limit) >= SLACK:
            yield f"{page}: {has:.1f} {what}; lower its ceiling of {most:g} to {max(math.ceil(has), limit):g}"


def measured_pages(root):
    """{page: measured}, without pages that a program writes as a whole."""
    names = {page.relative_to(root).as_posix(): page for page in page_rules.pages(root)}
    return {name: measure(page.read_text(encoding="utf-8")) for name, page in names.items() if name not in page_rules.WRITTEN}


def check(root):
    pages = measured_pages(root)
    with (root / CEILINGS).open(newline="", encoding="utf-8") as file:
        ceilings = {row["page"]: (float(row["words"]), float(row["marks"])) for row in csv.DictReader(file)}
    found = [f"{name}: stands in {CEILINGS}, but is not there" for name in ceilings if name not in pages]
    for name, measured in pages.items():
        found += breaches_of(name, measured, ceilings.get(name))
    return found, pages


def control():
    """Planted breaches must be seen, and nothing else."""
    short = "You call this once per frame. It returns at once.\n"
    long = "A sentence that goes on " + "and on " * 12 + "ends at last.\n"
    planted = {
        "good": "# A: heading; of no account\n" + short * 20 + "```\na: b; c: d;\n```\n| a: | b; |\n- Use `a::b` and `c; d`: it works.\n", "long": long * 5, "marks": short * 20 + "So: it; goes: on; and: on.\n",
        "above": long * 5, "below": long * 5, "kept": short * 5}
    ceilings = {"above": (20, 12), "below": (40, 12), "kept": (20, 12), "gone": (20, 12)}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        (root / "engine").mkdir()
        (root / CEILINGS).parent.mkdir(parents=True)
        for name, text in planted.items():
            (root / f"engine/{name}.md").write_text(text)
        (root / CEILINGS).write_text("page,words,marks\n" + "".join(f"engine/{name}.md,{w},{m}\n" for name, (w, m) in ceilings.items()))
        seen, _ = check(root)
    wanted = ("gone.md: stands in", "above.md: 32.0 words a sentence; its ceiling is 20", "below.md: 32.0 words a sentence; lower its ceiling of 40 to 32",
              "kept.md: keeps the rule", "long.md: 32.0 words a sentence, fewer", "marks.md: 24.3 semicolons and colons per 1000")
    missing = [sign for sign in wanted if sum(sign in breach for breach in seen) != 1]
    return missing + ([] if len(seen) == len(wanted) else seen)


def main():
    wrong = control()
    if wrong:
        print("the checker does not see what is planted, or sees what is none:", *wrong, sep="\n")
        return 1
    found, pages = check(pathlib.Path(sys.argv[1]).resolve())
    if "--table" in sys.argv:
        print("| page | words | words a sentence | semicolons and colons per 1000 |", "| --- | ---: | ---: | ---: |", sep="\n")
        print(*(f"| {name} | {words} | {sentence:.1f} | {marks:.1f} |" for name, (words, sentence, marks) in pages.items()), sep="\n")
    print(*found, f"{len(pages)} pages, {len(found)} breaches", sep="\n")
    return 1 if found or len(pages) < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
