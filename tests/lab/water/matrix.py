#!/usr/bin/env python3
"""Water at the sides of the world: rivers that leave, gates, tides, waves. README.md says what the rows are.

usage: matrix.py RECORDER [NAME...] [--quick] [--check] [--jobs N] [--work DIR]
NAME: names or patterns of rows ('river/*'); --quick: the rows that ctest runs; --check: exit status 1 where a row misses its limit.
"""
import argparse
import concurrent.futures
import dataclasses
import fnmatch
import math
import pathlib
import sys
import tempfile
from collections.abc import Callable

import numpy as np

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent / "sand"))
import scene  # noqa: E402

G, CHEZY = 9.81, 0.01


@dataclasses.dataclass
class Row:
    name: str
    quick: bool
    measure: Callable  # of a Lab: (what was measured, what is right, how far it may be off)


def level(nx, ny, dx, dt, height=16, order=1, **sections):
    material = {"bed_friction": CHEZY, **sections.pop("material", {})}
    return {"format_version": 1, "name": "water", "grid": {"nx": nx, "ny": ny, "dx": dx}, "dt": dt, "material": material,
            "method": {"largest_height": height, "water_transport_order": order, **sections.pop("method", {})}, **sections}


def along(values, ny=1):
    return [{"file": np.tile(np.asarray(values, dtype=float), (ny, 1))}]


# Rivers

def beds():
    """name: (bed over 100 cells, fall that leaves, normal depth over that in the middle)."""
    x = np.arange(100) + 0.5
    even = 1 - 1e-3 * x
    noise = np.random.default_rng(5).uniform(-1, 1, 100)
    found = {f"even_{fall:g}": (1 - fall * x, fall, 1) for fall in (4e-4, 1e-3, 5e-3, 2e-2, 4e-2)}
    for high in (2, 5, 10):
        found[f"sill_{high}cm"] = (even + np.where(x > 99, high / 100, 0), 1e-3, 1)
    found["ends_level"] = (1 - 1e-3 * np.minimum(x, 90), 1e-3, 1)
    found["all_level"] = (0 * x, 1e-3, 1.05)  # the ground beyond falls by 1e-3: backwater over 50 m
    found["noise_1cm"] = (even + 0.01 * noise, 1e-3, 1)
    found["noise_5cm"] = (1 - 5e-3 * x + 0.05 * noise, 5e-3, 1.07)
    found["step_down"] = (even - np.where(x > 98, 0.05, 0), 1e-3, None)  # critical above the step or drowned: nothing dams
    return found


def river(name, start, order, seconds, slope=0.0):
    bed, fall, ratio = beds()[name]
    normal = (CHEZY / (G * fall)) ** (1 / 3)  # of 1 m2/s
    deepest = {"normal": normal, "dry": normal, "drowned": 2 * normal + np.ptp(bed)}[start]
    depth = {"normal": 0 * bed + normal, "dry": 0 * bed, "drowned": 2 * normal + bed.max() - bed}[start]
    out = {"kind": "outflow", **({"slope": slope} if slope else {})}
    sections = {"velocities": [{"of": "water", "shape": "plane", "velocity": [1 / normal, 0]}]} if start == "normal" else {}
    shoots = 1 / normal > math.sqrt(G * normal)
    one = level(100, 1, 1, 0.35 / (math.sqrt(G * deepest) + 1 / normal), order=order, terrain=along(bed - bed.min()), water=along(depth),
                sides={"west": {"kind": "discharge", "value": 1, **({"depth": round(normal, 6)} if shoots else {})}, "east": out}, **sections)

    def measure(lab):
        h = lab.run(one, [seconds], ("W",), values={}).field("W", seconds)[0]
        return h[50] / normal, ratio or 0.86, 0.03 if ratio else 0.15
    return measure


