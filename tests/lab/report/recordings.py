"""Runs of the recorder: of shipped levels, or of levels made in a script, by method preset or with single choices changed."""
import array
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
LEVELS = ROOT / "samples" / "levels"
sys.path.insert(0, str(ROOT / "tests" / "levels"))
import measures  # noqa: E402  fields of a recording and numbers taken from them

PAPER = "paper"  # variant of a shipped level that is the published scene, where the level itself is not


class Failed(Exception):
    """The recorder refused or broke off; the text is what it said."""


class Recorder:
    """One recorder program on one backend; threads: of the CPU backend, 0 = all cores. processor_time: what a summary calls times of steps is
    processor time. Recordings live until the object is closed."""

    def __init__(self, program, backend="cpu", threads=0, processor_time=False):
        self.program, self.backend, self.threads, self.processor_time = str(pathlib.Path(program).resolve()), backend, threads, processor_time
        self.scratch = tempfile.TemporaryDirectory()
        self.numbers = itertools.count(1)  # of folders; threads may record at the same time

    def close(self):
        self.scratch.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def record(self, level, *, method=None, variant=None, accuracy=None, size=None, dt=None, fused=None, seconds=None, times=(), fields=("H", "hs", "W", "surface"),
               pictures=0, profile=False, benchmark=False, files=None, water_scale=None):
        """level: a shipped level's name, or a level as a dict. times [s]: when `fields` are kept. pictures: how many on the contact
        sheet. benchmark: figures of the state are taken at the end only, and no step leaves tiles out.
        files: {name: (nx, ny, values)}, NPY maps beside a level given as a dict. water_scale: depth drawn in deep blue [m]. Returns (measures.Run, the recorder's summary)."""
        folder = pathlib.Path(self.scratch.name) / f"{next(self.numbers):04d}"
        folder.mkdir()
        if isinstance(level, dict):
            where = folder / f"{re.sub(r'[^a-z0-9]+', '_', level.get('name', 'level').lower())}.json"  # which the recorder writes on pictures
            where.write_text(json.dumps(level))  # its maps may be a shipped level's, by whole paths
            for name, (nx, ny, values) in (files or {}).items():
                write_npy(folder / name, nx, ny, values)
        else:
            where = LEVELS / level
            variant = variant or (PAPER if PAPER in json_of(where).get("variants", {}) else None)
        command = [self.program, str(where), "--backend", self.backend, "--threads", str(self.threads), "--out", str(folder), "--summary", str(folder / "summary.json")]
        for key, value in (("method", method), ("variant", variant), ("accuracy", accuracy), ("dt", dt), ("fused-stages", fused), ("seconds", seconds), ("water-scale", water_scale)):
            if value is not None:
                command += [f"--{key}", str(value)]
        if size is not None:
            command += ["--size", "{}x{}".format(*size)]
        if times:
            command += ["--dump", ",".join(fields) + "@" + ",".join(f"{time:g}" for time in times)]
        if pictures:
            command += ["--every", str(seconds / (pictures - 1)), "--jpeg"]
        else:
            command += ["--no-frames", *(["--every", str(seconds)] if benchmark else [])]
        command += ["--any-files"] if isinstance(level, dict) else []
        command += ["--active-tiles", "-1"] if benchmark else []
        command += ["--profile"] if profile else []
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failed(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
        summary = json.loads((folder / "summary.json").read_text())
        if self.processor_time:
            summary["ms_per_step"] *= summary["processor_seconds"] / summary["stepping_seconds"] if summary["stepping_seconds"] else 0
            summary["stepping_seconds"] = summary["processor_seconds"]
        grid = summary["grid"]
        return measures.Run(folder, grid["nx"], grid["ny"], grid["dx"], [float(f"{time:g}") for time in times]), summary


def write_npy(path, nx, ny, values):
    """float32, row 0 in the south. values: any numbers in a row, or 32-bit floats as an array of Python's or numpy's."""
    whole = values if getattr(values, "itemsize", 0) == 4 else array.array("f", values)  # of which a large numpy array is slow to make
    head = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({ny}, {nx}), }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode() + whole.tobytes())


def json_of(folder):
    """A shipped level's file, its // and /* */ comments left out (no string of a level contains them)."""
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or "", (folder / "level.json").read_text(), flags=re.S))


def read_level(name):
    """A shipped level as a dict, as published where it has such a variant; its maps' paths are absolute, so that it can be written
    elsewhere."""
    folder = LEVELS / name

    def absolute(value):
        if isinstance(value, dict):
            return {key: str(folder / inner) if key == "file" else absolute(inner) for key, inner in value.items()}
        return [absolute(inner) for inner in value] if isinstance(value, list) else value

    level = absolute(json_of(folder))
    for key, value in level.get("variants", {}).get(PAPER, {}).items():
        level[key] = {**level[key], **value}
    level.pop("$schema", None)
    return level


def choose(level, **choices):
    """The level with these keys of `method` changed."""
    return {**level, "method": {**level.get("method", {}), **choices}}


def merged(level, changes):
    """The level with these keys changed: within an object each by itself, else whole."""
    return {**level, **{key: {**level.get(key, {}), **value} if isinstance(value, dict) else value for key, value in changes.items()}}
