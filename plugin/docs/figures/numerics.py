"""The figures of engine/NUMERICS.md. Each function names its section; curves are what its formulas give with the defaults of a level."""
from math import exp, sqrt

from sheet import BLUE, FAINT, GROUND, INK, OCHRE, SAND, WARM, WATER, WET, Figure, Plot, default

G, RHO_W = 9.81, default("water_density")
RHO_S, MU, CHI = default("sand_density"), default("friction"), default("slope_normal")
LIGHT = "#f4e7c8"
BUOYANCY = RHO_W / RHO_S  # r^


def clamp(x, low, high):
    return min(max(x, low), high)


def minmod(a, b):
    return 0.0 if a * b <= 0 else min(a, b, key=abs)


def grid():
    """Section 1."""
    f = Figure(720, 330)
    side, left, top = 84, 40, 34
    def x_of(i):
        return left + side * i
    def y_of(j):
        return top + side * (3 - j)
    f.box(x_of(0), y_of(3), side, 3 * side, "#eceff1", "none")
    for n in range(5):
        f.line([(x_of(n), y_of(3)), (x_of(n), y_of(0))], FAINT, 1.2)
    for n in range(4):
        f.line([(x_of(0), y_of(n)), (x_of(4), y_of(n))], FAINT, 1.2)
    f.line([(x_of(1), y_of(3)), (x_of(1), y_of(0))], WARM, 1.8, "5 4")
    for j in range(3):
        for i in range(4):
            if i > 0:
                f.parts.append(f'<circle cx="{x_of(i + 0.5):.1f}" cy="{y_of(j + 0.5):.1f}" r="5" fill="{INK}"/>')
            if i > 0:
                f.arrow((x_of(i) - 13, y_of(j + 0.5)), (x_of(i) + 13, y_of(j + 0.5)), BLUE)
                f.arrow((x_of(i + 0.5), y_of(j) + 13), (x_of(i + 0.5), y_of(j) - 13), OCHRE)
    f.text(x_of(2.5) + 9, y_of(1.5) - 9, "(i, j)", 13, slanted=True)
    f.text(x_of(2) - 6, y_of(1.5) - 12, "u[i, j]", 13, "end", BLUE, slanted=True)
    f.text(x_of(2.5) + 10, y_of(1) + 16, "v[i, j]", 13, fill=OCHRE, slanted=True)
    f.text(x_of(0) + 5, y_of(1.5) - 12, "ghost cells", 12.5)
    f.text(x_of(1), y_of(0) + 24, "west side", 13, "middle", WARM)
    f.arrow((x_of(4) + 24, y_of(0)), (x_of(4) + 24, y_of(0) - 60), INK, 1.5)
    f.text(x_of(4) + 32, y_of(0) - 48, "north", 13)
    f.arrow((x_of(4) + 24, y_of(0)), (x_of(4) + 84, y_of(0)), INK, 1.5)
    f.text(x_of(4) + 52, y_of(0) - 8, "east", 13)
    for n, (words, fill) in enumerate((("in the middle of a cell: H, hs, W,", INK), ("V - I, saturation, hz", INK), ("on its west face: us, uw, um", BLUE), ("on its south face: vs, vw, vm", OCHRE))):
        f.text(x_of(4) + 24, top + 16 + 24 * n, words, 14, fill=fill)
    return f.svg("The grid: heights in the middles of cells, velocities on west and south faces, ghost cells beyond a side")


