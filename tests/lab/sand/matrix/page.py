"""README.md of the matrix between its marks, and its picture."""
import itertools
import sys

import beds
import columns
import on_bed

BEGIN, END = "<!-- matrix.py writes from here -->\n", "<!-- to here -->\n"
GROUPS = {"rest": "At rest", "incline": "Inclines", "face": "Faces", "bank": "Still water", "on_bed": "A column on a bed, against the material point method"}


def number(row):
    """Its value, bold where it is wrong; the ends of what a bisection tries are bounds."""
    text = f"{row.measured:.3g}" if abs(row.measured) < 1e4 else "far off"
    if row.name.startswith("cohesion it needs") and row.measured >= 8:
        text = "8 or more"
    return text if row.ok or not row.limit else f"**{text}**"


def marked(head, rows):
    return ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |", *("| " + " | ".join(row) + " |" for row in rows), ""]


def summary(results):
    rows = []
    for group, title in GROUPS.items():
        own = [result for result in results if result.name.split("/")[0] == group]
        if own:
            wrong = [result for result in own if result.missed]
            rows.append([title, f"{len(own)}", f"{len(own) - len(wrong)}", f"{len(wrong)}"])
    return marked(["", "cases", "right", "wrong"], rows)


def cell_of(result):
    """Its slope over the friction, or that it rests as it was drawn; behind it what else is wrong."""
    first, *others = result.rows
    texts = [number(first) if first.name.startswith("steepest") else "rests" if first.ok else f"{first.name} {number(first)} {first.unit}".rstrip()]
    texts += [f"{row.name} {number(row)}{' ' + row.unit if row.unit else ''}" for row in others if not row.ok]
    return "; ".join(texts)


def resting(results):
    lines = []
    variants = {}
    for result in results:
        _, shape, bed, friction, turn = result.name.split("/")
        variants.setdefault((result.dx, friction, turn), {})[shape, bed] = result
    # The largest table first.
    for (dx, friction, turn), cells in sorted(variants.items(), key=lambda item: (-len(item[1]), item[0])):
        names = [bed for bed in beds.BEDS if any(key[1] == bed for key in cells)]
        shapes = [shape for shape in beds.SHAPES if any(key[0] == shape for key in cells)]
        wrong = sum(bool(result.missed) for result in cells.values())
        lines += [f"### Cells of {dx:g} m, {friction.replace('_', ' ')}, {turn.replace('_', ' ')} degrees: {wrong} of {len(cells)} wrong", ""]
        lines += marked(["", *names], [[shape, *(cell_of(cells[shape, bed]) if (shape, bed) in cells else "" for bed in names)] for shape in shapes])
    return lines


def listed(results):
    """A line for each run of rows that share a limit."""
    rows = []
    for result in results:
        for (what, limit, unit, reference), same in itertools.groupby(result.rows, lambda row: (row.name.rpartition(", ")[0], row.limit, row.unit, row.reference)):
            same = list(same)
            labels = "; ".join(row.name.rpartition(", ")[2] for row in same)
            of = f"{what}, {labels}" if what else labels
            name = result.name.split("/", 1)[1].replace("_", " ").replace("/", ", ")
            rows.append([name, f"{result.dx:g}", of, "; ".join(number(row) for row in same) + (f" {unit}" if unit else ""), limit, reference])
    return marked(["", "dx", "what", "measured", "limit", "law"], rows)


def chart(here, lab):
    sys.path.insert(1, str(here.parents[1] / "report"))
    import charts

    def points(depth):
        return [((n + 0.5) * columns.STRIP, float(value)) for n, value in enumerate(depth[:30])]
    lines = [("drawn", points(on_bed.profile(lab, "round", 0.1, 0)), "dash"), ("material points, at rest", points(on_bed.reference("round")), "line")]
    lines += [(f"Wadi, cells of {dx:g} m, at rest", points(on_bed.profile(lab, "round", dx)), "line") for dx in (0.1, 0.05)]
    text = charts.line_chart("A round column on 1 m of its own sand", "distance from the middle [m]", "depth [m]", lines)
    (here / "column_on_bed.svg").write_text(text)


def write(here, results, lab):
    sys.path.insert(1, str(here.parents[1] / "report"))
    import stamps
    lines = summary(results)
    for group, title in GROUPS.items():
        own = [result for result in results if result.name.split("/")[0] == group]
        if own:
            lines += [f"## {title}", ""]
            if group == "rest":
                named = [result for result in own if result.name.count("/") == 4]
                lines += resting(named)
                own = [result for result in own if result not in named]
            if own:
                lines += listed(own)
    lines += ["![Profiles of a column on a bed](column_on_bed.svg)", "", stamps.stamp("matrix"), ""]
    chart(here, lab)
    page = here / "README.md"
    text = page.read_text()
    start, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    page.write_text(text[:start] + "\n".join(lines) + text[end:])