def oblique(degrees, order):
    """A valley with slopes of 0.1 to both sides, bed falling by 0.01, turned by an angle; 8 m3/s from a point."""
    n, seconds, angle = 60, 600, math.radians(degrees)

    def one():
        x, y = np.meshgrid(np.arange(n) + 0.5 - n / 2, np.arange(n) + 0.5 - n / 2)
        run, off = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
        ground = 0.1 * np.sqrt(off ** 2 + 1) - 0.01 * run
        source = [n / 2 - 26 * math.cos(angle), n / 2 - 26 * math.sin(angle)]
        sides = {"east": {"kind": "outflow"}, **({"north": {"kind": "outflow"}} if degrees > 30 else {})}
        return level(n, n, 1, 0.04, order=order, terrain=[{"file": ground - ground.min()}], sides=sides,
                     sources=[{"shape": "disc", "center": source, "radius": 2, "discharge": 8.0}], material={"bed_friction": 0, "manning": 0.03})

    def measure(lab):
        h = lab.run(one(), [seconds], ("W",), values={}).field("W", seconds)
        x, y = np.meshgrid(np.arange(n) + 0.5 - n / 2, np.arange(n) + 0.5 - n / 2)
        run, off = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
        end = (n / 2 - 1) / math.cos(angle) if degrees <= 45 else 0
        near_side = h[(np.abs(off) < 6) & (run > end - 7) & (run < end - 4)].max()
        return near_side / h[(np.abs(off) < 6) & (np.abs(run) < 3)].max(), 1, 0.05
    return measure


# Gates, tides, waves

def gate(sea, order):
    """Discharge of a tank 1 m deep into a sea, from 5 to 10 s, over that of Riemann's invariants (into the tank: of a bore)."""
    one = level(200, 1, 0.5, 0.02, order=order, water=[{"shape": "plane", "height": 1}], material={"bed_friction": 0},
                sides={"east": {"kind": "brink"} if sea is None else {"kind": "level", "value": sea}})

    def measure(lab):
        run = lab.run(one, [5, 10], ("W",), values={})
        flow = (run.field("W", 5) - run.field("W", 10)).sum() * 0.5 / 5
        deep = max(sea or 0, 4 / 9)
        exact = deep * 2 * (math.sqrt(G) - math.sqrt(G * deep)) if deep < 1 else -sea * (sea - 1) * math.sqrt(G * (sea + 1) / (2 * sea))
        return flow / exact, 1, 0.05 if sea is None or sea < 0.4 else 0.01
    return measure


def tide(periods, order):
    """Half the range of a tide at the mouth of a basin 200 m long and 2 m deep, over the sea's; periods in lengths over a wave's speed."""
    period = periods * 200 / math.sqrt(G * 2)
    series = [[n * period / 100, 2 + 0.1 * (1 - math.cos(2 * math.pi * n / 100))] for n in range(301)]
    one = level(50, 1, 4, 0.2, order=order, water=[{"shape": "plane", "height": 2}], sides={"east": {"kind": "level", "value": series}})
    times = [round(period * (2 + n / 20), 3) for n in range(20)]

    def measure(lab):
        run = lab.run(one, times, ("W",), values={})
        high = [run.field("W", t)[0, -1] for t in times]
        wave = 2 * math.pi / (periods * 200)  # a standing wave, held half a cell outside the grid
        return (max(high) - min(high)) / 0.2, math.cos(wave * 198) / math.cos(wave * 202), 0.03
    return measure


def pulse(kind, froude, order, sign=1):
    """Share of a hump of 2 cm that comes back in a stream in balance with its bed, against a channel three times as long."""
    drag, speed = 0.02, froude * math.sqrt(G)

    def one(times):
        x = (np.arange(200 * times) + 0.5) * 0.5
        bed = drag * froude ** 2 * (310 - x)
        hump = 0.02 * sign * np.exp(-((x - 50) / 4) ** 2 / 2)
        sides = {"west": {"kind": "discharge", "value": speed * 0.5}} if froude else {}
        still = drag * froude ** 2 * (310 - 99.75) + 1
        if times == 1:
            sides["east"] = {"kind": kind, **({"value": still} if kind in ("waves", "level") else {})}
        velocity = np.vstack([speed + math.sqrt(G) * hump])
        return level(200 * times, 1, 0.5, 0.05, order=order, terrain=along(bed), water=along(1 + hump), sides=sides,
                     velocities=[{"of": "water", "component": "x", "file": velocity}], material={"bed_friction": drag if froude else 0},
                     method={"rest_rule": False})

    def measure(lab):
        c = math.sqrt(G)
        seconds = round(50 / (c * (1 + froude)) + 40 / (c * (1 - froude)), 2)
        short, long = (lab.run(one(times), [seconds], ("W",), values={}).field("W", seconds)[0, :200] for times in (1, 3))
        back = np.abs(short - long).max() / 0.02
        if kind == "level":
            return back, 1, 0.1
        return back, 0, 0.03 if order == 1 else 0.04
    return measure


