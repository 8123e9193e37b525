"""The figures of ../concepts.md."""
from sheet import FAINT, GROUND, INK, SAND, WARM, WATER, WET, Figure, default, default_saturations, smooth


def layers():
    f = Figure(720, 300, top=40)
    xs = [10 * n for n in range(73)]
    ground = [295 - 45 * smooth((x - 300) / 400) for x in xs]
    sand = [g - 18 - 165 * smooth((x - 180) / 170) * smooth((700 - x) / 260) for x, g in zip(xs, ground)]
    lake = 150.0  # the water's surface, on the left and inside the sand
    table = [lake + 150 * smooth((x - 300) / 330) for x in xs]
    water = [min(t, g) for t, g in zip(table, ground)]
    surface = [min(s, w) if x < 330 else s for x, s, w in zip(xs, sand, water)]
    f.shape([*zip(xs, surface), (720, 340), (0, 340)], WATER)
    f.shape([*zip(xs, sand), (720, 340), (0, 340)], SAND)
    f.shape([*zip(xs, [max(s, w) for s, w in zip(sand, water)]), (720, 340), (0, 340)], WET)
    f.shape([*zip(xs, ground), (720, 340), (0, 340)], GROUND)
    for curve in (ground, sand):
        f.line(list(zip(xs, curve)), INK, 1.2)
    f.line([(x, w) for x, w, s in zip(xs, water, sand) if w <= s], "#1f5f91", 1.8)
    f.line([(x, w) for x, w, s, g in zip(xs, water, sand, ground) if s < w < g], "#1f5f91", 1.4, "5 4")
    def at(curve, x):
        return curve[int(x / 10)]
    f.span(90, lake, at(sand, 90), "h_w: water above")
    f.span(250, at(sand, 250), at(ground, 250), "hs: sand")
    f.span(400, at(water, 400), at(ground, 400), "h_m: mixed water")
    f.span(590, at(ground, 590), 338, "H: ground")
    f.text(440, 62, "dry sand", fill=INK)
    f.line([(432, 66), (410, 100)], INK, 1)
    f.text(20, 130, "W = h_w + h_m: all water of a cell", slanted=True)
    return f.svg("Ground, sand, water inside the sand and water above it, in a cut")


def step():
    f = Figure(760, 250)
    f.text(10, 26, "one step of dt", bold=True)
    water = ["sources, rain", "open sides", "outflow limit", "fluxes", "heights", "velocities", "saturation"]
    f.text(10, 58, "water step, dt")
    for n, name in enumerate(water):
        f.box(10 + 105 * n, 68, 99, 34, WATER)
        f.text(59.5 + 105 * n, 89, name, 12.5, "middle")
    sand = ["transport", "strain", "exchange", "force", "friction"]
    for k in range(3):
        left = 10 + 248 * k
        f.text(left, 142, f"sand substep {k + 1}, dt/3")
        for n, name in enumerate(sand):
            f.box(left + 47.5 * n, 152, 45.5, 34, SAND)
            f.text(left + 47.5 * n + 22.7, 172.5, name, 9.5, "middle")
    f.line([(10, 215), (748, 215)], INK, 1.2)
    for x, words in ((10, "boundary"), (748, "boundary")):
        f.line([(x, 208), (x, 222)], INK, 1.2)
        f.text(x, 240, words, 12.5, "start" if x < 100 else "end")
    f.text(379, 240, "edits come in, saves, queries and outputs go out at boundaries alone", 12.5, "middle")
    return f.svg("The order of one step: the water step, then three substeps of the sand")


def tiles():
    f = Figure(720, 300)
    size, columns, rows = 30, 14, 8
    def moves(i, j):
        return (i - 4.2) ** 2 + 1.8 * (j - 3.6) ** 2 < 4.6
    moved = {(i, j) for i in range(columns) for j in range(rows) if moves(i, j)}
    ring = {(i + a, j + b) for i, j in moved for a in (-1, 0, 1) for b in (-1, 0, 1)} - moved
    for j in range(rows):
        for i in range(columns):
            fill = WARM if (i, j) in moved else "#f3b79f" if (i, j) in ring else "#eceff1"
            f.box(20 + size * i, 30 + size * j, size, size, fill, "#ffffff", 2)
    for n, (fill, first, second) in enumerate(((WARM, "something changed", "in the last two steps"), ("#f3b79f", "within the rings:", "changes could reach it"),
                                               ("#eceff1", "asleep:", "the step leaves it out"))):
        f.box(470, 60 + 70 * n, size, size, fill, INK, 0.8)
        f.text(512, 72 + 70 * n, first)
        f.text(512, 91 + 70 * n, second)
    return f.svg("Tiles of cells: those that changed, the rings around them, and those that sleep")


