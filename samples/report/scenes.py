"""What the report measures errors on: exact solutions, laboratory laws, the Monai Valley tank, and scenes whose truth is a
double-precision run with a small step. A scene at a size and time step gives a level and what is measured of its recording."""
import math
import os
import pathlib
import subprocess
import tempfile

import recordings
import sand_scenes
import water_scenes
from recordings import measures
from scene import Scene, base

QUIET = 8  # [s]: until then nothing that came in at the tank's side has reached Monai's gauges
REFERENCES = pathlib.Path(__file__).resolve().parent / "references"


# Scenes without a closed form: truth is the double-precision solver on SOLVED_N cells along x with second order for water (first order
# on twice the cells is no truth to judge second order by), kept as means on REFERENCE_N.
SOLVED_N, REFERENCE_N = 512, 256
LAYERS = (("hs", "sand"), ("W", "water"))  # fields of a reference, and what of a level brings them


def averaged(values, nx, ny, to_nx):
    """Means over blocks: a finer field on a coarser grid."""
    f = nx // to_nx
    result = []
    for top in range(0, ny // f * f, f):
        rows = [values[j * nx:(j + 1) * nx] for j in range(top, top + f)]
        result += [math.fsum(cell) / (f * f) for cell in zip(*(row[a::f] for row in rows for a in range(f)))]
    return result


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
        "material": {"friction": 0.5, "young_modulus": 2e5, "cohesion_wet": 0, "cohesion_capillary": 0, **sand_scenes.AS_EQUATIONS},
        "method": {"prestress": False}, "effects": {"elastoplastic": "on"}},
        lambda dx: 0.08 * dx)


def wall():
    return against_reference("wall", "wet sand", "A wave meets a wall of damp sand and a dry heap", 2, 12.8, {
        "sand": [{"shape": "box", "from": [5, 1], "to": [6.2, 3.6], "height": 0.9, "side_slope": 3}, {"shape": "cone", "center": [8.5, 4.4], "radius": 1.6, "height": 0.7}],
        "water": [{"shape": "box", "from": [0, 0], "to": [3, 6.4], "height": 1}, {"shape": "box", "from": [4.6, 0.6], "to": [6.6, 4], "wet": 0.22}],
        "material": {"friction": 0.5, "young_modulus": 1.5e5, "cohesion_wet": 3.4e3, "cohesion_capillary": 3.4e3, "cohesion_dry": 85, "exchange_rate": 2e4, "diffusion_rate": 0.01, **sand_scenes.AS_EQUATIONS},
        "method": {"prestress": False}},
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
            before = [v for t, v in zip(times, lab) if t <= QUIET]
            still = 1000 * math.sqrt(math.fsum(v * v for v in before) / len(before))
            arrival = [next((t for t, v in zip(times, side) if v > 0.01), math.nan) for side in (ours, lab)]
            result += [(f"{name}: RMSE", "mm", 1000 * rmse, 0), (f"{name}: RMS of the laboratory's before the wave comes", "mm", still, None), (f"{name}: peak", "mm", 1000 * max(ours), 1000 * max(lab)),
                       (f"{name}: first above 1 cm", "s", arrival[0], arrival[1])]
        return [("RMSE of the gauges, of their range", "%", math.fsum(worst) / 3, 0), *result]

    scene = Scene("monai", "water", "Monai Valley tank, three gauges, 22.5 s", 196, 22.5, make, measure, truth="laboratory", step=lambda dx: 0.2 * dx,
                  fields=("surface",), times=(0, *times))
    scene.missing = "WADI_DATA_DIR does not name a folder with monai_valley/Benchmark_2_input.txt" if folder() is None else None
    return scene


def all_scenes():
    return [island(), heap(), wall(), *water_scenes.all_scenes(), monai(), *sand_scenes.all_scenes()]


def make_references(programs, keys, fractions=(2, 4)):
    """Runs the double-precision solver at base step / 4 and, for its own convergence, / 2; keeps the former."""
    REFERENCES.mkdir(exist_ok=True)
    lines = []
    for scene in all_scenes():
        if not scene.sweep or (keys and scene.key not in keys):
            continue
        level = recordings.choose(scene.make(SOLVED_N), water_transport_order=2)
        dx = level["grid"]["dx"]
        names = [name for name, layer in LAYERS if layer in level]
        ends = []
        for fraction in fractions:
            with tempfile.TemporaryDirectory() as scratch:
                file = pathlib.Path(scratch) / "level.json"
                file.write_text(recordings.json.dumps({**level, "dt": scene.step(dx)}))
                subprocess.run([str(programs / "wadi-reference"), str(file), "--dt", str(scene.step(dx) / fraction), "--seconds", str(scene.seconds), "--out", scratch],
                               check=True, stdout=subprocess.DEVNULL)
                ends.append({name: averaged(measures.read_npy(pathlib.Path(scratch) / f"{name}_end.npy")[2], SOLVED_N, SOLVED_N // 2, REFERENCE_N) for name in names})
        for name in names:
            recordings.write_npy(REFERENCES / f"{scene.key}_{name}.npy", REFERENCE_N, REFERENCE_N // 2, ends[-1][name])
        change = {name: math.fsum(abs(a - b) for a, b in zip(ends[0][name], ends[1][name])) / len(ends[1][name]) for name in names}
        span = {name: max(max(ends[-1][name]) - min(ends[-1][name]), 1e-12) for name in names}
        lines.append([scene.key, SOLVED_N, f"{scene.step(dx) / fractions[1]:.3g}", *(f"{name}: {100 * change[name] / span[name]:.4f} %" for name in names)])
        print("reference:", lines[-1], flush=True)
    return lines