def upwind():
    """2.2 and 2.16: a bump that a steady velocity carries, by the raw flux of either order."""
    cells, courant, steps = 80, 0.4, 50
    def start(x):
        return 1.0 if 8 <= x < 20 else exp(-((x - 32) / 4) ** 2)
    def carried(order):
        h = [start(i + 0.5) for i in range(cells)]
        for _ in range(steps):
            flux = []
            for i in range(cells + 1):  # through the west face of cell i
                if i in (0, 1, cells):
                    flux.append(0.0)
                    continue
                slope = minmod(h[i] - h[i - 1], h[i - 1] - h[i - 2]) if order == 2 else 0.0
                flux.append(courant * (h[i - 1] + (1 - courant) * slope / 2))
            h = [h[i] + flux[i] - flux[i + 1] for i in range(cells)]
        return h
    f = Figure(720, 300)
    p = Plot(f, 60, 36, 630, 200, (20, 70), (0, 1.1), (20, 30, 40, 50, 60, 70), (0, 0.5, 1), "cell", "height")
    shift = courant * steps
    p.of(lambda x: start(x - shift), FAINT, 5, count=400)
    for order, stroke in ((1, WARM), (2, BLUE)):
        p.curve([(i + 0.5, value) for i, value in enumerate(carried(order)) if 20 <= i < 70], stroke)
    for n, (words, fill) in enumerate((("exact", "#78909c"), ("order 1: upwind", WARM), ("order 2: limited slopes", BLUE))):
        f.text(530, 60 + 22 * n, words, 14, fill=fill)
    return f.svg("A step and a bump carried over 20 cells: upwind spreads them, limited slopes keep them, neither over- nor undershoots")


def dam_and_bore(viscosity, cells=110, dx=0.1, dt=0.01, until=1.9):
    """2.2 to 2.4 along one axis, first order: water of 1 m that runs into still water of 0.8 m; heights behind `until` seconds."""
    deep, low = 1.0, 0.8
    speed = (deep - low) * sqrt(G / 2 * (1 / low + 1 / deep))  # that of a bore between both
    k = dt / dx
    first = 20
    h = [deep if i < first else low for i in range(cells)]
    u = [speed if i <= first else 0.0 for i in range(cells + 1)]
    for _ in range(round(until / dt)):
        flux = [speed * k * deep] + [k * (max(u[i], 0) * h[i - 1] + min(u[i], 0) * h[i]) for i in range(1, cells)] + [0.0]
        h = [h[i] + flux[i] - flux[i + 1] for i in range(cells)]
        spread = [0.0] * cells
        for i in range(1, cells - 1):
            a, b, c = (u[n] - u[n + 1] for n in (i, i - 1, i + 1))
            r = max(0.0, a - 3 * max(0.0, min(b, c)))
            fast, slow = sorted((abs(u[i]), abs(u[i + 1])), reverse=True)
            s = slow / fast if fast > 0 else 0.0
            few, many = sorted((abs(flux[i]), abs(flux[i + 1])))
            v = many + max(0.0, 4 * s - 3) * max(0.0, few - many)
            nu = min(k * min(viscosity * sqrt(G * h[i]), 12 * r), 0.12) if viscosity > 0 else 0.0
            spread[i] = -min(nu * h[i], 4 * v) * r
        new = list(u)
        for i in range(1, cells):
            hb = (h[i - 1] + h[i]) / 2
            west, east = (flux[i - 1] + flux[i]) / 2, (flux[i] + flux[i + 1]) / 2
            new[i] = u[i] + (max(-east, 0) * (u[i + 1] - u[i]) + max(west, 0) * (u[i - 1] - u[i])) / hb + (spread[i] - spread[i - 1]) / hb
            capped = min(G, max(0.15, default("gravity_cap") - k * abs(u[i])) ** 2 / (k * k * max(h[i - 1], h[i])))
            new[i] -= k * capped * (h[i] - h[i - 1])
        u = new
    return [((i + 0.5) * dx, value) for i, value in enumerate(h)]


def bore():
    """2.3, shock viscosity."""
    f = Figure(720, 300)
    p = Plot(f, 60, 36, 630, 200, (6.5, 9.5), (0.75, 1.1), (7, 8, 9), (0.8, 0.9, 1.0), "m", "depth, m")
    for viscosity, stroke in ((0.0, WARM), (default("shock_viscosity"), BLUE)):
        p.curve([(x, h) for x, h in dam_and_bore(viscosity) if 6.5 <= x <= 9.5], stroke)
    f.text(490, 64, "without shock viscosity", 14, fill=WARM)
    f.text(490, 86, f"with the usual {default('shock_viscosity'):g}", 14, fill=BLUE)
    p.arrow((6.8, 0.87), (7.3, 0.87))
    p.text(6.8, 0.885, "it runs east")
    p.text(8.9, 0.775, "still water, 0.8 m")
    return f.svg("A bore from 0.8 to 1 m: without shock viscosity ripples of two cells stand behind it, with it there are none")