def sides():
    f = Figure(760, 380)
    panels = (
        ("wall", "nothing passes", None), ("discharge", "a known inflow", "in"), ("level", "a lake or tide outside", "both"),
        ("waves", "swell in, waves out", "both"), ("outflow", "a stream runs on", "out"), ("brink", "free fall over an edge", "out"))
    for n, (name, words, way) in enumerate(panels):
        left, top = 10 + 250 * (n % 3), 8 + 190 * (n // 3)
        edge, right, floor = left + 80, left + 235, top + 150
        f.text(left, top + 16, name, bold=True)
        f.text(left + 9.5 * len(name) + 12, top + 16, words, 13)
        def bed(x):
            return floor - 12 + (10 * (edge - x) / 80 if name == "outflow" else 0)
        def surface(x):
            if name == "brink":
                return top + 75 + 28 * smooth((edge + 50 - x) / 60)
            if name == "waves":
                bump = max(0.0, 1 - abs(x - edge + 25) / 32)
                return top + 78 - 22 * smooth(bump)
            if name == "discharge":
                return top + 70 + 14 * smooth((x - edge) / 140)
            if name == "outflow":
                return top + 84 + 10 * (edge - x) / 80
            return top + 78
        first = edge if name in ("wall", "discharge", "brink") else left + 5
        xs = [first + (right - first) * k / 40 for k in range(41)]
        f.shape([*((x, surface(x)) for x in xs), (right, floor), (first, floor)], WATER)
        if name in ("level", "waves", "outflow"):  # what lies outside the grid is only thought of
            f.shape([(left + 5, top + 40), (edge, top + 40), (edge, floor), (left + 5, floor)], "#ffffff88")
        ground = [left + 5 if name not in ("wall", "brink") else edge, right]
        f.shape([*((x, bed(x)) for x in ground), (right, floor + 6), (ground[0], floor + 6)], GROUND)
        if name == "wall":
            f.box(edge - 12, top + 40, 12, floor + 6 - top - 40, GROUND, "none")
        if name == "discharge":
            f.box(edge - 12, top + 40, 12, 70, GROUND, "none")
        if name == "brink":
            f.shape([(edge, surface(edge)), (edge - 26, surface(edge) + 14), (edge - 44, floor + 6), (edge - 34, floor + 6), (edge - 16, bed(edge) + 2), (edge, bed(edge))], WATER)
        f.line([(edge, top + 34), (edge, floor + 6)], WARM, 1.6, "5 4")
        y = top + 118
        if way in ("in", "both"):
            f.arrow((edge - 34, y - (12 if way == "both" else 0)), (edge + 34, y - (12 if way == "both" else 0)))
        if way in ("out", "both") and name != "brink":
            f.arrow((edge + 34, y + (8 if way == "both" else 0)), (edge - 34, y + (8 if way == "both" else 0)))
        if name == "brink":
            f.arrow((edge + 62, y), (edge + 8, y))
    return f.svg("The six kinds of sides: wall, discharge, level, waves, outflow and brink; the grid lies right of the dashed line")


def cohesion():
    dry, wet, capillary = (default(f"cohesion_{sand}") for sand in ("dry", "wet", "capillary"))
    phis = default_saturations()
    f = Figure(720, 330)
    left, bottom, wide, high, most = 80, 270, 600, 220, 10000.0
    def place(phi, pascals):
        return left + wide * phi / 0.4, bottom - high * pascals / most
    f.line([(left, bottom - high - 10), (left, bottom), (left + wide, bottom)])
    for kilo in (0, 2, 4, 6, 8, 10):
        x, y = place(0, 1000 * kilo)
        f.line([(x - 4, y), (x, y)])
        f.text(x - 9, y + 5, str(kilo), 13, "end")
    f.text(left - 60, bottom - high - 22, "cohesion, kPa", 14)
    f.text(left + wide, bottom + 46, "saturation: water / (water + sand)", 14, "end")
    for n, phi in enumerate(phis):
        x, _ = place(phi, 0)
        f.line([(x, bottom), (x, bottom - high)], FAINT, 1, "4 4")
        f.text(x, bottom + 20, f"phi{n + 1} = {phi:g}", 13, "middle" if n != 1 else "start")
    corners = [(0, dry), (phis[0], wet), (phis[1], capillary), (phis[2], 0.0), (0.4, 0.0)]
    f.line([place(*corner) for corner in corners], WARM, 3)
    for phi, pascals, words in ((0.055, 1000, "dry sand slides"), (0.155, 9300, "damp sand holds a wall"), (0.305, 5400, "soaked sand slumps")):
        f.text(*place(phi, pascals), words, 14)
    return f.svg("Cohesion of sand against its saturation, with the defaults of a level")


FIGURES = {"layers": layers, "step": step, "tiles": tiles, "sides": sides, "cohesion": cohesion}
