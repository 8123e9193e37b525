"""Baked frames on disk: a folder with wadi.json and frame_00000.npz, frame_00001.npz ... Needs NumPy alone."""
import io
import json
import os
import pathlib
import zipfile

import numpy as np

FORMAT = 1
ABOUT = "wadi.json"


class CacheError(Exception):
    """What is wrong with a cache's folder; the message names it."""


def _frame(folder, number):
    return pathlib.Path(folder) / f"frame_{number:05}.npz"


def _write(path, data):
    """Whole or not at all."""
    beside = path.with_name(path.name + ".new")
    beside.write_bytes(data)
    os.replace(beside, path)


class Writer:
    """Makes the folder, or takes the frames of an earlier bake out of it. about: what `Reader.about` gives back; "frames" is kept here."""

    def __init__(self, folder, about):
        self.folder, self._about = pathlib.Path(folder), {"format": FORMAT, **about, "frames": 0}
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            strange = [file.name for file in self.folder.iterdir() if file.name != ABOUT and not file.match("frame_*.npz*")]
            if strange:
                raise CacheError(f"cache: {self.folder} holds {strange[0]}, which no bake wrote; name a folder of its own")
            for file in self.folder.glob("frame_*.npz*"):
                file.unlink()
            self._tell()
        except OSError as failed:
            raise CacheError(f"cache: {failed}") from failed

    def _tell(self):
        _write(self.folder / ABOUT, json.dumps(self._about, indent=1).encode())

    def add(self, planes, **about):
        """Adds a frame: arrays by name, of shape (ny, nx) or (ny, nx, n)."""
        try:
            data = io.BytesIO()
            with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as packed:
                for name, plane in planes.items():
                    with packed.open(f"{name}.npy", "w") as member:
                        np.lib.format.write_array(member, np.ascontiguousarray(plane))
            _write(_frame(self.folder, self._about["frames"]), data.getvalue())
            self._about = {**self._about, **about, "frames": self._about["frames"] + 1}
            self._tell()
        except OSError as failed:
            raise CacheError(f"cache: {failed}") from failed


class Reader:
    """A folder that a Writer has filled. about: what is known of the bake: nx, ny, dx, origin, fps, frames ..."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        try:
            self.about = json.loads((self.folder / ABOUT).read_bytes())
        except (OSError, ValueError) as failed:
            raise CacheError(f"cache: {self.folder} has no baked frames: {failed}") from failed
        if self.about.get("format") != FORMAT:
            raise CacheError(f"cache: {self.folder} has format {self.about.get('format')!r}, this add-on reads {FORMAT}: bake again")
        if self.about["frames"] < 1:
            raise CacheError(f"cache: {self.folder} has no frames")

    def frame(self, number):
        """A frame's arrays by name; the first or the last one outside."""
        file = _frame(self.folder, min(max(number, 0), self.about["frames"] - 1))
        try:
            with np.load(file) as packed:
                return {name: packed[name] for name in packed.files}
        except (OSError, ValueError, zipfile.BadZipFile) as failed:
            raise CacheError(f"cache: {file}: {failed}") from failed