def bump(start, order):
    """SWASHES' transcritical flow over a bump, no jump: mean difference to the right depth behind it."""
    n, length, q = 100, 25.0, 1.53
    x = (np.arange(n) + 0.5) * length / n
    bed = np.maximum(0.2 - 0.05 * (x - 10) ** 2, 0)
    critical = (q * q / G) ** (1 / 3)
    head = 0.2 + 1.5 * critical

    def depth(z):
        roots = np.roots([1, z - head, 0, q * q / (2 * G)])
        return sorted(r.real for r in roots if abs(r.imag) < 1e-9 and r.real > 0)
    right = np.array([depth(z)[-1 if at < 10 else 0] for at, z in zip(x, bed)])
    water = {"lake": np.maximum(0.66 - bed, 0), "dry": 0 * bed, "right": right}[start]
    one = level(n, 1, length / n, 0.04 * length / n, order=order, terrain=along(bed), water=along(water), material={"bed_friction": 0},
                sides={"west": {"kind": "discharge", "value": q * length / n}, "east": {"kind": "outflow"}})

    def measure(lab):
        h = lab.run(one, [200], ("W",), values={}).field("W", 200)[0]
        behind = x > 13
        return float((h[behind] / right[behind]).mean()), 1, 0.07 if order == 1 else 0.01
    return measure


def hump(cells, order):
    """What half of a hump of 5 cm, so many cells from its middle to where it is 1/e, keeps of its height over 150 m with a stream of 1 m/s."""
    n = 240
    x = np.arange(n) + 0.5
    one = level(n, 1, 1, 0.06, order=order, water=along(1 + 0.05 * np.exp(-((x - 40) / cells) ** 2)), material={"bed_friction": 0},
                velocities=[{"of": "water", "shape": "plane", "velocity": [1, 0]}], sides={"west": {"kind": "discharge", "value": 1}, "east": {"kind": "outflow"}})
    seconds = round(150 / (1 + math.sqrt(G)), 2)

    def measure(lab):
        h = lab.run(one, [seconds], ("W",), values={}).field("W", seconds)[0]
        return float(h[100:].max() - 1) / 0.025, 1, 0.1
    return measure


# Thin water: how high a column may be sets the quantum, which must not matter

def film(height, dt, seconds=3600):
    """What is left of 2 cm on 208 m of ground that falls by 0.05, over the kinematic wave's (h = (3 n x / (5 sqrt(S) t))^1.5 behind the fan)."""
    n, slope, manning = 104, 0.05, 0.03
    x = (np.arange(n) + 0.5) * 2
    one = level(n, 4, 2, dt, height=height, terrain=along(slope * (x[-1] - x), 4), water=along(0 * x + 0.02, 4),
                sides={"east": {"kind": "outflow"}}, material={"bed_friction": 0, "manning": manning})

    def measure(lab):
        left = 2 * lab.run(one, [seconds], ("W",), values={}).field("W", seconds)[1].sum()
        fine = (np.arange(20800) + 0.5) / 100
        right = 0.01 * np.minimum((3 * manning * fine / (5 * math.sqrt(slope) * seconds)) ** 1.5, 0.02).sum()
        return left / right, 1, 0.15
    return measure


def rain(height, degrees=0):
    """Depth under 50 mm/h on ground that falls by 0.05, 100 m down, over Manning's."""
    slope, manning, fall, angle = 0.05, 0.03, 0.05 / 3600, math.radians(degrees)
    n = 100 if degrees == 0 else 160
    x, y = np.meshgrid(np.arange(n) + 0.5, np.arange(4 if degrees == 0 else n) + 0.5)
    down = x * math.cos(angle) + y * math.sin(angle)
    one = level(n, x.shape[0], 1, 0.04, height=height, terrain=[{"file": slope * (down.max() - down)}], rain=fall,
                sides={"east": {"kind": "outflow"}, **({"north": {"kind": "outflow"}} if degrees else {})},
                material={"bed_friction": 0, "manning": manning})

    def measure(lab):
        h = lab.run(one, [900], ("W",), values={}).field("W", 900)
        if degrees == 0:
            run, depth = x[1, 80:95], h[1, 80:95]
        else:  # along the diagonal from the corner, where both rims are as far
            run = np.array([down[at, at] - down[0, 0] for at in range(60, 70)])
            depth = np.array([h[at, at] for at in range(60, 70)])
        return float((depth / (fall * run * manning / math.sqrt(slope)) ** 0.6).mean()), 1, 0.03
    return measure