def cohesive(c_m, hs, capped=True):
    """c of 2.7 with slope_normal."""
    c_f = default("yield_friction")
    c = 0.78 * 4 * c_f * (c_f + sqrt(1 + c_f * c_f)) * c_m
    return min(c, 2 * c_f * default("cohesion_cap") * RHO_S * G * hs) if capped else c


def yield_surface():
    """2.7 with the default material, cohesion of wet sand, under 1 m of it: K = 1, and k = 1, since R is above 4."""
    hs, c_f, young, poisson = 1.0, default("yield_friction"), default("young_modulus"), default("poisson_ratio")
    lame, shear = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    c = cohesive(default("cohesion_wet"), hs)
    a = c_f * (2 * shear + 2 * lame)
    tip = c / a
    least = -(default("passive_pressure") * RHO_S * G * hs + c / c_f) / (lame + shear)
    def cone(tr):
        return -(a * tr - c) / (2 * shear)
    f = Figure(720, 320)
    percent = 100
    p = Plot(f, 70, 40, 620, 210, (-34, 16), (0, 44), (-30, -20, -10, 0, 10), (0, 10, 20, 30, 40), "trace of the strain, %: compressed to the left, pulled to the right",
             "deviator of the strain, %")
    inside = [(least * percent, 0), (least * percent, cone(least) * percent), (tip * percent, 0)]
    f.shape([p.at(*corner) for corner in inside], LIGHT)
    p.curve([inside[0], inside[1], inside[2]], INK)
    for start, end in (((0.02, 0.2), (0.02, cone(0.02))), ((-0.15, 0.36), (-0.15, cone(-0.15))), ((0.13, 0.11), (tip, 0)), ((-0.32, 0.2), (least, 0.2))):
        p.dot(start[0] * percent, start[1] * percent, WARM)
        p.arrow(tuple(percent * part for part in start), tuple(percent * part for part in end), WARM)
    p.text(-13.5, 35, "onto the cone: the trace stays", WARM)
    p.text(5.5, 15, "beyond the tip: to it", WARM)
    p.text(-33.5, 23, "cap", WARM)
    p.text(-22, 8, "elastic: nothing changes")
    return f.svg("The yield surface over trace and deviator of the strain: compression cap, cone and tip, and where strain beyond them is brought")


def friction():
    """2.8: sand at rest, 1 m deep, full of water that moves at um; dt 1/60 s and three substeps."""
    dts = 1 / 60 / default("substeps")
    kd = dts * default("exchange_rate")
    kappa = 1 / RHO_S * RHO_W * kd / (RHO_W + kd)
    n = MU * G * dts * max(0.0, 1 - BUOYANCY)
    def sand(um):
        p = kappa * um
        return max(0.0, 1 - n / p) * p / (1 + kappa) if p > 0 else 0.0
    def water(um):
        return (RHO_W * um + kd * sand(um)) / (RHO_W + kd)
    f = Figure(720, 310)
    p = Plot(f, 60, 36, 630, 210, (0, 0.3), (0, 0.3), (0, 0.1, 0.2, 0.3), (0, 0.1, 0.2, 0.3), "velocity of the water before, m/s", "velocity after the substep, m/s")
    p.of(lambda um: um, FAINT, 2, "5 4")
    p.of(water, BLUE)
    p.of(sand, OCHRE, first=1e-9)
    p.curve([(n / kappa, 0), (n / kappa, 0.26)], FAINT, 1.2, "4 4")
    p.text(n / kappa + 0.004, 0.25, "friction gives way")
    p.text(0.225, 0.245, "without drag", "#78909c", anchor="end")
    p.text(0.24, 0.135, "water, um'", BLUE)
    p.text(0.24, 0.045, "sand, us'", OCHRE)
    return f.svg("Sand at rest with water that flows in it: the sand stays until the water's push passes friction, and the water slows in the same solve")


def steepest():
    """s* of 2.18."""
    return MU + sqrt(MU * MU + 1 / CHI)


