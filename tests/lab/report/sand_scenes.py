"""Sand, dry and wet, whose right answer is a formula or a law found in the laboratory."""
import math

import exact
from scene import G, Scene, base, middle_row, norms

# The closed forms are those of sand on level ground whose water all flows; NUMERICS 2.18 and 2.19 are measured in tests/lab/sand.
AS_EQUATIONS = {"slope_normal": 0, "internal_friction": 0, "sand_viscosity": 0, "retention": 0}


def slide():
    slope, friction = 0.3, 0.2

    def make(n):
        dx = 40 / n
        return base("Sliding layer", n, 3, dx, terrain=[{"shape": "plane", "height": 40 * slope, "slope_x": -slope}], sand=[{"shape": "plane", "height": 0.5}],
                    material={"friction": friction, "young_modulus": 0})

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        right = G * (slope - friction) / (1 + slope**2) * t
        got = run.field("us", 1)[run.nx + run.nx // 2]
        return [("error of the layer's velocity", "%", 100 * abs(got / right - 1), 0), ("velocity", "m/s", got, right)]

    return Scene("slide", "dry sand", "Layer on an incline, a = g (slope - friction)/(1 + slope^2), 1 s", 160, 1, make, measure, step=lambda dx: 0.04 * dx,
                 fields=("us",))


def soaked_slide(key, title, exchange, together):
    """Sand full of water under a sheet of it, on an incline: the water carries part of the weight that friction acts on."""
    slope, friction, sand, sheet = 0.3, 0.25, 0.5, 0.3
    share = 1000 * sand / (2000 * sand)

    def make(n):
        dx = 40 / n
        return base(title, n, 3, dx, terrain=[{"shape": "plane", "height": 40 * slope, "slope_x": -slope}], sand=[{"shape": "plane", "height": sand}],
                    water=[{"shape": "plane", "height": sand + sheet}],
                    material={"friction": friction, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0, **AS_EQUATIONS})

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        right, dry = exact.incline_acceleration(slope, friction, share, together) * t, exact.incline_acceleration(slope, friction, 0, together) * t
        got = middle_row(run, "us", 1)[run.nx // 2]
        return [("error of the layer's velocity", "%", 100 * abs(got / right - 1), 0), ("velocity", "m/s", got, right), ("velocity of dry sand", "m/s", dry, None)]

    return Scene(key, "wet sand", title, 160, 1, make, measure, step=lambda dx: 0.04 * dx, fields=("us",))


def column():
    radius, size = 0.5, 4.0

    def make(n):
        return base("Column", n, n, size / n, sand=[{"shape": "cylinder", "center": [size / 2, size / 2], "radius": radius, "height": radius}],
                    material={"friction": 0.7, "young_modulus": 0, **AS_EQUATIONS})  # quartz sand

    def measure(run, summary, level):
        sand, middle = run.field("hs", 3), size / 2
        edge = max(abs(x - middle) for n, x, y in run.cells() if sand[n] > 0.01 * radius and abs(y - middle) < run.dx)
        right = 1.24  # times the aspect ratio 1 (Lube et al. 2004)
        got = (edge + 0.5 * run.dx - radius) / radius
        return [("run-out off the law", "%", 100 * abs(got / right - 1), 0), ("run-out over radius", "", got, right)]

    return Scene("column", "dry sand", "Run-out of a column as high as its radius (Lube et al. 2004)", 96, 3, make, measure,
                 step=lambda dx: 0.14 * dx, fields=("hs",))


def drag_pair():
    exchange, sand, water, u0 = 2000.0, 1.0, 0.5, 1.0
    rate = exchange * (water / (2000 * sand) + 1 / 1000)

    def make(n):
        dx = 64 / n
        return base("Drag pair", n, 3, dx, gravity=0, sand=[{"shape": "plane", "height": sand}], water=[{"shape": "plane", "height": water}],
                    velocities=[{"of": "water", "shape": "plane", "velocity": [u0, 0]}],
                    material={"friction": 0, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0, **AS_EQUATIONS})

    def measure(run, summary, level):
        t, middle = summary["simulated_seconds"], run.nx + run.nx // 2
        us, um = run.field("us", 0.5)[middle], run.field("um", 0.5)[middle]
        right = u0 * math.exp(-rate * t)
        momentum = 1000 * water * um + 2000 * sand * us
        return [("error of the relative speed", "%", 100 * abs((um - us) - right) / u0, 0), ("relative speed", "m/s", um - us, right),
                ("momentum kept", "%", 100 * momentum / (1000 * water * u0), 100)]

    return Scene("drag_pair", "wet sand", "Relative speed of sand and the water in it decays exponentially, 0.5 s", 64, 0.5, make, measure,
                 step=lambda dx: 0.05 * dx, fields=("us", "um"))


def mound():
    exchange, spread, start, end = 2e5, 1.0, 1.0, 3.0
    darcy = 1000 * G / exchange
    size = 16.0

    def depth(x, s):
        return max(0.0, s ** (-1 / 3) * (spread - (x - size / 2) ** 2 / (12 * s ** (2 / 3))))

    seconds = round(2 * (end - start) / darcy, 6)

    def make(n):
        return base("Mound", n, 3, size / n, sand=[{"shape": "plane", "height": 1.5}], water=[{"file": "water.npy"}],
                    material={"friction": 0.6, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0, **AS_EQUATIONS})

    def files(n):
        return {"water.npy": (n, 3, [depth((i + 0.5) * size / n, start) for _ in range(3) for i in range(n)])}

    def measure(run, summary, level):
        s = start + darcy * summary["simulated_seconds"] / 2
        now, truth = middle_row(run, "W", seconds), [depth((i + 0.5) * run.dx, s) for i in range(run.nx)]
        return [*norms(now, truth), ("middle's depth", "m", now[run.nx // 2], depth(size / 2, s))]

    return Scene("mound", "wet sand", "Mound of water seeping through sand at rest (Barenblatt)", 128, seconds, make, measure,
                 step=lambda dx: 0.2 * dx, fields=("W",), files=files)


def dupuit():
    """Ramps of sand drown in both levels: seepage begins where a ramp rises out of the water."""
    length, sand, left, right, ramp, exchange, seconds = 2.0, 1.25, 1.0, 0.5, 4.0, 2e5, 80
    west, east = 0.75, 2.75  # where the ramps have the heights of the levels

    def make(n):
        dx = 3.5 / n
        top = {"from": [west + (sand - left) / ramp, 0], "to": [east - (sand - right) / ramp, 3 * dx]}
        return base("Dupuit's dam", n, 3, dx, sand=[{"shape": "box", **top, "height": sand, "side_slope": ramp}],
                    water=[{"shape": "box", "from": [0, 0], "to": [west, 3 * dx], "height": left}, {"shape": "box", "from": [west, 0], "to": [3.5, 3 * dx], "height": right}],
                    sides={"west": {"kind": "level", "value": left}, "east": {"kind": "level", "value": right}},
                    material={"friction": 10, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0, **AS_EQUATIONS})

    def measure(run, summary, level):
        depth, inside, flow = middle_row(run, "W", seconds), middle_row(run, "um", seconds), []
        cells = [i for i in range(run.nx) if west < (i + 0.5) * run.dx < east]
        truth = [exact.dupuit((i + 0.5) * run.dx - west, length, left, right) for i in cells]
        for i in cells[len(cells) // 4:-len(cells) // 4]:
            flow.append(inside[i] * depth[i])
        seeps = 1000 * G / exchange * (left * left - right * right) / (2 * length)
        return [*norms([depth[i] for i in cells], truth), ("seeps through", "1e-3 m2/s", 1000 * math.fsum(flow) / len(flow), 1000 * seeps),
                ("sand moved", "m3", run.moved(0, seconds), None)]

    return Scene("dupuit", "wet sand", "Steady seepage through sand between two levels (Dupuit), after 80 s", 112, seconds, make, measure,
                 step=lambda dx: 0.1 * dx, fields=("W", "hs", "um"))


def all_scenes():
    return [slide(), column(), soaked_slide("drained_slide", "Drowned layer on an incline, water free to pass, a = g (slope - friction (1 - r))", 0, False),
            soaked_slide("soaked_slide", "The same with its water held, a = g (slope - friction (1 - r)/(1 + r))", 1e8, True), drag_pair(), mound(), dupuit()]
