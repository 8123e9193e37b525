#!/usr/bin/env python3
"""No kernel is longer than 60 statements: it loads, takes steps that have names, and stores. Usage: kernel_size.py SOURCE_DIR.
A statement is what ends in a semicolon; EACH_AXIS counts once. Prints the longest kernels; exit status 1 names those that are too long."""
import pathlib
import re
import sys

MOST = 60


def kernel(text):
    """The body of the stage's kernel, without comments; empty where a stage is another one's text."""
    text = re.sub(r"//[^\n]*", "", text)
    start = text.find("KERNEL {")
    if start < 0:
        return ""
    depth = 0
    for at in range(text.index("{", start), len(text)):
        depth += (text[at] == "{") - (text[at] == "}")
        if depth == 0:
            return text[start:at]
    return text[start:]


def statements(text):
    return kernel(text).count(";")


def main():
    source = pathlib.Path(sys.argv[1])
    control = "HELPER void beside() { a = b; }\nKERNEL {\n" + "    EACH_AXIS { a = b; } // c; d;\n" * (MOST + 1) + "}\n"
    if statements(control) != MOST + 1:
        print(f"the control has {statements(control)} statements and should have {MOST + 1}")
        return 1
    counts = sorted(((statements(path.read_text()), path.relative_to(source)) for path in source.glob("shaders/stages/*/*.stage")), reverse=True)
    if len(counts) < 20:
        print(f"only {len(counts)} stages in {source}/shaders/stages")
        return 1
    for count, path in counts[:5]:
        print(f"{count:4d} statements: {path}")
    too_long = [path for count, path in counts if count > MOST]
    for path in too_long:
        print(f"{path}: a kernel of more than {MOST} statements; give its steps names in shaders/physics")
    return 1 if too_long else 0


if __name__ == "__main__":
    sys.exit(main())