def slope():
    """2.18 without cohesion: push C r S, friction mu C, of own weight; and 2.7, 2.8 as on level ground."""
    steep = steepest()
    def share(s):
        return 1 / (1 + CHI * min(s * s, steep * steep))
    def push(s):
        return share(s) * min(1.0, steep / s if s > 0 else 1.0) * s
    f = Figure(720, 330)
    p = Plot(f, 60, 36, 630, 230, (0, 2.2), (0, 1.1), (0, 0.5, 1, 1.5, 2), (0, 0.5, 1), "slope of the surface", "per weight of the sand")
    p.of(lambda s: s, FAINT, 2, "5 4", last=1.1)
    p.of(lambda s: MU, FAINT, 2, "5 4")
    p.of(push, WARM)
    p.of(lambda s: MU * share(s), BLUE)
    p.curve([(MU, 0), (MU, push(MU))], FAINT, 1.2, "4 4")
    p.curve([(steep, 0), (steep, push(steep))], FAINT, 1.2, "4 4")
    p.dot(MU, push(MU))
    p.text(MU + 0.03, 0.05, f"slides from mu = {MU:g} on")
    p.text(steep + 0.03, 0.05, f"wedge, s* = {steep:.2f}")
    p.text(1.1, 1.0, "push as on level ground", "#78909c")
    p.text(1.75, 0.53, "friction there", "#78909c")
    p.text(1.66, 0.385, "push along the slope", WARM)
    p.text(0.54, 0.12, "friction of the normal weight", BLUE)
    return f.svg("Push and friction of sand against the slope of its surface: both have the cosine squared, and the push ends at Coulomb's wedge")


def wedge_slope():
    """s_p of 2.18: the largest root of 2 chi s^3 - 3 mu chi s^2 - mu, at least 0.1."""
    low, high = MU, 10.0
    for _ in range(60):
        s = (low + high) / 2
        low, high = (low, s) if 2 * CHI * s ** 3 - 3 * MU * CHI * s * s - MU > 0 else (s, high)
    return max(low, 0.1)


def wedge():
    """2.18, active push: the surface z of the rule, for a terrace of 1 m of sand; passive: K of the passive rule without cohesion."""
    f = Figure(720, 300)
    dx, cells = 0.05, 80
    surface = [1.0 if i < 40 else 0.0 for i in range(cells)]
    z = list(surface)
    s_p = wedge_slope()
    for _ in range(cells):
        z = [max(0.0, min([surface[i]] + [z[n] + s_p * dx for n in (i - 1, i + 1) if 0 <= n < cells])) for i in range(cells)]
    p = Plot(f, 60, 40, 330, 200, (0, 3), (0, 1.2), (0, 1, 2, 3), (0, 0.5, 1), "m", "active: a terrace of sand, m")
    def edges(values):
        return [(x, value) for i, value in enumerate(values) if i < 60 for x in (i * dx, (i + 1) * dx)]
    corners = edges(surface)
    f.shape([p.at(*c) for c in [*corners, (3, 0), (0, 0)]], SAND)
    f.shape([p.at(*c) for c in [*corners, *reversed(edges(z))]], "#e79a7f")
    p.curve(corners, INK, 1.4)
    p.text(0.15, 0.4, "stays: below z")
    p.text(2.1, 0.72, "the wedge, hz", WARM)
    f.line([p.at(2.08, 0.73), p.at(1.8, 0.7)], WARM, 1)
    p.text(1.35, 1.08, f"z rises by s_p = {s_p:.2g}", anchor="middle")
    q = Plot(f, 460, 40, 230, 200, (0, 1), (0, 6), (0, 0.5, 1), (0, 2, 4, 6), "friction mu", "passive: Kp")
    q.of(lambda mu: (mu + sqrt(mu * mu + 1)) ** 2, BLUE)
    kp = (MU + sqrt(MU * MU + 1)) ** 2
    q.dot(MU, kp)
    q.text(MU + 0.06, kp - 0.5, f"{kp:.1f} times", size=13)
    q.text(0.25, 0.5, "sand uphill withstands", size=13)
    return f.svg("Left: the wedge of a terrace that can slide, above the steepest surface z. Right: how much push sand uphill withstands, by its friction")


