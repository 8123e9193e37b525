"""What the report measures errors on: exact solutions, laboratory laws, the Monai Valley tank, and scenes whose truth is a
double-precision run with a small step. A scene at a size and time step gives a level and what is measured of its recording."""
import math
import os
import pathlib
import subprocess
import tempfile

import cases
import exact
import recordings
from recordings import measures

G = 9.81
REFERENCES = pathlib.Path(__file__).resolve().parent / "references"
KINDS = ("water", "dry sand", "wet sand")


class Scene:
    """n: cells along x of its base size; dt(dx): its base time step; make(n): the level without dt; measure(run, summary, level): list
    of (name, unit, value, right answer or None), the first an error in percent, which the charts show."""

    def __init__(self, key, kind, title, n, seconds, make, measure, *, truth, step, fields=("W", "hs", "surface"), times=None, files=None, sweep=False):
        self.key, self.kind, self.title, self.n, self.seconds, self.make, self.measure = key, kind, title, n, seconds, make, measure
        self.truth, self.step, self.fields, self.times, self.files, self.sweep = truth, step, fields, times or (0, seconds), files, sweep


def base(name, nx, ny, dx, **rest):
    return {"format_version": 1, "name": name, "grid": {"nx": nx, "ny": ny, "dx": dx}, **rest}


def exact_dam_break(key, title, right):
    def make(n):
        level, _, _ = cases.dam_break(right, n)
        level.pop("dt")
        return level

    def measure(run, summary, level):
        dx, depth, t = run.dx, run.field("W", 3), summary["simulated_seconds"]
        truth = [exact.stoker((i + 0.5) * dx, t, 1, right, 25) if right else exact.ritter((i + 0.5) * dx, t, 1, 25) for i in range(run.nx)]
        off = [abs(depth[run.nx + i] - truth[i]) for i in range(run.nx)]
        level_of_front = 0.5 * (right + exact.stoker_middle(1, right)[0]) if right else 0.05
        front = max(i + 1 for i in range(run.nx) if depth[run.nx + i] > level_of_front) * dx - 25
        true_front = exact.stoker_middle(1, right)[2] * t if right else exact.ritter_front(t, 1, 25, 0.05) - 25
        return [("L1 error of depth", "%", 100 * math.fsum(off) / run.nx, 0), ("L2 error of depth", "%", 100 * math.sqrt(math.fsum(x * x for x in off) / run.nx), 0),
                ("largest error of depth", "%", 100 * max(off), 0), ("front has run", "m", front, true_front)]

    return Scene(key, "water", title, 400, 3, make, measure, truth="exact", step=lambda dx: 0.04 * dx)


