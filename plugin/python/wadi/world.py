"""A world of sand and water."""
from __future__ import annotations

import ctypes
import json
import logging
import math
import os
import time as clock
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from ctypes import byref, c_double, c_uint64
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _library, _native
from ._library import BadArgumentError, check, encoded, error, native
from ._native import ActiveTiles, Choice, Field, LogLevel, Output, Region
from ._struct import member, whole
from .output import bits_of
from .recording import Recording, progress_bar
from .world_edits import Edits
from .world_outputs import Outputs
from .world_saves import Saves

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import Bar, Files, Pair, StrPath
    from .output import OutputView

_log = logging.getLogger("wadi")
_LOGGED = {LogLevel.ERROR: logging.ERROR, LogLevel.WARNING: logging.WARNING, LogLevel.INFORMATION: logging.INFO}


class _Handle:
    """Owns a world of the library: it is destroyed once nobody holds this, views of its memory included."""

    views: weakref.WeakSet[OutputView]

    def __init__(self, world: _native.WorldId, callbacks: tuple[Any, ...]) -> None:
        self.world = world
        self.views = weakref.WeakSet()
        weakref.finalize(self, _Handle.destroy, world, callbacks)

    @staticmethod
    def destroy(world: _native.WorldId, callbacks: tuple[Any, ...]) -> None:
        native.wadi_destroy_world(world)
        del callbacks  # they may be called until here


def _switch(value: bool | None) -> Choice:
    """off, on, or as the level says"""
    return Choice.LEVEL if value is None else Choice.ON if value else Choice.OFF


def _overrides(given: dict[str, Any]) -> _native.LevelOverrides:
    """wadi_level_overrides from keywords that are not None."""
    fields = {name: value for name, value in given.items() if value is not None}
    if "active_tiles" in fields:
        value = fields["active_tiles"]
        fields["active_tiles"] = ActiveTiles.OFF if value is False else member(ActiveTiles, value, "active_tiles")
    if "fused_stages" in fields:
        fields["fused_stages"] = _switch(fields["fused_stages"])
    if "draws" in fields:
        fields["draws"] = bits_of(fields["draws"], "draws")
    return _native.LevelOverrides(**fields)


class _Reader:
    """Files that a level's text names, from a folder, a mapping or a function; what goes wrong there is kept for the caller."""

    def __init__(self, files: Files | None) -> None:
        self.thrown: BaseException | None = None
        if files is None:
            self.callback = _native.ReadFileCallback()
            return
        if isinstance(files, (str, os.PathLike)):
            folder = os.fspath(files)

            def read(name: str) -> bytes | None:
                file = os.path.join(folder, name)
                if not os.path.isfile(file):
                    return None
                with open(file, "rb") as opened:
                    return opened.read()
        else:
            read = files.get if isinstance(files, Mapping) else files  # type: ignore[assignment]

        def called(_: Any, name: bytes, data: int, size: Any) -> int:
            try:
                found = read(name.decode("utf-8", "surrogateescape"))
                if found is None:
                    return 0
                found = bytes(found)
                if data:
                    if len(found) > size[0]:
                        raise BadArgumentError("files: a file has grown between two reads")
                    ctypes.memmove(data, found, len(found))
                size[0] = len(found)
                return 1
            except BaseException as thrown:  # told by the caller: nothing may leave a callback
                self.thrown = thrown
                return 0

        self.callback = _native.ReadFileCallback(called)

    def check(self, result: int) -> None:
        if self.thrown is not None:
            raise self.thrown
        check(result)


def _settings_text(settings: object, what: str) -> str:
    if isinstance(settings, str):
        return settings
    if isinstance(settings, Mapping):
        return json.dumps(settings)
    raise TypeError(f"{what}: a level is a text or a dict, not {type(settings).__name__}")


def level_cost(level: StrPath | None = None, *, text: str | Mapping[str, Any] | None = None, files: Files | None = None,
               **overrides: Any) -> _native.Cost:
    """What a world of that level would cost, as wadi.Cost: nothing is drawn and no device is opened.
    Arguments as those of World of the same names, overrides included."""
    cost = _native.Cost()
    raw = _overrides(overrides)
    if (level is None) == (text is None):
        raise TypeError("level_cost takes a level's file or text=")
    if level is not None:
        check(native.wadi_get_level_cost(encoded(level, "level"), byref(raw), byref(cost)))
    else:
        reader = _Reader(files)
        reader.check(native.wadi_get_level_text_cost(encoded(_settings_text(text, "text"), "text"), reader.callback, None, byref(raw), byref(cost)))
    return cost


