"""Levels as dicts, runs of wadi-recorder and the fields they leave. README.md says how cases use it."""
import concurrent.futures
import copy
import hashlib
import io
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import threading

import numpy as np

# The one place where the values stand that the cases hold the sand to.
RECOMMENDED = {
    "material.slope_normal": 1,
    "material.internal_friction": 0.4,
    "material.sand_viscosity": 0.05,
    "material.retention": 0.4925,
    "method.prestress": True,
}
# Sand that pushes as a fluid does: what most cases must be able to tell from RECOMMENDED.
NEUTRAL = {key: type(value)() for key, value in RECOMMENDED.items()}

# Sand and method of level `piles`, on which the references were made; its cohesion is for water's sake, dry sand has none.
MATERIAL = {
    "friction": 0.5, "young_modulus": 2e5, "cohesion_dry": 0, "cohesion_wet": 8.5e3, "cohesion_capillary": 8.5e3, "exchange_rate": 1e5,
    "diffusion_rate": 0.002,
}
METHOD = {"substeps": 3, "saturation_smoothing": 2, "bulk_viscosity": 0.1}
STEP = 0.09  # dt / dx [s/m], as in `piles`


class RunError(Exception):
    pass


def grid(length, width, dx):
    return {"nx": round(length / dx), "ny": round(width / dx), "dx": dx}


def level(cells, material=None, method=None, **sections):
    """A level on the grid `cells`; maps are arrays in place of files: {"file": array}."""
    return {"format_version": 1, "name": "sand", "grid": cells, "dt": STEP * cells["dx"], "terrain": [], "sand": [],
            "material": {**MATERIAL, **(material or {})}, "method": {**METHOD, **(method or {})}, **sections}


def override(scene, settings):
    """A copy with dotted keys set: {"material.friction": 0.6}. Where a key names no section, the level's root."""
    scene = copy.deepcopy(scene)
    for key, value in settings.items():
        *path, last = key.split(".")
        place = scene
        for name in path:
            place = place.setdefault(name, {})
        place[last] = value
    return scene


def with_files(scene, maps):
    """The scene with arrays and paths replaced by names of files, whose bytes go into `maps`."""
    if isinstance(scene, np.ndarray):
        name = f"map{len(maps)}.npy"
        with io.BytesIO() as text:
            np.save(text, np.ascontiguousarray(scene, dtype="<f8"))
            maps[name] = text.getvalue()
        return name
    if isinstance(scene, pathlib.Path):
        name = f"map{len(maps)}{scene.suffix}"
        maps[name] = scene.read_bytes()
        return name
    if isinstance(scene, dict):
        return {key: with_files(value, maps) for key, value in scene.items()}
    if isinstance(scene, (list, tuple)):
        return [with_files(value, maps) for value in scene]
    return scene


class Run:
    """Fields of a run by the recorder's names at cell centres, velocities too, as doubles; [y, x], row 0 in the south."""

    def __init__(self, folder, cells, times):
        self.folder, self.grid, self.dx, self.times = folder, cells, cells["dx"], times
        self.summary = json.loads((folder / "summary.json").read_text())

    def field(self, name, time):
        return np.load(self.folder / f"{name}_{time:g}.npy").astype(np.float64)


class Lab:
    """Runs levels, as many at once as `jobs` says, and keeps the runs in `work`, named by all that they depend on."""

    def __init__(self, recorder, work, backend="cpu", settings=None, jobs=1):
        self.recorder = pathlib.Path(recorder).resolve()
        if not os.access(self.recorder, os.X_OK) or self.recorder.is_dir():
            raise RunError(f"{recorder}: no program to run")
        self.backend, self.settings = backend, dict(settings or {})
        self.work = pathlib.Path(work)
        self.slots = threading.Semaphore(jobs)
        program = hashlib.sha256(self.recorder.read_bytes())
        for library in sorted((self.recorder.parent.parent / "lib").glob("libwadi.so*")):
            program.update(library.read_bytes())
        self.version = program.hexdigest()

    def variant(self, settings):
        """The same lab with other settings on top of its own."""
        other = copy.copy(self)
        other.settings = {**self.settings, **settings}
        return other

    def run(self, scene, times, fields=("hs",), values=None):
        """Runs a scene to the last of the times and returns its fields at all of them. RECOMMENDED, then the scene's own `values`, then the
        lab's settings are set in it."""
        maps = {}
        text = with_files(override(scene, {**RECOMMENDED, **(values or {}), **self.settings}), maps)
        dump = f"{','.join(fields)}@{','.join(f'{time:g}' for time in times)}"
        arguments = ["--backend", self.backend, "--no-frames", "--seconds", f"{max(times):g}", "--dump", dump]
        if self.backend == "cpu":
            arguments += ["--threads", "1"]
        digest = hashlib.sha256(json.dumps([self.version, text, arguments], sort_keys=True).encode())
        for name in sorted(maps):
            digest.update(maps[name])
        folder = self.work / digest.hexdigest()[:24]
        if not folder.exists():
            with self.slots:
                self.record(text, maps, arguments, folder)
        return Run(folder, scene["grid"], list(times))

    def runs(self, scenes):
        """Several runs side by side: a list of what `run` takes, as tuples or dicts."""
        with concurrent.futures.ThreadPoolExecutor(max(1, len(scenes))) as pool:
            waiting = [pool.submit(self.run, **one) if isinstance(one, dict) else pool.submit(self.run, *one) for one in scenes]
            return [one.result() for one in waiting]

    def record(self, text, maps, arguments, folder):
        self.work.mkdir(parents=True, exist_ok=True)
        # Into a place of its own and then by one rename, so that a run which was cut off is never taken for whole.
        with tempfile.TemporaryDirectory(dir=self.work, prefix="running_") as scratch:
            scratch = pathlib.Path(scratch)
            for name, values in maps.items():
                (scratch / name).write_bytes(values)
            (scratch / "level.json").write_text(json.dumps(text, indent=1))
            out = scratch / "out"
            command = [str(self.recorder), str(scratch / "level.json"), "--any-files", *arguments, "--out", str(out), "--summary", str(out / "summary.json")]
            out.mkdir()
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise RunError(f"{' '.join(command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
            ledger = json.loads((out / "summary.json").read_text())["ledger"]
            if any(ledger[what]["drift_quanta"] != 0 for what in ("water", "sand")):
                raise RunError(f"{' '.join(command)}: mass drifts: {ledger}")
            shutil.copy(scratch / "level.json", out)
            try:
                out.rename(folder)
            except OSError:
                if not folder.exists():  # else someone else was faster with the same run
                    raise
