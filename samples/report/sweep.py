"""The points that a report measures: a scene at a size, time step, T and method, named so that one command repeats it."""
import json
import math

import recordings

# What `method` is changed by, by the name in a point.
CHOICES = {
    "robust": {},
    "published": {"name": "published"},
    "second_order": {"water_transport_order": 2},
    "second_order_sand": {"water_transport_order": 2, "sand_transport_order": 2},
    "no_limiter": {"outflow_limiter": False},
    "no_quantum": {"quantum": 0},
    "no_gravity_caps": {"gravity_cap": 0, "sand_gravity_cap": 0},
    "no_elastic_cap": {"elastic_cap": 0},
    "no_rest_rule": {"rest_rule": False},
    "no_shock_viscosity": {"shock_viscosity": 0},
    "no_passive_pressure": {"passive_pressure": 0},
    "no_smoothing": {"saturation_smoothing": 0},
}
GUARDS = [choice for choice in CHOICES if choice.startswith("no_")]
METHODS = [choice for choice in CHOICES if not choice.startswith("no_")]
EFFECTS = ("elastoplastic", "cohesion", "drag", "diffusion", "mixture")
NEEDED_BY = {"elastoplastic": "cohesion", "mixture": "diffusion"}  # what needs an effect goes with it
CHOICES_OF = {"water": ("robust", "published", "second_order"),
              "dry sand": ("robust", "published", "second_order_sand"),
              "wet sand": tuple(METHODS)}  # what a kind of scene has something of to show
STEPS = (0.25, 0.5, 1, 2, 4)
RATIOS = (1, 2, 3, 4, 6)


class Point:
    """off: an effect that the level forces off."""

    def __init__(self, scene, n, dt=1, ratio=3, choice="robust", off=""):
        self.scene, self.n, self.dt, self.ratio, self.choice, self.off = scene, n, dt, ratio, choice, off

    def name(self):
        return f"{self.scene}@n{self.n},dt{self.dt:g},T{self.ratio},{self.choice}" + (f",{self.off}=off" if self.off else "")


def parse(text):
    """The inverse of Point.name(); ValueError with what is wrong."""
    try:
        scene, rest = text.split("@")
        parts = rest.split(",")
        point = Point(scene, int(parts[0].removeprefix("n")), float(parts[1].removeprefix("dt")), int(parts[2].removeprefix("T")), parts[3],
                      parts[4].removesuffix("=off") if len(parts) > 4 else "")
    except (ValueError, IndexError):
        raise ValueError(f"point \"{text}\": want SCENE@nCELLS,dtFACTOR,TRATIO,CHOICE[,EFFECT=off]") from None
    if point.choice not in CHOICES:
        raise ValueError(f"point \"{text}\": no choice \"{point.choice}\"; known are {', '.join(CHOICES)}")
    if point.off and point.off not in EFFECTS:
        raise ValueError(f"point \"{text}\": no effect \"{point.off}\"; known are {', '.join(EFFECTS)}")
    return point