def macdonald(n, order):
    """Mean error of the depth of a steady stream that gains 1 mm/s of rain over 1000 m, as a share; the bed is what that depth needs (after
    MacDonald et al. 1997). What comes down brings no momentum: with the stream's it would be off
    by 0.02."""
    length, fall, begin = 1000.0, 1e-3, 1.0
    at = np.linspace(0, length, 100001)
    depth = 1 + 0.5 * np.exp(-16 * (at / length - 0.5) ** 2)
    flow = begin + fall * at
    slope = -np.gradient(flow ** 2 / depth, at) / (G * depth) - np.gradient(depth, at) - CHEZY * flow ** 2 / (G * depth ** 3)
    bed = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(at))])
    dx = length / n
    x = (np.arange(n) + 0.5) * dx
    ground, right = np.interp(x, at, bed - bed.min()), np.interp(x, at, depth)
    one = level(n, 1, dx, 0.3 * dx / 6, order=order, terrain=along(ground), water=along(right), rain=fall,
                velocities=[{"of": "water", "shape": "plane", "velocity": [1, 0]}],
                sides={"west": {"kind": "discharge", "value": begin * dx}, "east": {"kind": "level", "value": float(bed[-1] - bed.min() + depth[-1])}})

    def measure(lab):
        h = lab.run(one, [3000], ("W",), values={}).field("W", 3000)[0]
        return float(np.abs(h / right - 1).mean()), 0, {1: {50: 0.008, 200: 0.003}, 2: {50: 0.004, 200: 0.002}}[order][n]
    return measure


def seepage(height):
    """How far the middle of 0.2 m of water in 0.3 m of sand gets in 120 s on ground that falls by 0.05, over 0.01946 m, which it does without quanta
    (`quantum` 0, at 16 and at 4096 m)."""
    x = (np.arange(60) + 0.5) * 0.1
    one = level(60, 1, 0.1, 0.005, height=height, terrain=along(0.05 * (6 - x)), sand=along(0 * x + 0.3), water=along(np.where((x > 2) & (x < 4), 0.2, 0)),
                material={"friction": 0.7, "exchange_rate": 1e5, "diffusion_rate": 0})

    def measure(lab):
        run = lab.run(one, [0, 120], ("W",), values={})
        middle = [(run.field("W", t)[0] * x).sum() / run.field("W", t)[0].sum() for t in (0, 120)]
        return (middle[1] - middle[0]) / 0.01946, 1, 0.03
    return measure


def channel(degrees, cells=4, order=1):
    """Depth in the middle of a channel so many cells wide between upright banks, over the normal depth of 0.5 m2/s; S 0.002. Its width is that
    which its cells have: along the diagonal three or five of them stand in a row."""
    n, slope, manning, flow, angle = 120 if degrees else 200, 0.002, 0.03, 0.5, math.radians(degrees)
    x, y = np.meshgrid(np.arange(n) + 0.5, np.arange(n if degrees else 6) + 0.5)
    if degrees:
        run, off = (x - 2) * math.cos(angle) + (y - 2) * math.sin(angle), (y - 2) * math.cos(angle) - (x - 2) * math.sin(angle)
    else:
        run, off = x, y - 3
    bed = slope * (run.max() - run)
    wet = np.abs(off) < cells / 2
    middle = wet & (np.abs(run - run[wet].max() / 2) < 15)
    width = middle.sum() / 30
    spring = [[6 * math.cos(angle) + 2, 6 * math.sin(angle) + 2], [6, 3]][degrees == 0]
    sides = {"east": {"kind": "outflow"}, **({"north": {"kind": "outflow"}} if degrees > 30 else {})}
    one = level(n, x.shape[0], 1, 0.05, order=order, terrain=[{"file": np.where(wet, bed, bed + 10)}], sides=sides, height=32,
                sources=[{"shape": "disc", "center": spring, "radius": cells / 2, "discharge": width * flow}], material={"bed_friction": 0, "manning": manning})

    def measure(lab):
        h = lab.run(one, [900], ("W",), values={}).field("W", 900)
        return float(h[middle].mean()) / (manning * flow / math.sqrt(slope)) ** 0.6, 1, 0.25 if cells > 2 else 0.5
    return measure


