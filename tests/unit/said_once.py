#!/usr/bin/env python3
"""No statement of a stage stands there twice with x and y exchanged: EACH_AXIS says it once. Usage: said_once.py SOURCE_DIR.
Prints the count of statements; exit status 1 names every pair."""
import pathlib
import re
import sys

# Parts of names that a transposed scene exchanges, and the usual short names of places and velocities along both axes.
PAIRS = [("x", "y"), ("xx", "yy"), ("i", "j"), ("nx", "ny"), ("w", "s"), ("e", "n"), ("ww", "ss"), ("ee", "nn"), ("nw", "se"), ("west", "south"), ("east", "north"),
         ("fx", "fy"), ("gx", "gy"), ("px", "py"), ("m1", "m2"), ("p1", "p2"), ("m1c", "m2c"), ("dx", "dy"), ("columns", "rows"), ("i0", "j0"), ("i1", "j1"),
         ("x0", "y0"), ("x1", "y1")]
OTHER = {a: b for pair in PAIRS for a, b in (pair, pair[::-1])}
INDEX = re.compile(r"IDX\(([^(),]*),([^(),]*)\)")


def other_part(part):
    """u and v, us and vs, u1 and v1 ... are velocities along the two axes."""
    if part in OTHER:
        return OTHER[part]
    velocity = re.fullmatch(r"([uv])([a-z]?)(\d*)", part)
    return ("v" if velocity[1] == "u" else "u") + velocity[2] + velocity[3] if velocity else part


def other_axis(statement):
    words = re.sub(r"[A-Za-z_]\w*", lambda m: "_".join(other_part(p) for p in m[0].split("_")), statement)
    return INDEX.sub(lambda m: f"IDX({m[2].strip()}, {m[1].strip()})", words)


def statements(text):
    """Statements of the functions and the kernel, blanks made one."""
    text = re.sub(r"//[^\n]*", "", text)
    bindings = [m.end() for m in re.finditer(r"^(?:IN|OUT|INOUT)(?:_IF)?\(.*\)$", text, re.M)]
    text = text[bindings[-1]:] if bindings else ""
    text = text[:text.rfind("END_STAGE")]
    found, current, depth = [], "", 0
    for c in text:
        depth += (c == "(") - (c == ")")
        if c in ";{}" and depth == 0:
            if current.split():
                found.append(" ".join(current.split()))
            current = ""
        else:
            current += c
    return found


def twice(text):
    all_of_them = statements(text)
    return all_of_them, sorted({s for s in all_of_them if other_axis(s) != s and " ".join(other_axis(s).split()) in all_of_them})


CONTROL = """STAGE(Control)
EXTENT(FACES)
IN(0, float, height)
OUT(1, float, slope_x)
KERNEL {
    int w = IDX(i - 1, j);
    int s = IDX(i, j - 1);
    float u = height[w]; float once = 1.0f;
}
END_STAGE
"""


def main():
    if twice(CONTROL)[1] != ["int s = IDX(i, j - 1)", "int w = IDX(i - 1, j)"]:
        print("the counter does not see a planted pair")
        return 1
    count, pairs, files = 0, 0, sorted((pathlib.Path(sys.argv[1]) / "shaders" / "stages").rglob("*.stage"))
    for path in files:
        found, doubled = twice(path.read_text(encoding="utf-8"))
        count += len(found)
        pairs += len(doubled)
        for statement in doubled:
            print(f"{path.name}: {statement}")
    print(f"{len(files)} stages, {count} statements, {pairs} that are another's with the axes exchanged")
    return 1 if pairs or count < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