def thacker():
    h0, a, r0, size = 0.1, 1.0, 0.8, 4.0
    big = (a * a - r0 * r0) / (a * a + r0 * r0)
    period = 2 * math.pi / (math.sqrt(8 * G * h0) / a)

    def depth(x, y, t):
        rr = ((x - size / 2) ** 2 + (y - size / 2) ** 2) / (a * a)
        q = 1 - big * math.cos(2 * math.pi * t / period)
        return max(0.0, h0 * (math.sqrt(1 - big * big) / q - 1 - rr * ((1 - big * big) / (q * q) - 1)) + h0 * (1 - rr))

    def bed(x, y):
        return -h0 * (1 - ((x - size / 2) ** 2 + (y - size / 2) ** 2) / (a * a))

    def make(n):
        return base("Thacker's bowl", n, n, size / n, terrain=[{"file": "bed.npy"}], water=[{"file": "water.npy"}])

    def files(n):
        dx = size / n
        centres = [((i + 0.5) * dx, (j + 0.5) * dx) for j in range(n) for i in range(n)]
        return {"bed.npy": (n, n, [bed(x, y) for x, y in centres]), "water.npy": (n, n, [depth(x, y, 0) for x, y in centres])}

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        now, middle = run.field("W", period), (run.ny // 2) * run.nx + run.nx // 2
        truth = [depth(x, y, t) for _, x, y in run.cells()]
        return [("L1 error of depth", "%", 100 * math.fsum(abs(a - b) for a, b in zip(now, truth)) / math.fsum(truth), 0),
                ("largest error of depth", "%", 100 * max(abs(a - b) for a, b in zip(now, truth)) / h0, 0),
                ("amplitude kept after a period", "%", 100 * (now[middle] - h0) / (truth[middle] - h0), 100)]

    return Scene("thacker", "water", "Thacker's radial bowl, one period", 96, period, make, measure, truth="exact", step=lambda dx: 0.1 * dx, fields=("W",),
                 files=files)


def bump():
    length, q, right = 25.0, 4.42, 2.0

    def bed(x):
        return max(0.0, 0.2 - 0.05 * (x - 10) ** 2)

    def make(n):
        dx = length / n
        return base("Flow over a bump", n, 3, dx, terrain=[{"file": "bed.npy"}], water=[{"shape": "plane", "surface": right}],
                    sides={"west": {"kind": "discharge", "value": q * 3 * dx}, "east": {"kind": "level", "value": right}})

    def files(n):
        return {"bed.npy": (n, 3, [bed((i + 0.5) * length / n) for _ in range(3) for i in range(n)])}

    def measure(run, summary, level):
        depth, off, total = run.field("W", 100), 0.0, 0.0
        for i in range(run.nx):
            z, h = bed((i + 0.5) * run.dx), right
            for _ in range(100):  # Newton on h^3 + b h^2 + q^2/(2g)
                b = z - q * q / (2 * G * right * right) - right
                h -= (h**3 + b * h * h + q * q / (2 * G)) / (3 * h * h + 2 * b * h)
            off, total = off + abs(depth[run.nx + i] - h), total + h
        return [("L1 error of depth", "%", 100 * off / total, 0)]

    return Scene("bump", "water", "Steady subcritical flow over a bump, after 100 s", 100, 100, make, measure, truth="exact", step=lambda dx: 0.04 * dx,
                 fields=("W",), files=files)


def slide():
    slope, friction = 0.3, 0.2

    def make(n):
        dx = 40 / n
        return base("Sliding layer", n, 3, dx, terrain=[{"shape": "plane", "height": 40 * slope, "slope_x": -slope}], sand=[{"shape": "plane", "height": 0.5}],
                    material={"friction": friction, "young_modulus": 0})

    def measure(run, summary, level):
        t = summary["simulated_seconds"]
        right = G * (slope - friction) * t
        got = run.field("us", 1)[run.nx + run.nx // 2]
        return [("error of the layer's velocity", "%", 100 * abs(got / right - 1), 0), ("velocity", "m/s", got, right)]

    return Scene("slide", "dry sand", "Layer on an incline, a = g (slope - friction), 1 s", 160, 1, make, measure, truth="exact", step=lambda dx: 0.04 * dx,
                 fields=("us",))


def column():
    radius, size = 0.5, 4.0

    def make(n):
        return base("Column", n, n, size / n, sand=[{"shape": "cylinder", "center": [size / 2, size / 2], "radius": radius, "height": radius}],
                    material={"friction": 0.7, "young_modulus": 0})  # quartz sand

    def measure(run, summary, level):
        sand, middle = run.field("hs", 3), size / 2
        edge = max(abs(x - middle) for n, x, y in run.cells() if sand[n] > 0.01 * radius and abs(y - middle) < run.dx)
        right = 1.24  # times the aspect ratio 1 (Lube et al. 2004)
        got = (edge + 0.5 * run.dx - radius) / radius
        return [("run-out off the law", "%", 100 * abs(got / right - 1), 0), ("run-out over radius", "", got, right)]

    return Scene("column", "dry sand", "Run-out of a column as high as its radius (Lube et al. 2004)", 96, 3, make, measure, truth="laboratory",
                 step=lambda dx: 0.14 * dx, fields=("hs",))


def drag_pair():
    exchange, sand, water, u0 = 2000.0, 1.0, 0.5, 1.0
    rate = exchange * (water / (2000 * sand) + 1 / 1000)

    def make(n):
        dx = 64 / n
        return base("Drag pair", n, 3, dx, gravity=0, sand=[{"shape": "plane", "height": sand}], water=[{"shape": "plane", "height": water}],
                    velocities=[{"of": "water", "shape": "plane", "velocity": [u0, 0]}],
                    material={"friction": 0, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0})

    def measure(run, summary, level):
        t, middle = summary["simulated_seconds"], run.nx + run.nx // 2
        us, um = run.field("us", 0.5)[middle], run.field("um", 0.5)[middle]
        right = u0 * math.exp(-rate * t)
        momentum = 1000 * water * um + 2000 * sand * us
        return [("error of the relative speed", "%", 100 * abs((um - us) - right) / u0, 0), ("relative speed", "m/s", um - us, right),
                ("momentum kept", "%", 100 * momentum / (1000 * water * u0), 100)]

    return Scene("drag_pair", "wet sand", "Relative speed of sand and the water in it decays exponentially, 0.5 s", 64, 0.5, make, measure, truth="exact",
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
                    material={"friction": 0.6, "young_modulus": 0, "exchange_rate": exchange, "diffusion_rate": 0})

    def files(n):
        return {"water.npy": (n, 3, [depth((i + 0.5) * size / n, start) for _ in range(3) for i in range(n)])}

    def measure(run, summary, level):
        s = start + darcy * summary["simulated_seconds"] / 2
        now = run.field("W", seconds)
        truth = [depth((i + 0.5) * run.dx, s) for i in range(run.nx)]
        return [("L1 error of depth", "%", 100 * math.fsum(abs(now[run.nx + i] - truth[i]) for i in range(run.nx)) / math.fsum(truth), 0),
                ("middle's depth", "m", now[run.nx + run.nx // 2], depth(size / 2, s))]

    return Scene("mound", "wet sand", "Mound of water seeping through sand at rest (Barenblatt)", 128, seconds, make, measure, truth="exact",
                 step=lambda dx: 0.2 * dx, fields=("W",), files=files)


# Scenes without a closed form: truth is the double-precision solver on REFERENCE_N cells along x.
REFERENCE_N = 256
LAYERS = (("hs", "sand"), ("W", "water"))  # fields of a reference, and what of a level brings them


def averaged(values, nx, ny, to_nx):
    """Means over blocks: a finer field on a coarser grid."""
    f = nx // to_nx
    return [math.fsum(values[(j * f + b) * nx + i * f + a] for b in range(f) for a in range(f)) / (f * f) for j in range(ny // f) for i in range(nx // f)]


def against_reference(key, kind, title, seconds, size, level_parts, step):
    def make(n):
        return base(title, n, n // 2, size / n, **level_parts)

    def measure(run, summary, level):
        end = {name: measures.read_npy(REFERENCES / f"{key}_{name}.npy")[2] for name, layer in LAYERS if layer in level}
        if run.nx > REFERENCE_N:
            raise ValueError(f"{key}: {run.nx} cells, its reference has {REFERENCE_N}")
        terrain = run.field("H", 0)
        result = []
        coarse = {name: averaged(values, REFERENCE_N, REFERENCE_N // 2, run.nx) for name, values in end.items()}
        none = [0] * len(terrain)
        truth = {"hs": coarse.get("hs", none), "surface": [h + max(w, s) for h, w, s in zip(terrain, coarse.get("W", none), coarse.get("hs", none))]}
        for name, what in (("hs", "sand"), ("surface", "water surface"))[:2 if "water" in level else 1]:
            before, now = run.field(name, 0), run.field(name, seconds)
            moved = [b - a for a, b in zip(before, truth[name])]
            span = max(moved) - min(moved)
            if span > 1e-6:
                result.append((f"MAE of {what}, of the range it moved", "%", 100 * math.fsum(abs(a - b) for a, b in zip(now, truth[name])) / len(now) / span, 0))
        mean = math.fsum(entry[2] for entry in result) / len(result)
        return [("MAE of the range moved", "%", mean, 0), *result]

    return Scene(key, kind, title, REFERENCE_N // 2, seconds, make, measure, truth="double-precision reference", step=step, fields=("H", "hs", "W", "surface"),
                 sweep=True)


def island():
    return against_reference("island", "water", "A flood meets an island", 2, 12.8, {
        "terrain": [{"shape": "cylinder", "center": [7, 3.4], "radius": 0.8, "height": 1.5, "side_slope": 2}],
        "water": [{"shape": "plane", "height": 0.1}, {"shape": "box", "from": [0, 0], "to": [3, 6.4], "height": 1, "combine": "set"}]},
        lambda dx: 0.08 * dx)


def heap():
    return against_reference("heap", "dry sand", "A tall block of dry sand falls onto a step", 2, 12.8, {
        "terrain": [{"shape": "box", "from": [7, 0], "to": [12.8, 6.4], "height": 0.3, "side_slope": 2}],
        "sand": [{"shape": "box", "from": [3, 2], "to": [6, 4.6], "height": 1.5}],
        "material": {"friction": 0.5, "young_modulus": 2e5, "cohesion_wet": 0, "cohesion_capillary": 0}},
        lambda dx: 0.08 * dx)


def wall():
    return against_reference("wall", "wet sand", "A wave meets a wall of damp sand and a dry heap", 2, 12.8, {
        "sand": [{"shape": "box", "from": [5, 1], "to": [6.2, 3.6], "height": 0.9, "side_slope": 3}, {"shape": "cone", "center": [8.5, 4.4], "radius": 1.6, "height": 0.7}],
        "water": [{"shape": "box", "from": [0, 0], "to": [3, 6.4], "height": 1}, {"shape": "box", "from": [4.6, 0.6], "to": [6.6, 4], "wet": 0.22}],
        "material": {"friction": 0.5, "young_modulus": 1.5e5, "cohesion_wet": 8e3, "cohesion_capillary": 8e3, "cohesion_dry": 200, "exchange_rate": 2e4, "diffusion_rate": 0.01}},
        lambda dx: 0.08 * dx)


def monai():
    """The tank of the Okushiri tsunami, 1:400; data in WADI_DATA_DIR/monai_valley or WADI_DATA_DIR."""
    def folder():
        root = pathlib.Path(os.environ.get("WADI_DATA_DIR", "/nonexistent"))
        return next((place for place in (root / "monai_valley", root) if (place / "Benchmark_2_input.txt").is_file()), None)

    gauges = {"ch5": (4.521, 1.196), "ch7": (4.521, 1.696), "ch9": (4.521, 2.196)}
    times = [round(0.25 * n, 2) for n in range(1, 91)]

    def make(n):
        rows = [line.split() for line in (folder() / "Benchmark_2_input.txt").read_text().splitlines()[1:] if line.strip()]
        series = [[float(t), float(v)] for t, v in rows]
        dx = 393 * 0.014 / n
        return base("Monai Valley", n, round(244 * n / 393), dx, terrain=[{"file": str(folder() / "Benchmark_2_Bathymetry.asc")}],
                    water=[{"shape": "plane", "surface": 0}], sides={"west": {"kind": "level", "value": series}})

    def measure(run, summary, level):
        lines = [line.split() for line in (folder() / "output_ch5-7-9.txt").read_text().splitlines()[1:] if line.strip()]
        measured = {float(row[0]): [float(v) / 100 for v in row[1:4]] for row in lines}
        result, worst = [], []
        for g, (name, (x, y)) in enumerate(gauges.items()):
            at = int(y / run.dx) * run.nx + int(x / run.dx)
            ours = [run.field("surface", t)[at] for t in times]
            lab = [measured[min(measured, key=lambda m, t=t: abs(m - t))][g] for t in times]
            rmse = math.sqrt(math.fsum((a - b) ** 2 for a, b in zip(ours, lab)) / len(times))
            worst.append(100 * rmse / (max(lab) - min(lab)))
            arrival = [next((t for t, v in zip(times, side) if v > 0.01), math.nan) for side in (ours, lab)]
            result += [(f"{name}: RMSE", "mm", 1000 * rmse, 0), (f"{name}: peak", "mm", 1000 * max(ours), 1000 * max(lab)),
                       (f"{name}: first above 1 cm", "s", arrival[0], arrival[1])]
        return [("RMSE of the gauges, of their range", "%", math.fsum(worst) / 3, 0), *result]

    scene = Scene("monai", "water", "Monai Valley tank, three gauges, 22.5 s", 196, 22.5, make, measure, truth="laboratory", step=lambda dx: 0.2 * dx,
                  fields=("surface",), times=(0, *times))
    scene.missing = "WADI_DATA_DIR does not name a folder with monai_valley/Benchmark_2_input.txt" if folder() is None else None
    return scene


def all_scenes():
    return [island(), heap(), wall(), exact_dam_break("stoker", cases.EXACT["stoker"][0], 0.2), exact_dam_break("ritter", cases.EXACT["ritter"][0], 0),
            thacker(), bump(), monai(), slide(), column(), drag_pair(), mound()]


def make_references(programs, keys, fractions=(8, 16)):
    """Runs the double-precision solver at base step / 16 and, for its own convergence, / 8; keeps the former."""
    REFERENCES.mkdir(exist_ok=True)
    lines = []
    for scene in all_scenes():
        if not scene.sweep or (keys and scene.key not in keys):
            continue
        level = {**scene.make(REFERENCE_N)}
        dx = level["grid"]["dx"]
        ends = []
        for fraction in fractions:
            with tempfile.TemporaryDirectory() as scratch:
                file = pathlib.Path(scratch) / "level.json"
                file.write_text(recordings.json.dumps({**level, "dt": scene.step(dx)}))
                subprocess.run([str(programs / "wadi-reference"), str(file), "--dt", str(scene.step(dx) / fraction), "--seconds", str(scene.seconds), "--out", scratch],
                               check=True, stdout=subprocess.DEVNULL)
                ends.append({name: measures.read_npy(pathlib.Path(scratch) / f"{name}_end.npy") for name in ("hs", "W")})
        for name, (nx, ny, values) in ((name, ends[-1][name]) for name, layer in LAYERS if layer in level):
            recordings.write_npy(REFERENCES / f"{scene.key}_{name}.npy", nx, ny, values)
        change = {name: math.fsum(abs(a - b) for a, b in zip(ends[0][name][2], ends[1][name][2])) / len(ends[0][name][2]) for name in ("hs", "W")}
        span = {name: max(max(ends[-1][name][2]) - min(ends[-1][name][2]), 1e-12) for name in ("hs", "W")}
        lines.append([scene.key, REFERENCE_N, f"{scene.step(dx) / fractions[1]:.3g}", *(f"{100 * change[name] / span[name]:.4f}" for name in ("hs", "W"))])
        print("reference:", lines[-1], flush=True)
    return lines