def retention():
    """2.19 and 2.8, with the default retention."""
    r = default("retention")
    f = Figure(720, 310)
    f.text(20, 24, "columns of sand, by W/hs", 13.5)
    for n, share in enumerate((0.3, 0.6, 0.8, 1.0)):
        left, top, high = 30 + 88 * n, 46, 200
        full = clamp((share - r) / (1 - r), 0, 1)
        held = min(share, r) if full == 0 else r
        f.box(left, top, 60, high, LIGHT)
        f.shape([(left, top), (left + 60 * held, top), (left + 60 * held, top + high), (left, top + high)], WATER)
        f.box(left, top + high * (1 - full), 60, high * full, WATER)
        f.box(left, top, 60, high, "none")
        f.text(left + 30, top + high + 20, f"{share:g}", 13, "middle")
    f.text(30, 286, f"blue: share of the pores; above the table it is {r:.2f}", 12.5)
    p = Plot(f, 450, 46, 240, 200, (0, 1), (0, 1), (0, 0.5, 1), (0, 0.5, 1), "W/hs", "share")
    p.of(lambda w: clamp((w - r) / (1 - r), 0, 1), BLUE)
    p.of(lambda w: clamp((w - r) / (1 - r), 0, 1) ** 3, WARM)
    p.text(0.68, 0.5, "full pores", BLUE, 13, "end")
    p.text(0.99, 0.15, "kr", WARM, 13.5, "end")
    return f.svg("Four columns of sand: a film is held up to 0.49 of the pores, more water stands as a table with full pores; how easily water moves, by saturation")


def prestress():
    """2.20 for dry pores on level ground: T, and sigma, which the tip bears; two cohesions."""
    steep = steepest()
    c_f = default("yield_friction")
    def push(hs):
        return RHO_S * G * hs / 2
    def tension(c_m):
        def sigma(hs):
            if hs <= 0:
                return 0.0
            w = min(1.0, 4 * cohesive(c_m, hs, False) / (c_f * RHO_S * G * hs))
            least = 1 / (1 + CHI * steep * steep)
            return min(push(hs) * w * (least + w * (1 - least)), cohesive(c_m, hs) / (2 * c_f))
        return sigma
    f = Figure(720, 310)
    p = Plot(f, 60, 36, 630, 210, (0, 3), (0, 30), (0, 1, 2, 3), (0, 10, 20, 30), "depth of sand, m", "kPa")
    p.of(lambda hs: push(hs) / 1000, FAINT, 2, "5 4")
    for c_m, stroke, place in ((default("cohesion_wet"), BLUE, (1.66, 13.5)), (2000.0, OCHRE, (1.2, 1.9))):
        p.of(lambda hs: tension(c_m)(hs) / 1000, stroke)
        bears = cohesive(c_m, 100) / (2 * c_f)
        p.dot(bears / (RHO_S * G / 2), bears / 1000, stroke)
        p.text(*place, f"tension, cohesion {c_m / 1000:g} kPa: {bears / (RHO_S * G / 2):.2g} m in balance", stroke)
    p.text(2.35, 25.5, "what gravity pushes with, T", "#78909c", anchor="end")
    return f.svg("Tension that sand begins with against its depth: it balances gravity's push until the tip of the yield surface bears no more")


def porosity():
    """2.23: the surface D of W metres of water poured on a metre of sand."""
    f = Figure(720, 310)
    p = Plot(f, 60, 36, 400, 210, (0, 1.5), (0, 2.2), (0, 0.5, 1, 1.5), (0, 0.5, 1, 1.5, 2), "water poured on, m", "its surface above the ground, m")
    f.shape([p.at(0, 0), p.at(1.5, 0), p.at(1.5, 1), p.at(0, 1)], LIGHT)
    for n, stroke in ((1.0, OCHRE), (0.4, BLUE)):
        p.of(lambda w: min(w, n) / n if w < n else w + 1 - n, stroke, count=150)
    p.text(0.4, 1.4, "n = 0.4", BLUE)
    p.text(1.02, 0.78, "n = 1", OCHRE)
    p.text(0.05, 1.08, "sand, 1 m", size=12.5)
    n, w = 0.4, 0.7
    left, foot, metre = 540, 246, 130
    for x in range(2):
        of = left + 90 * x
        f.box(of, foot - metre, 60, metre, SAND)
        share = (1.0, n)[x]
        inside = min(w, share)
        f.shape([(of, foot), (of + 60 * share, foot), (of + 60 * share, foot - metre * inside / share), (of, foot - metre * inside / share)], WET if x == 0 else "#8fb6cc")
        if w > share:
            f.box(of, foot - metre - metre * (w - share), 60, metre * (w - share), WATER)
        f.box(of, foot - metre, 60, metre, "none")
        f.text(of + 30, foot + 20, f"n = {share:g}", 13, "middle")
    f.text(left - 30, 54, "0.7 m of water in 1 m of sand", 13)
    return f.svg("The surface of water poured on a metre of sand: with porosity 0.4 the pores are full at 0.4 m, and the rest stands above")