def rows():
    found = [Row(f"channel/{cells}_cells/{degrees:g}/order_{order}", False, channel(degrees, cells, order))
             for cells in (2, 4) for degrees in (0, 10, 22.5, 35, 45) for order in (1, 2)]
    for height in (16, 256, 1024, 4096):
        for dt in (0.01, 0.05, 0.2):
            found.append(Row(f"film/{height}/dt_{dt:g}", (height, dt) == (1024, 0.2), film(height, dt)))
        found.append(Row(f"rain/{height}", height == 4096, rain(height)))
        found.append(Row(f"seepage/{height}", height == 4096, seepage(height)))
    found.append(Row("rain/4096/turned_45", False, rain(4096, 45)))
    for order in (1, 2):
        for bed in beds():
            for start in ("normal", "dry", "drowned"):
                given = 4e-4 if bed == "even_0.0004" else 0.0
                quick = order == 1 and bed in ("even_0.001", "sill_10cm") and start == "drowned"
                for seconds in (1000, 3000):
                    found.append(Row(f"river/{bed}/{start}/order_{order}/{seconds}s", quick and seconds == 1000, river(bed, start, order, seconds, given)))
        for degrees in (0, 10, 22.5, 45):
            found.append(Row(f"oblique/{degrees:g}/order_{order}", False, oblique(degrees, order)))
        for sea in (None, 0.2, 0.45, 0.6, 0.8, 0.95, 1.2):
            found.append(Row(f"gate/{'brink' if sea is None else sea}/order_{order}", order == 1 and sea in (None, 0.8), gate(sea, order)))
        for periods in (5, 9, 18, 44, 100):
            found.append(Row(f"tide/{periods}/order_{order}", order == 1 and periods == 18, tide(periods, order)))
        for kind, froude in (("outflow", 0), ("outflow", 0.3), ("outflow", 0.6), ("outflow", 1.5), ("waves", 0), ("waves", 0.3), ("waves", 0.6), ("level", 0)):
            if froude < 1:
                found.append(Row(f"pulse/{kind}/{froude:g}/order_{order}", order == 1 and froude == 0.3, pulse(kind, froude, order)))
        for cells in (5, 10, 20):
            found.append(Row(f"hump/{cells}_cells/order_{order}", False, hump(cells, order)))
        for n in (50, 200):
            found.append(Row(f"macdonald/{n}/order_{order}", order == 1 and n == 50, macdonald(n, order)))
        for start in ("lake", "dry", "right"):
            found.append(Row(f"bump/{start}/order_{order}", False, bump(start, order)))
    return found


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("recorder")
    options.add_argument("names", nargs="*")
    options.add_argument("--quick", action="store_true")
    options.add_argument("--check", action="store_true")
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--work")
    given = options.parse_args()
    chosen = [row for row in rows() if (row.quick or not given.quick) and (not given.names or any(fnmatch.fnmatch(row.name, n) for n in given.names))]
    if not chosen:
        sys.exit("no row has such a name")
    missed = 0
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        lab = scene.Lab(given.recorder, given.work or scratch, jobs=given.jobs)
        print("| row | measured | right | |\n| --- | ---: | ---: | --- |")
        for row, (value, right, most) in zip(chosen, pool.map(lambda row: row.measure(lab), chosen)):
            good = abs(value - right) <= most
            missed += not good
            print(f"| {row.name} | {value:.3f} | {right:g} +- {most:g} | {'' if good else 'MISS'} |", flush=True)
    print(f"{len(chosen)} rows, {missed} missed")
    return 1 if given.check and missed else 0


if __name__ == "__main__":
    sys.exit(main())
