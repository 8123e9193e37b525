#!/usr/bin/env python3
"""A header of the plugin as doxygen wants it. Usage: header_filter.py HEADER.

The headers are written for people who read them in an editor: plain comments, a line `/* ---- Worlds ---- */` ahead of each part, a note behind
each field and number. Here the parts become groups, and notes belong to what they stand behind. No word is changed."""
import pathlib
import re
import sys


def escaped(text):
    """Words that doxygen would take for commands, tags or links; what is in backquotes is code."""
    text = re.sub(r"([\\@&$#%])", r"\\\1", text)
    return re.sub(r"`([^`\n]+)`", r"<code>\1</code>", text.replace("<", "\\<").replace(">", "\\>"))


def paragraphs(body):
    """Inside a comment: a paragraph for each of "Waits: ..." and "Errors: ...", bold words ahead."""
    return re.sub(r"(?m)^(\s*\*\s+)(Waits and errors|Waits|Errors)(, nothing copied)?: ", r"\1\\par \2\3\n\1", body)


def comment(found):
    text = found[0]
    ahead, body = ("/**", text[3:-2]) if text.startswith("/**") else ("/*", text[2:-2])
    return ahead + paragraphs(escaped(body)) + "*/"


def of_file(text):
    """The comment at a header's top: `Waits   Nothing ...` becomes a paragraph with its name; what else is indented, and no list, stays as it is."""
    found, inside = [], ""
    for line in text.splitlines():
        line = re.sub(r"^ \* ?", "", line).rstrip()
        named = re.match(r"  ([A-Z]\w+) {2,}(\S.*)", line)
        if named:
            kind = "named"
        elif not line.startswith(" "):
            kind = ""
        elif re.match(r" +- ", line):
            kind = "list"
        else:
            kind = inside or "written"
        if inside == "written" != kind:
            found.append("</pre>")
        if kind == "written" != inside:
            found.append("<pre>")
        if inside in ("named", "list") and not kind:
            found.append("")
        found.append(f"\\par {named[1]}\n * {named[2]}" if named else line if kind == "written" else line.strip() if kind == "named" else line)
        inside = kind
    return "\n".join(f" * {line}".rstrip() for line in found) + "\n"


def filtered(path):
    header = path.read_text(encoding="utf-8")
    header = re.sub(r"/\*.*?\*/", comment, header, flags=re.DOTALL)
    header = re.sub(r"\A/\* (.*?)\*/", lambda m: f"/** \\file {path.name}\n *\n{of_file(m[1])} */", header, count=1, flags=re.DOTALL)
    parts = 0
    def part(found):
        nonlocal parts
        parts += 1
        name = re.sub(r"\W+", "_", found[1].lower())
        return ("/** \\} */\n" if parts > 1 else "") + f"/** \\defgroup {name} {found[1]}\n * \\{{ */"
    header = re.sub(r"(?m)^/\* ---- (.*?) ---- \*/$", part, header)
    if parts:
        at = header.rindex("#ifdef __cplusplus\n}")
        header = header[:at] + "/** \\} */\n" + header[at:]
    # Notes behind fields, numbers and macros, and what follows them on lines of their own.
    return re.sub(r"(?m)^([^\n/*#][^\n]*?[;,0-9A-Za-z)])([ \t]+)/\*(?!\*)", r"\1\2/**<", header)


sys.stdout.write(filtered(pathlib.Path(sys.argv[1])))