class World(Outputs, Edits, Saves):
    """Sand, water and wet sand on a grid of square cells. Close it, or use it in a `with`; one that is forgotten is closed, too.

    It is made from one of three things:
      level     path of a level file (.json) or a terrain map (.png, .r16, .r32, .raw, .hgt, .npy, .asc); wadi.levels() has some
      text      text of a level, or the same as a dict. `files` is what it may name: a folder, a dict of bytes by name, or a function
                that takes a name and returns bytes or None
      arrays    of shape (ny, nx), row 0 in the south, column 0 in the west, with the cell size `dx` [m]:
                terrain     elevation of the ground [m]; all arrays that are missing are 0
                sand        depth of sand [m]
                water       depth of all water, above the sand and inside it [m]
                velocity    of the water, east and north [m/s]: a pair of arrays
                roughness   what cells add to material.manning, 0 ... 1 [s/m^(1/3)]
                rain_map    how many times the settings' rain falls on each cell, 0 ... 100
                settings    the rest of a level, as text or dict ({"material": {"friction": 0.6}, "sides": ...}), without "grid"
                dt          water time step [s]; None = a fifth of the time that a wave needs to cross a cell at the highest column
                name        of the world
    Overrides for levels and texts (None = as the level says): nx, ny [cells], dt [s], method ("robust", "published"), variant, accuracy
    ("draft", "balanced", "accurate", "fine"), active_tiles (False, "auto", "cheap", 8, 16, 32, 64), fused_stages (True, False), any_files
    (True = maps may lie outside the level's folder), draws (some of "foam", "wetness", "silt": what will be drawn of what water carries and leaves).
    Where it runs: backend ("auto", "cpu", "vulkan", "cuda"), device (index of wadi.devices(), -1 = the best), threads (0 = all cores),
    validate (Vulkan's validation layers).
    log is a function of (wadi.LogLevel, text), called from any thread, which may not call the library; None = Python's logger "wadi",
    False = nothing is told. progress is a function of a share 0 ... 1 that returns False to end the making (CancelledError).
    most is a wadi.Cost with limits of your own: what a level, a snapshot or a log asks for beyond is a BadFileError.

    Errors: NotFoundError, BadFileError, BadArgumentError, OutOfMemoryError, NotSupportedError; TypeError and ValueError for arguments that
    do not fit together. A world is used by one thread at a time: another one meets BusyError.
    """

    #: Of the library; null once the world is closed.
    id: _native.WorldId
    #: Cells along x (east) and y (north).
    nx: int
    ny: int
    #: Width of a cell [m].
    dx: float
    #: Water time step [s].
    dt: float
    #: "cpu", "vulkan" or "cuda".
    backend: str
    #: Map coordinates of the grid's south-west corner [m]; (0, 0) without a map.
    origin: tuple[float, float]
    name: str

    def __init__(self, level: StrPath | None = None, *, text: str | Mapping[str, Any] | None = None, files: Files | None = None,
                 terrain: ArrayLike | None = None, sand: ArrayLike | None = None, water: ArrayLike | None = None,
                 velocity: Sequence[ArrayLike] | NDArray[Any] | None = None, roughness: ArrayLike | None = None,
                 rain_map: ArrayLike | None = None, dx: float | None = None, settings: str | Mapping[str, Any] | None = None,
                 name: str | None = None, nx: int | None = None, ny: int | None = None, dt: float | None = None,
                 method: Literal["robust", "published"] | None = None, variant: str | None = None, accuracy: str | None = None,
                 active_tiles: Literal[False, "auto", "cheap", 8, 16, 32, 64] | ActiveTiles | None = None, fused_stages: bool | None = None,
                 any_files: bool | None = None, draws: Output | str | Iterable[Output | str] | None = None, backend: str = "auto",
                 device: int = -1, threads: int = 0, validate: bool = False,
                 log: Callable[[LogLevel, str], object] | Literal[False] | None = None,
                 progress: Callable[[float], bool | None] | None = None, most: _native.Cost | None = None) -> None:
        self.id = _native.WorldId()  # null, until there is one
        layers = {"terrain": terrain, "sand": sand, "water": water, "velocity": velocity, "roughness": roughness, "rain_map": rain_map}
        arrays = {key: value for key, value in layers.items() if value is not None}
        if (level is not None) + (text is not None) + bool(arrays) != 1:
            raise TypeError("World takes one of: a level's file, text=, arrays (terrain=, sand=, water= ...) with dx=")
        overrides = {"nx": nx, "ny": ny, "method": method, "variant": variant, "accuracy": accuracy, "active_tiles": active_tiles,
                     "fused_stages": fused_stages, "any_files": any_files, "draws": draws}
        of_arrays = {"dx": dx, "settings": settings, "name": name}
        for key, value in (overrides if arrays else of_arrays).items():
            if value is not None:
                raise TypeError(f"World: {key}= is for {'levels and texts, write it into settings=' if arrays else 'arrays'}")
        if files is not None and text is None:
            raise TypeError("World: files= is for text=")

        thrown: list[BaseException] = []
        options = _native.DeviceOptions(backend=backend, device=device, threads=threads, validate=validate)
        if log is not False:
            options.log = self._logger(log)
        if progress is not None:
            options.progress = self._progress(progress, thrown)
        if most is not None:
            options.most = ctypes.pointer(most)
        world = _native.WorldId()
        try:
            if arrays:
                self._from_arrays(arrays, dx, dt, settings, name, options, world)
            else:
                raw = _overrides({**overrides, "dt": dt})
                if level is not None:
                    check(native.wadi_create_world_from_level(encoded(level, "level"), byref(raw), byref(options), byref(world)))
                else:
                    reader = _Reader(files)
                    reader.check(native.wadi_create_world_from_level_text(encoded(_settings_text(text, "text"), "text"), reader.callback, None,
                                                                          byref(raw), byref(options), byref(world)))
        except _library.Error:
            if thrown:
                raise thrown[0] from None
            raise
        self.id = world
        self._handle = _Handle(world, (options.log, options.progress))
        self._pinned = set()
        self._step = native.wadi_world_step
        info = self.info
        self.nx, self.ny, self.dx, self.dt, self.backend = info.nx, info.ny, info.dx, info.dt, info.backend
        self.origin = (info.origin_x, info.origin_y)
        self.name = info.name
        self._mask = self._host_mask = 0
        self._row = (self.ny, self.nx)

    @staticmethod
    def _logger(log: Callable[[LogLevel, str], object] | None) -> Any:
        def told(_: Any, level: int, message: bytes) -> None:
            try:
                text = message.decode("utf-8", "replace")
                if log is None:
                    _log.log(_LOGGED[LogLevel(level)], text)
                else:
                    log(LogLevel(level), text)
            except Exception:  # nothing may leave a callback
                _log.exception("the log callback failed")

        return _native.LogCallback(told)

    @staticmethod
    def _progress(progress: Callable[[float], bool | None], thrown: list[BaseException]) -> Any:
        def told(_: Any, share: float) -> int:
            try:
                return 0 if progress(share) is False else 1
            except BaseException as failed:
                thrown.append(failed)
                return 0

        return _native.ProgressCallback(told)

    @staticmethod
    def _from_arrays(arrays: dict[str, Any], dx: float | None, dt: float | None, settings: str | Mapping[str, Any] | None, name: str | None,
                     options: _native.DeviceOptions, world: _native.WorldId) -> None:
        if dx is None:
            raise TypeError("World: arrays need dx=, the width of a cell [m]")
        planes = {key: value for key, value in arrays.items() if key != "velocity"}
        if "velocity" in arrays:
            pair = arrays["velocity"]
            if len(pair) != 2:
                raise ValueError("velocity: must be a pair of arrays, east and north")
            planes["velocity_x"], planes["velocity_y"] = pair
        shape: Any = None
        for key, value in planes.items():
            plane = np.ascontiguousarray(value, dtype=np.float32)
            if plane.ndim != 2 or plane.size == 0:
                raise ValueError(f"{key}: its shape is {plane.shape}, must be (ny, nx)")
            if shape is not None and plane.shape != shape:
                raise ValueError(f"{key}: its shape is {plane.shape}, that of the other arrays {shape}")
            shape = plane.shape
            planes[key] = plane
        ny, nx = shape
        rest = settings if settings is not None else {}
        if isinstance(rest, str):
            rest = json.loads(rest)
        if not isinstance(rest, Mapping):
            raise TypeError("settings: must be a dict or the text of an object")
        if "grid" in rest or "dt" in rest and dt is not None:
            raise ValueError("settings: the grid is that of the arrays and dx=" if "grid" in rest else "dt: stands in settings, too")
        if dt is None and "dt" not in rest:
            height = sum(float(np.max(planes[key])) for key in ("sand", "water") if key in planes)
            dt = 0.2 * float(dx) / math.sqrt(float(rest.get("gravity", 9.81) or 9.81) * max(height, float(dx)))
        full = {"format_version": 1, "name": name or "arrays", **rest, "grid": {"nx": nx, "ny": ny, "dx": float(dx)}}
        if dt is not None:
            full["dt"] = float(dt)
        raw = _native.WorldArrays(settings_json=json.dumps(full), nx=nx, ny=ny, **{key: plane.ctypes.data for key, plane in planes.items()})
        check(native.wadi_create_world_from_arrays(byref(raw), byref(options), byref(world)))

    # ---- Life ----

    def close(self) -> None:
        """Frees the world. Views of its outputs keep their memory: it goes with the last of them. Calls of a closed world are errors."""
        self.id = _native.WorldId()
        self._handle = None

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._handle is None

    def __enter__(self) -> World:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._handle is None:
            return "<wadi.World, closed>"
        return f"<wadi.World {self.name!r}: {self.nx} x {self.ny} cells of {self.dx:g} m, {self.backend}, t = {self.time:g} s>"

    # ---- What it is ----

    @property
    def info(self) -> _native.WorldInfo:
        """What the world is, as wadi.WorldInfo: grid, dt, backend, device, bytes, number of sources ..."""
        info = _native.WorldInfo()
        check(native.wadi_world_get_info(self.id, byref(info)))
        return info

    @property
    def warnings(self) -> list[str]:
        """Advice on the level, a list of texts."""
        return [native.wadi_world_get_warning(self.id, n).decode("utf-8", "replace") for n in range(self.info.warning_count)]

    @property
    def x(self) -> NDArray[np.floating[Any]]:
        """x of the cells' centres, east of the grid's corner [m], shape (nx,). Add origin[0] for map coordinates."""
        return (np.arange(self.nx) + 0.5) * self.dx

    @property
    def y(self) -> NDArray[np.floating[Any]]:
        """y of the cells' centres, north of the grid's corner [m], shape (ny,)."""
        return (np.arange(self.ny) + 0.5) * self.dx

    # ---- Steps ----

    def step(self, steps: int = 1) -> None:
        """Advances by whole water steps of dt each, 0 ... 4294967295. Returns before the device has finished; reads wait for it.
        Errors: OutOfMemoryError (an edit's new material)."""
        if steps.__class__ is not int or steps < 0 or steps > 4294967295:
            steps = whole(steps, "steps", 0, 4294967295)
        result = self._step(self.id, steps)
        if result:
            raise error(result)

    def wait(self) -> None:
        """Waits until the steps asked for so far are done."""
        value = ctypes.c_float()
        check(native.wadi_world_read_region(self.id, Field.TERRAIN, byref(Region(nx=1, ny=1)), byref(value), 1))

    def run(self, seconds: float, progress: Bar = None) -> float:
        """Advances by at least `seconds` of simulated time [s], in whole steps, and waits for them. Returns the simulated time [s].
        progress: True = a bar (needs tqdm: wadi[progress]), False = none, None = a bar where tqdm is there and somebody can see it.
        Ctrl-C ends it between steps; the world stays good."""
        if not (math.isfinite(seconds) and seconds >= 0):
            raise ValueError(f"seconds: {seconds!r}, must be 0 or more")
        steps = math.ceil(seconds / self.dt - 1e-9)
        with progress_bar(progress, steps, self.name) as told:
            chunk = 1
            while steps > 0:
                begun = clock.perf_counter()
                now = min(chunk, steps)
                self.step(now)
                self.wait()
                steps -= now
                told(now)
                if clock.perf_counter() - begun < 0.1:
                    chunk = min(2 * chunk, 65536)
        return self.time

    def record(self, seconds: float, every: float, fields: str | Iterable[Field | str] = ("free_surface",),
               gauges: Mapping[str, Pair] | None = None, progress: Bar = None) -> Recording:
        """Runs for `seconds` [s] and keeps fields, and values at points, every `every` seconds [s], that of now included. Both are rounded
        to whole steps. Returns a wadi.Recording.
        fields: names as `read` takes. gauges: points by name {"bridge": (x, y)} [m from the grid's corner], answered as by `query`."""
        return Recording.of(self, seconds, every, fields, gauges or {}, progress)

    def update(self, seconds: float) -> _native.Frame:
        """Advances by host time [s] as a game's frame does, and publishes the outputs. Returns wadi.Frame.
        Steps are fixed: the same total gives the same bits in frames of any length. Time that the device cannot follow is dropped
        (wadi.Frame.dropped_nanoseconds, set_update_settings)."""
        if not (math.isfinite(seconds) and 0 <= seconds < 1.8e10):
            raise ValueError(f"seconds: {seconds!r}, must be 0 ... 1.8e10")
        frame = _native.Frame()
        check(native.wadi_world_update(self.id, round(seconds * 1e9), byref(frame)))
        return frame

    def set_update_settings(self, **settings: int) -> None:
        """Sets how `update` takes steps: fields of wadi.UpdateSettings (max_steps_per_update 1 ... 1024, max_steps_in_flight 0 ... 64,
        spread, interpolate_outputs); those not named get the header's defaults."""
        raw = _native.UpdateSettings(**settings)
        self._refuse_views("set_update_settings")
        check(native.wadi_world_set_update_settings(self.id, byref(raw)))

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        seconds = c_double()
        check(native.wadi_world_get_time(self.id, byref(seconds), None))
        return seconds.value

    @property
    def steps(self) -> int:
        """Water steps so far."""
        steps = c_uint64()
        check(native.wadi_world_get_time(self.id, None, byref(steps)))
        return steps.value