def infiltration():
    """2.24: M by the rule, step by step; K 1 mm/s, n 0.4, the default suction, a pond that stays as deep."""
    conductivity, n, dt = 1e-3, 0.4, 1 / 60
    def front(pond, suction):
        m, points = 0.0, [(0.0, 0.0)]
        for step in range(1, round(120 / dt) + 1):
            m += conductivity * dt * (1 + (pond + suction) / max(m / n, 0.01))
            if step % 60 == 0:
                points.append((step * dt, m / n))
        return points
    f = Figure(720, 310)
    p = Plot(f, 60, 36, 630, 210, (0, 120), (0, 0.6), (0, 30, 60, 90, 120), (0, 0.2, 0.4, 0.6), "seconds", "depth of the wet front, m")
    p.of(lambda t: conductivity * t / n, FAINT, 2, "5 4")
    suction = default("suction")
    for pond, stroke, words, place in ((0.02, OCHRE, "film of 2 cm", (78, 0.255)), (0.1, BLUE, "pond of 10 cm", (62, 0.39))):
        p.curve(front(pond, suction), stroke)
        p.text(*place, words, stroke, anchor="middle")
    p.text(84, 0.17, "own weight alone, K t/n", "#78909c")
    return f.svg("Depth of the wet front in dry sand against time: fast at first, since suction and pond drive a thin layer most")


def bed_load():
    """2.11, in units of sqrt((s - 1) g d^3); the marks above are the speed of water over grains of 1 mm with bed_shear 0.003, s = 2."""
    f = Figure(720, 320)
    p = Plot(f, 60, 60, 630, 200, (0, 0.5), (0, 2.5), (0, 0.1, 0.2, 0.3, 0.4, 0.5), (0, 0.5, 1, 1.5, 2, 2.5), "Shields stress, tau / ((rho_s - rho_w) g d)", "bed load")
    p.of(lambda theta: 8 * max(0.0, theta - 0.047) ** 1.5, BLUE, count=120)
    p.dot(0.047, 0, WARM)
    p.text(0.03, 0.55, "0.047: grains begin to move", WARM)
    for speed in (0.4, 0.6, 0.8, 1.0, 1.2):
        theta = 0.003 * speed ** 2 / ((RHO_S / RHO_W - 1) * G * default("grain_size"))
        x, y = p.at(theta, 2.5)
        f.line([(x, y), (x, y + 6)], INK, 1.2)
        f.text(x, y - 6, f"{speed:g}", 12.5, "middle")
    f.text(690, 32, "speed of the water for grains of 1 mm, m/s", 13.5, "end")
    return f.svg("Bed load against Shields stress after Meyer-Peter and Mueller: none below 0.047, then the power 1.5")


def brush():
    """2.10: the weight of a brush."""
    f = Figure(720, 270)
    p = Plot(f, 60, 36, 630, 170, (0, 1.2), (0, 1.1), (0, 0.5, 1), (0, 0.5, 1), "distance from the middle / radius", "weight")
    def weight(softness):
        def at(d):
            s = clamp((1 - d) / softness, 0, 1)
            return 3 * s * s - 2 * s * s * s
        return at
    for softness, stroke, x, y in ((0.1, OCHRE, 0.97, 0.9), (0.5, BLUE, 0.76, 0.6), (1.0, WARM, 0.22, 0.72)):
        p.of(weight(softness), stroke, count=150)
        p.text(x, y, f"softness {softness:g}", stroke, anchor="end" if softness == 1.0 else "start")
    return f.svg("The weight of a brush over its radius, for three softnesses")


FIGURES = {
    "grid": grid, "upwind": upwind, "bore": bore, "yield": yield_surface, "friction": friction, "slope": slope, "wedge": wedge, "retention": retention,
    "prestress": prestress, "porosity": porosity, "infiltration": infiltration, "bed_load": bed_load, "brush": brush}