def points_of(scene, quick):
    """Without order or repetition of meaning: the caller drops doubles."""
    sand, wet = scene.kind != "water", scene.kind != "dry sand"
    if scene.sweep:
        preset_sizes = (scene.n // 4, scene.n // 2, scene.n)
        sizes = preset_sizes if not quick else preset_sizes[:2]
        for n in sizes:
            for dt in (1, 2) if quick else STEPS:
                for ratio in ((1, 3) if quick else RATIOS) if sand else (3,):
                    yield Point(scene.key, n, dt, ratio)
        for n in preset_sizes:
            for choice in ("robust", "second_order") if wet else ("robust",):
                for dt in (1, 2) if quick else (0.5, 1, 2):
                    for ratio in (2, 3) if sand else (3,):
                        yield Point(scene.key, n, dt, ratio, choice)
        for choice in [c for c in CHOICES_OF[scene.kind] if not quick or c in ("robust", "published", "second_order")]:
            yield Point(scene.key, sizes[-1], 1, 3, choice)
            yield Point(scene.key, sizes[-1], 0.25, 3, choice)
    else:
        sizes = [scene.n // 4, scene.n // 2, scene.n] + [n for n in (2 * scene.n,) if not quick and n <= scene.most]
        if scene.key == "monai":
            sizes = [scene.n // 2] if quick else [scene.n // 2, scene.n, 2 * scene.n - 1]
        for n in sizes:
            for choice in ("robust", "second_order", "published") if scene.key != "monai" or not quick else ("robust", "second_order"):
                if choice != "second_order" or wet:
                    yield Point(scene.key, n, 1, 3, choice)
        for dt in () if quick else (0.5, 2):
            yield Point(scene.key, scene.n, dt)


def forced_off(effect):
    """A level's `effects` without this one."""
    return {name: "off" for name in (effect, NEEDED_BY.get(effect)) if name}


def level_of(scene, point):
    level = scene.make(point.n)
    level["dt"] = point.dt * scene.step(level["grid"]["dx"])
    level = recordings.choose(level, substeps=point.ratio, **CHOICES[point.choice])
    if point.off:
        level["effects"] = {**level.get("effects", {}), **forced_off(point.off)}
    return level


def measure(recorder, scene, point, repeats):
    """A point's row: error, other measures, time. A refused level gives its message as `failed`."""
    level = level_of(scene, point)
    row = {"point": point.name(), "scene": scene.key, "kind": scene.kind, "truth": scene.truth, "n": point.n, "dt_factor": point.dt, "dt": level["dt"], "T": point.ratio,
           "choice": point.choice, "off": point.off}
    try:
        recorded = [recorder.record(level, seconds=scene.seconds, times=scene.times, fields=scene.fields,
                                    files=scene.files(point.n) if scene.files else None) for _ in range(repeats)]
    except recordings.Failed as failure:
        return {**row, "failed": str(failure).strip().splitlines()[-1]}
    run, summary = recorded[0]
    seconds = min(other["stepping_seconds"] for _, other in recorded)
    measures = scene.measure(run, summary, level)
    finite = summary["counts"]["not_finite"]["largest"] == 0 and math.isfinite(measures[0][2])
    return {**row, "backend": summary["device"]["backend"], "device": summary["device"]["name"], "dx": summary["grid"]["dx"], "ny": summary["grid"]["ny"],
            "steps": summary["steps"], "ms_per_step": 1000 * seconds / max(summary["steps"], 1), "ms_per_second": 1000 * seconds / summary["simulated_seconds"],
            "passes": summary["passes"]["per_step"], "bytes_per_cell": summary["bytes_per_cell"],
            "drift": max((abs(entry["relative_drift"]) if entry["drift_quanta"] else 0) for entry in (summary["ledger"]["water"], summary["ledger"]["sand"])),
            "error": measures[0][2] if finite else None, "measures": measures}


class Store:
    """Rows by point in a file of JSON lines: a report that was broken off goes on where it stopped."""

    def __init__(self, path, stamp):
        self.path, self.stamp, self.rows = path, stamp, {}
        self.gap = ""
        if path.exists():
            self.gap = "" if path.read_text().endswith("\n") else "\n"
            for line in path.read_text().splitlines():
                try:
                    row = json.loads(line)
                except json.JSONDecodeError:
                    continue  # broken off in mid-line
                if row.get("stamp") == stamp:
                    self.rows[row["point"]] = row

    def add(self, row):
        self.rows[row["point"]] = row
        with self.path.open("a") as file:
            file.write(self.gap + json.dumps({**row, "stamp": self.stamp}) + "\n")
        self.gap = ""


def frontier(rows):
    """Of rows with an error: those that no other beats in both error and time, by time."""
    best, result = math.inf, []
    for row in sorted((r for r in rows if r.get("error") is not None), key=lambda r: (r["ms_per_second"], r["error"])):
        if row["error"] < best:
            best = row["error"]
            result.append(row)
    return result
