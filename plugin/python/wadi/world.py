"""A world of sand and water."""
import ctypes
import json
import logging
import math
import os
import time as clock
import weakref
from collections.abc import Mapping
from ctypes import byref, c_double, c_size_t, c_uint32, c_uint64, c_void_p

import numpy as np

from . import _library, _native
from ._library import BadArgumentError, NotSupportedError, check, encoded, error, fill, native, text_of
from ._native import ActiveTiles, Choice, Edit, EditKind, Field, Layer, LogLevel, Output, OutputSet, QueryResult, Region, Result, Source, SourceShape
from ._struct import member, whole
from .output import OutputView, layout_of
from .recording import Recording, progress_bar

_log = logging.getLogger("wadi")
_LOGGED = {LogLevel.ERROR: logging.ERROR, LogLevel.WARNING: logging.WARNING, LogLevel.INFORMATION: logging.INFO}
#: What `query` answers, one element per point: fields of wadi.QueryResult, velocity and normal as arrays of 2 and 3.
QUERY_DTYPE = np.dtype([("terrain", "f4"), ("sand_depth", "f4"), ("water_depth", "f4"), ("surface", "f4"), ("velocity", "f4", 2),
                        ("normal", "f4", 3), ("saturation", "f4"), ("inside", "i4")])
assert QUERY_DTYPE.itemsize == ctypes.sizeof(QueryResult)


class _Handle:
    """Owns a world of the library: it is destroyed once nobody holds this, views of its memory included."""

    def __init__(self, world, callbacks):
        self.world = world
        self.views = weakref.WeakSet()
        weakref.finalize(self, _Handle.destroy, world, callbacks)

    @staticmethod
    def destroy(world, callbacks):
        native.wadi_destroy_world(world)
        del callbacks  # they may be called until here


def _bits(names, what):
    """A mask from one output, or from several."""
    names = [names] if isinstance(names, (str, int)) else names
    mask = 0
    for name in names:
        mask |= 1 << member(Output, name, what)
    return mask


def _switch(value):
    """off, on, or as the level says"""
    return Choice.LEVEL if value is None else Choice.ON if value else Choice.OFF


def _overrides(given):
    """wadi_level_overrides from keywords that are not None."""
    fields = {name: value for name, value in given.items() if value is not None}
    if "active_tiles" in fields:
        value = fields["active_tiles"]
        fields["active_tiles"] = ActiveTiles.OFF if value is False else member(ActiveTiles, value, "active_tiles")
    if "fused_stages" in fields:
        fields["fused_stages"] = _switch(fields["fused_stages"])
    if "draws" in fields:
        fields["draws"] = _bits(fields["draws"], "draws")
    return _native.LevelOverrides(**fields)


class _Reader:
    """Files that a level's text names, from a folder, a mapping or a function; what goes wrong there is kept for the caller."""

    def __init__(self, files):
        self.thrown = None
        if files is None:
            self.callback = _native.ReadFileCallback()
            return
        if isinstance(files, (str, os.PathLike)):
            folder = os.fspath(files)

            def read(name):
                file = os.path.join(folder, name)
                if not os.path.isfile(file):
                    return None
                with open(file, "rb") as opened:
                    return opened.read()
        else:
            read = files.get if isinstance(files, Mapping) else files

        def called(_, name, data, size):
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

    def check(self, result):
        if self.thrown is not None:
            raise self.thrown
        check(result)


def _settings_text(settings, what):
    if isinstance(settings, str):
        return settings
    if isinstance(settings, Mapping):
        return json.dumps(settings)
    raise TypeError(f"{what}: a level is a text or a dict, not {type(settings).__name__}")


def level_cost(level=None, *, text=None, files=None, **overrides):
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


class Material(Mapping):
    """Numbers of a world's material by name, as level files write them: world.material["friction"] = 0.6 changes one from the next step
    on. Names and units: wadi.describe("settings"). `range(name)` gives least and most. Another name is a KeyError, a value outside a
    BadArgumentError; nothing is changed then."""

    def __init__(self, world):
        self._world = world

    def _infos(self):
        return {info.name: info for info in fill(native.wadi_world_get_material, _native.MaterialInfo, self._world.id)}

    def __getitem__(self, name):
        return self._infos()[name].value

    def __setitem__(self, name, value):
        if name not in self._infos():
            raise KeyError(name)
        check(native.wadi_world_set_material(self._world.id, encoded(name, "name"), float(value)))

    def __iter__(self):
        return iter(self._infos())

    def __len__(self):
        return len(self._infos())

    def range(self, name):
        """(least, most) that the number takes."""
        info = self._infos()[name]
        return info.least, info.most

    def __repr__(self):
        return f"Material({dict(self)})"


class Save:
    """A snapshot under way (World.begin_save). The world holds its memory until it has arrived."""

    def __init__(self, world):
        ticket, size = c_uint64(), c_size_t(0)
        check(native.wadi_world_save(world.id, None, byref(size)))
        check(native.wadi_world_begin_save(world.id, byref(ticket)))
        self._world, self._ticket = world, ticket.value
        self._room, self._data = ctypes.create_string_buffer(size.value), None
        world._pinned.add(self)

    def result(self):
        """The snapshot as bytes, or None while it is not there yet. Errors: those of wadi_world_end_save."""
        if self._data is None:
            size = c_size_t(len(self._room))
            status = native.wadi_world_end_save(self._world.id, self._ticket, self._room, byref(size))
            if status == Result.NOT_READY:
                return None
            check(status)
            self._data = self._room.raw[:size.value]
            self._world._pinned.discard(self)
        return self._data


class World:
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

    def __init__(self, level=None, *, text=None, files=None,
                 terrain=None, sand=None, water=None, velocity=None, roughness=None, rain_map=None, dx=None, settings=None, name=None,
                 nx=None, ny=None, dt=None, method=None, variant=None, accuracy=None, active_tiles=None, fused_stages=None, any_files=None,
                 draws=None, backend="auto", device=-1, threads=0, validate=False, log=None, progress=None, most=None):
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

        thrown = []
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
        self._pinned = set()  # memory that the library writes
        self._step = native.wadi_world_step
        info = self.info
        #: Cells along x (east) and y (north); width of a cell [m]; water time step [s]; "cpu", "vulkan" or "cuda".
        self.nx, self.ny, self.dx, self.dt, self.backend = info.nx, info.ny, info.dx, info.dt, info.backend
        #: Map coordinates of the grid's south-west corner [m]; (0, 0) without a map.
        self.origin = (info.origin_x, info.origin_y)
        self.name = info.name
        self._mask = self._host_mask = 0
        self._row = (self.ny, self.nx)

    @staticmethod
    def _logger(log):
        def told(_, level, message):
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
    def _progress(progress, thrown):
        def told(_, share):
            try:
                return 0 if progress(share) is False else 1
            except BaseException as failed:
                thrown.append(failed)
                return 0

        return _native.ProgressCallback(told)

    @staticmethod
    def _from_arrays(arrays, dx, dt, settings, name, options, world):
        if dx is None:
            raise TypeError("World: arrays need dx=, the width of a cell [m]")
        planes = {key: value for key, value in arrays.items() if key != "velocity"}
        if "velocity" in arrays:
            pair = arrays["velocity"]
            if len(pair) != 2:
                raise ValueError("velocity: must be a pair of arrays, east and north")
            planes["velocity_x"], planes["velocity_y"] = pair
        shape = None
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

    def close(self):
        """Frees the world. Views of its outputs keep their memory: it goes with the last of them. Calls of a closed world are errors."""
        self.id = _native.WorldId()
        self._handle = None

    @property
    def closed(self):
        """Whether `close` was called."""
        return self._handle is None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        if self._handle is None:
            return "<wadi.World, closed>"
        return f"<wadi.World {self.name!r}: {self.nx} x {self.ny} cells of {self.dx:g} m, {self.backend}, t = {self.time:g} s>"

    # ---- What it is ----

    @property
    def info(self):
        """What the world is, as wadi.WorldInfo: grid, dt, backend, device, bytes, number of sources ..."""
        info = _native.WorldInfo()
        check(native.wadi_world_get_info(self.id, byref(info)))
        return info

    @property
    def warnings(self):
        """Advice on the level, a list of texts."""
        return [native.wadi_world_get_warning(self.id, n).decode("utf-8", "replace") for n in range(self.info.warning_count)]

    @property
    def x(self):
        """x of the cells' centres, east of the grid's corner [m], shape (nx,). Add origin[0] for map coordinates."""
        return (np.arange(self.nx) + 0.5) * self.dx

    @property
    def y(self):
        """y of the cells' centres, north of the grid's corner [m], shape (ny,)."""
        return (np.arange(self.ny) + 0.5) * self.dx

    # ---- Steps ----

    def step(self, steps=1):
        """Advances by whole water steps of dt each, 0 ... 4294967295. Returns before the device has finished; reads wait for it.
        Errors: OutOfMemoryError (an edit's new material)."""
        if steps.__class__ is not int or steps < 0 or steps > 4294967295:
            steps = whole(steps, "steps", 0, 4294967295)
        result = self._step(self.id, steps)
        if result:
            raise error(result)

    def wait(self):
        """Waits until the steps asked for so far are done."""
        value = ctypes.c_float()
        check(native.wadi_world_read_region(self.id, Field.TERRAIN, byref(Region(nx=1, ny=1)), byref(value), 1))

    def run(self, seconds, progress=None):
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

    def record(self, seconds, every, fields=("free_surface",), gauges=None, progress=None):
        """Runs for `seconds` [s] and keeps fields, and values at points, every `every` seconds [s], that of now included. Both are rounded
        to whole steps. Returns a wadi.Recording.
        fields: names as `read` takes. gauges: points by name {"bridge": (x, y)} [m from the grid's corner], answered as by `query`."""
        return Recording.of(self, seconds, every, fields, gauges or {}, progress)

    def update(self, seconds):
        """Advances by host time [s] as a game's frame does, and publishes the outputs. Returns wadi.Frame.
        Steps are fixed: the same total gives the same bits in frames of any length. Time that the device cannot follow is dropped
        (wadi.Frame.dropped_nanoseconds, set_update_settings)."""
        if not (math.isfinite(seconds) and 0 <= seconds < 1.8e10):
            raise ValueError(f"seconds: {seconds!r}, must be 0 ... 1.8e10")
        frame = _native.Frame()
        check(native.wadi_world_update(self.id, round(seconds * 1e9), byref(frame)))
        return frame

    def set_update_settings(self, **settings):
        """Sets how `update` takes steps: fields of wadi.UpdateSettings (max_steps_per_update 1 ... 1024, max_steps_in_flight 0 ... 64,
        spread, interpolate_outputs); those not named get the header's defaults."""
        raw = _native.UpdateSettings(**settings)
        self._refuse_views("set_update_settings")
        check(native.wadi_world_set_update_settings(self.id, byref(raw)))

    @property
    def time(self):
        """Simulated time [s]."""
        seconds = c_double()
        check(native.wadi_world_get_time(self.id, byref(seconds), None))
        return seconds.value

    @property
    def steps(self):
        """Water steps so far."""
        steps = c_uint64()
        check(native.wadi_world_get_time(self.id, None, byref(steps)))
        return steps.value

    # ---- Outputs ----

    def _refuse_views(self, what):
        if self._handle is not None and len(self._handle.views):
            raise BufferError(f"{what}: {len(self._handle.views)} views of outputs are alive, whose memory it would free; delete them first")

    def set_outputs(self, *outputs, host=None):
        """Chooses what `update` and `publish` publish: names of wadi.Output ("free_surface", "flow" ...); none = nothing.
        host: True = copied to the host's memory, for `output` on any backend; False = on the device, for `view`; None = True with the
        backend "vulkan", else False.
        Errors: BufferError while views of another choice are alive, OutOfMemoryError."""
        names = outputs[0] if len(outputs) == 1 and not isinstance(outputs[0], (str, int)) else outputs
        mask = _bits(names, "outputs")
        host = self.backend == "vulkan" if host is None else host
        on_device, on_host = (0, mask) if host else (mask, 0)
        if on_device != self._mask or on_host != self._host_mask:
            self._refuse_views("set_outputs")
        check(native.wadi_world_set_outputs(self.id, on_device))
        self._mask = on_device
        check(native.wadi_world_set_host_outputs(self.id, on_host))
        self._host_mask = on_host

    def publish(self):
        """Publishes the outputs of the state now, without a step, and waits until they are there. Returns wadi.Frame."""
        frame = self.update(0)
        check(native.wadi_world_wait_for_outputs(self.id))
        return frame

    def view(self, output, which="current"):
        """An output in the world's own memory, without a copy: a wadi.OutputView. Read only. `which` is "current", "previous" or
        "interpolated". On the CPU np.asarray() takes it; on CUDA CuPy, torch (from_dlpack) and JAX do.
        Waits on the CPU until it is written. What it shows stays as it is during the next update; the one after writes there.
        Errors: BadArgumentError (not asked for by set_outputs), NotReadyError (nothing published yet), NotSupportedError (Vulkan)."""
        number = member(Output, output, "output")
        raw = _native.OutputView()
        which = member(OutputSet, which, "which")
        check(native.wadi_world_get_view(self.id, number, which, byref(raw)))
        if raw.handle_kind == _native.HandleKind.VULKAN_BUFFER:
            raise NotSupportedError("view: Python cannot address a Vulkan buffer; take output()")
        if raw.handle_kind == _native.HandleKind.HOST_POINTER and not raw.finished:
            check(native.wadi_world_wait_for_outputs(self.id))
        return OutputView(self._handle, number, raw)

    def output(self, output):
        """A copy of an output as published last, as a NumPy array of shape (ny, nx) or (ny, nx, n). Waits until it is there.
        Errors: those of `view`; on a GPU the output must be asked for with host=True."""
        number = member(Output, output, "output")
        if self._host_mask >> number & 1 == 0 and self.backend == "cpu":
            return np.array(self.view(number))
        check(native.wadi_world_wait_for_outputs(self.id))
        data, pitch, step = c_void_p(), c_uint64(), c_uint64()
        check(native.wadi_world_get_host_output(self.id, number, byref(data), byref(pitch), byref(step)))
        dtype, shape, strides = layout_of(number, self.ny, self.nx, pitch.value)
        room = (ctypes.c_char * (pitch.value * self.ny)).from_address(data.value)
        return np.ndarray(shape, dtype, room, strides=strides).copy()

    # ---- Reading and writing fields ----

    def _region(self, region):
        if region is None:
            return Region(i0=0, j0=0, nx=self.nx, ny=self.ny)
        i0, j0, nx, ny = region.as_dict().values() if isinstance(region, Region) else region
        found = Region(i0=i0, j0=j0, nx=nx, ny=ny)
        if not (0 <= found.i0 and 0 <= found.j0 and 0 < found.nx <= self.nx - found.i0 and 0 < found.ny <= self.ny - found.j0):
            raise ValueError(f"region: (i0, j0, nx, ny) = {(i0, j0, nx, ny)}, must lie in the grid of {self.nx} x {self.ny} cells")
        return found

    def read(self, field, region=None, out=None):
        """A field as an array of float32, shape (ny, nx), row 0 in the south. Waits for the steps. A field that the world lacks is 0.
        field: a wadi.Field or its name ("water_depth", "sand_depth", "free_surface", "water_velocity_x" ...).
        region: (i0, j0, nx, ny) in cells. out: a C-contiguous float32 array of that shape that is written instead of a new one."""
        number = member(Field, field, "field")
        if region is None:
            shape = self._row
        else:
            raw = self._region(region)
            shape = (raw.ny, raw.nx)
        if out is None:
            out = np.empty(shape, np.float32)
        elif not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.float32 or not out.flags.c_contiguous or not out.flags.writeable:
            raise ValueError(f"out: must be a writeable C-contiguous float32 array of shape {shape}")
        if region is None:
            check(native.wadi_world_read_field(self.id, number, out.ctypes.data, out.size))
        else:
            check(native.wadi_world_read_region(self.id, number, byref(raw), out.ctypes.data, out.size))
        return out

    def write(self, field, values, region=None, wait=True):
        """Overwrites "terrain", "sand_depth" or "total_water_depth" [m] after the steps asked for; what that adds or takes is in the ledger.
        values: an array of the region's shape (ny, nx), or one number; or an array on the world's CUDA device (CuPy, torch, JAX: what has
        __cuda_array_interface__, float32, rows without gaps between values), which is read behind the work of its stream.
        wait: False = an array of the host is written without waiting. Values that are checked on the device (from there, or with
        wait=False) are cut to what the cell has room for instead of refused, and counted in stats().refused; not while the command log is on.
        Errors: BadArgumentError (another field, NaN, a negative depth, a column too high: the message names the cell)."""
        number = member(Field, field, "field")
        raw = self._region(region)
        shape = (raw.ny, raw.nx)
        if hasattr(values, "__cuda_array_interface__"):
            from . import cuda

            return cuda.write(self, number, raw, values)
        plane = np.asarray(values, dtype=np.float32)
        if plane.shape != shape:
            if plane.ndim != 0:
                raise ValueError(f"values: their shape is {plane.shape}, must be {shape}")
            plane = np.full(shape, plane, np.float32)
        plane = np.ascontiguousarray(plane)
        if wait:
            check(native.wadi_world_write_region(self.id, number, byref(raw), plane.ctypes.data, plane.size))
        else:
            given = _native.DeviceValues(handle_kind="host_pointer", handle=plane.ctypes.data)
            check(native.wadi_world_write_region_from(self.id, number, byref(raw), byref(given)))
        return None

    # ---- Statistics ----

    def stats(self):
        """State now, as wadi.WorldStats: volumes, extremes, limits at work, ledger, hash. Reads the whole state."""
        stats = _native.WorldStats()
        check(native.wadi_world_get_stats(self.id, byref(stats)))
        return stats

    def budget(self):
        """The ledger [m3]: {"water": {"initial", "in", "out", "now", "drift"}, "sand": {...}, "refused"}. drift = now - (initial + in -
        out), counted in whole quanta: exactly 0 as long as columns stay below method.largest_height."""
        stats = self.stats()
        cell = stats.quantum * self.dx**2
        volumes = {kind: {"initial": getattr(stats, f"{kind}_initial"), "in": getattr(stats, f"{kind}_in"), "out": getattr(stats, f"{kind}_out"),
                          "now": getattr(stats, f"{kind}_volume"), "drift": getattr(stats, f"{kind}_drift_quanta") * cell}
                   for kind in ("water", "sand")}
        return {**volumes, "refused": stats.refused}

    def hash(self):
        """64-bit hash of the state. Equal states have equal hashes on every backend that passes the exact-float test."""
        found = c_uint64()
        check(native.wadi_world_get_hash(self.id, byref(found)))
        return found.value

    def to_xarray(self, fields=("terrain", "sand_depth", "water_depth", "free_surface")):
        """Fields of the state now as an xarray.Dataset with units and coordinates, those of the map where there is one. Needs xarray:
        wadi[xarray]."""
        from .dataset import of_world

        return of_world(self, fields)

    # ---- Points ----

    def ask(self, points):
        """Asks for the state at points, an array of shape (n, 2) or (2,), n up to 65536: x, y [m from the grid's south-west corner]. Returns a
        ticket for `answer`; waits for nothing. Eight batches may be under way (NotReadyError)."""
        xy = np.ascontiguousarray(points, dtype=np.float32)
        if xy.ndim == 1:
            xy = xy[None]
        if xy.ndim != 2 or xy.shape[1] != 2 or not 1 <= len(xy) <= 65536:
            raise ValueError(f"points: their shape is {np.shape(points)}, must be (n, 2) with n of 1 ... 65536")
        ticket = c_uint64()
        check(native.wadi_world_query(self.id, xy.ctypes.data, len(xy), byref(ticket)))
        return ticket.value

    def answer(self, ticket):
        """The answers to `ask`: an array of wadi.QUERY_DTYPE, one element per point, or None while they are not there yet."""
        count = c_uint32()
        status = native.wadi_world_get_query(self.id, ticket, None, 0, byref(count), None)
        if status == Result.NOT_READY:
            return None
        check(status)
        answers = np.zeros(count.value, QUERY_DTYPE)
        pointer = ctypes.cast(answers.ctypes.data, ctypes.POINTER(QueryResult))
        check(native.wadi_world_get_query(self.id, ticket, pointer, count.value, byref(count), None))
        return answers

    def query(self, points):
        """The state at points after the steps asked for, waited for: an array of wadi.QUERY_DTYPE with the fields terrain, sand_depth,
        water_depth, surface [m], velocity [m/s], normal, saturation, inside (0 outside the grid). Points as `ask` takes them."""
        ticket = self.ask(points)
        self.wait()
        while (answers := self.answer(ticket)) is None:
            clock.sleep(1e-4)
        return answers

    # ---- Edits ----

    def edit(self, *edits):
        """Queues edits, wadi.Edit each: brushes, stamps and pushes, ahead of the next step or of their own. Errors: BadArgumentError names
        edit, field and range; none is queued then."""
        if edits:
            raw = (Edit * len(edits))(*edits)
            check(native.wadi_world_edit(self.id, raw, len(edits)))

    def _brush(self, layer, x, y, amount, radius, softness, to, step, player):
        x1, y1 = to if to is not None else (0, 0)
        self.edit(Edit(kind=EditKind.BRUSH, layer=layer, x0=x, y0=y, x1=x1, y1=y1, capsule=to is not None, amount=amount, radius=radius,
                       softness=softness, step=step, player=player))

    def pour(self, x, y, depth, radius=1.0, *, layer="water", softness=0.5, to=None, step=0, player=0):
        """Pours `depth` [m] at the centre of a disc round (x, y) [m], or along the line from there `to` (x, y).
        layer: "water" or "sand". radius [m]; softness 0 ... 1: share of the radius over which the depth falls to 0. step: the water step
        ahead of which it acts, 0 = the next. player: edits of one step act by rising player. Errors: those of `edit`."""
        layer = member(Layer, layer, "layer")
        if layer == Layer.TERRAIN or not depth >= 0:
            raise ValueError(f"pour: {'the layer is water or sand' if layer == Layer.TERRAIN else f'depth: {depth!r}, must be 0 or more; dig() takes away'}")
        self._brush(layer, x, y, depth, radius, softness, to, step, player)

    def dig(self, x, y, depth, radius=1.0, *, layer="sand", softness=0.5, to=None, step=0, player=0):
        """Takes up to `depth` [m] of a layer ("sand", "water", "terrain"), no more than there is; the rest as `pour`."""
        if not depth >= 0:
            raise ValueError(f"dig: depth: {depth!r}, must be 0 or more; pour() adds")
        self._brush(member(Layer, layer, "layer"), x, y, -depth, radius, softness, to, step, player)

    def raise_terrain(self, x, y, height, radius=1.0, *, softness=0.5, to=None, step=0, player=0):
        """Raises the ground by `height` [m], or lowers it where that is below 0; the rest as `pour`."""
        self._brush(Layer.TERRAIN, x, y, height, radius, softness, to, step, player)

    def push(self, x, y, velocity, radius=1.0, *, strength=1.0, softness=0.5, to=None, step=0, player=0):
        """Drags sand and water along with a body of that velocity (east, north) [m/s]. strength 0 ... 1; the rest as `pour`."""
        x1, y1 = to if to is not None else (0, 0)
        east, north = velocity
        self.edit(Edit(kind=EditKind.PUSH, x0=x, y0=y, x1=x1, y1=y1, capsule=to is not None, radius=radius, softness=softness,
                       strength=strength, velocity_x=east, velocity_y=north, step=step, player=player))

    def create_stamp(self, image):
        """Copies an image (ny, nx) of 1 ... 4096 values a side, row 0 in the south, for `stamp`. Returns its number, from 1 on."""
        plane = np.ascontiguousarray(image, dtype=np.float32)
        if plane.ndim != 2:
            raise ValueError(f"image: its shape is {plane.shape}, must be (ny, nx)")
        number = c_uint32()
        check(native.wadi_world_create_stamp(self.id, plane.shape[1], plane.shape[0], plane.ctypes.data, byref(number)))
        return number.value

    def stamp(self, image, low, high, amount=1.0, *, layer="terrain", step=0, player=0):
        """Adds `amount` [m] times an image to a layer over the rectangle from `low` to `high`, (x, y) each [m]. image: a number from
        create_stamp, or an array, which becomes a stamp that lives as long as the world."""
        number = image if isinstance(image, int) else self.create_stamp(image)
        (x0, y0), (x1, y1) = low, high
        self.edit(Edit(kind=EditKind.STAMP, layer=layer, x0=x0, y0=y0, x1=x1, y1=y1, amount=amount, stamp=number, step=step, player=player))

    def prepare_effects(self):
        """Compiles what edits may bring later, so that they only allocate."""
        check(native.wadi_world_prepare_effects(self.id))

    def trim(self):
        """Frees what belongs to materials that the world no longer holds. Waits for the steps."""
        check(native.wadi_world_trim(self.id))

    # ---- Sources ----

    @property
    def sources(self):
        """Sources and drains as they are now, a list of dicts with what set_source takes."""
        return [self._source(n) for n in range(self.info.source_count)]

    def _source(self, index):
        raw = Source()
        check(native.wadi_world_get_source(self.id, index, byref(raw)))
        found = {"shape": raw.shape.name.lower(), "sand": raw.sand, "drain": raw.drain}
        found.update({"from_": raw.from_, "to": raw.to} if raw.shape == SourceShape.BOX else {"center": raw.center})
        if raw.shape == SourceShape.DISC:
            found["radius"] = raw.radius
        if raw.set_velocity:
            found["velocity"] = raw.velocity
        for series in ("rate", "discharge", "level"):
            count, samples = getattr(raw, f"{series}_count"), getattr(raw, series)
            if count:
                found[series] = [(samples[n].time, samples[n].value) for n in range(count)]
        return found

    def set_source(self, index, *, shape="disc", center=None, radius=1.0, from_=None, to=None, rate=None, discharge=None, level=None,
                   sand=False, drain=False, velocity=None, step=0, player=0):
        """Makes source `index`, 0 ... 31, another one: opens, closes, moves or adds it.
        shape: "disc" (center, radius), "point" (center), "box" (from_, to), (x, y) each [m].
        One of rate (depth per time [m/s]), discharge [m3/s], level (elevation of water that it holds [m]; with it rate or discharge is the
        most that it moves): a number, or samples [(time [s], value), ...], linear between. rate=0 closes a tap.
        sand: True = of sand. drain: True = with level, takes away what stands above, too. velocity: (east, north) forced on the water
        inside [m/s]. step, player: as `pour`. Errors: BadArgumentError names the field and its range."""
        raw = Source(shape=shape, sand=sand, drain=drain, radius=radius, step=step, player=player)
        for field, value in (("center", center), ("from_", from_), ("to", to)):
            if value is not None:
                setattr(raw, field, value)
        if velocity is not None:
            raw.set_velocity, raw.velocity = True, velocity
        for field, value in (("rate", rate), ("discharge", discharge), ("level", level)):
            if value is None:
                continue
            pairs = np.asarray([(0.0, value)] if np.ndim(value) == 0 else value, dtype=float)
            if pairs.ndim != 2 or pairs.shape[1] != 2:
                raise ValueError(f"{field}: its shape is {pairs.shape}, must be a number or samples (n, 2) of time and value")
            setattr(raw, field, (_native.Sample * len(pairs))(*(_native.Sample(time=t, value=v) for t, v in pairs)))
            setattr(raw, f"{field}_count", len(pairs))
        check(native.wadi_world_set_source(self.id, whole(index, "index", 0, 31), byref(raw)))

    @property
    def material(self):
        """Numbers of the material by name, to read and to set: a wadi.Material."""
        return Material(self)

    # ---- Saving and going back ----

    def _bytes(self, call, *given):
        size = c_size_t(0)
        check(call(*given, None, byref(size)))
        room = ctypes.create_string_buffer(max(1, size.value))
        check(call(*given, room, byref(size)))
        return room.raw[:size.value]

    def save(self):
        """The state as bytes, to the bit; the level and edits that wait are not in it. Waits for the steps."""
        return self._bytes(native.wadi_world_save, self.id)

    def load(self, snapshot):
        """Goes to a saved state of the same level, on whatever backend it was saved. Edits that wait are forgotten.
        Errors, the world as it was: BadFileError (no snapshot, newer, changed), BadArgumentError (of another level)."""
        data = bytes(snapshot)
        check(native.wadi_world_load(self.id, data, len(data)))

    def save_file(self, path):
        """`save` to a file, replaced whole or not at all. Errors: NotFoundError, BadFileError."""
        check(native.wadi_world_save_file(self.id, encoded(path, "path")))

    def load_file(self, path):
        """`load` from a file. Errors: NotFoundError, and those of `load`."""
        check(native.wadi_world_load_file(self.id, encoded(path, "path")))

    def begin_save(self):
        """Asks for a snapshot without waiting: a wadi.Save, whose result() is None until it is there. Errors: NotReadyError (one is under
        way), OutOfMemoryError."""
        return Save(self)

    def snapshot_cost(self, snapshot):
        """What `load` of these bytes would cost, as wadi.Cost."""
        return self._cost(native.wadi_world_get_snapshot_cost, snapshot)

    def _cost(self, call, data):
        data, cost = bytes(data), _native.Cost()
        check(call(self.id, data, len(data), byref(cost)))
        return cost

    def set_rollback(self, frames, interval_steps=1):
        """Keeps the newest `frames` (0 ... 256, 0 = off) states of steps that are multiples of interval_steps, on the device."""
        check(native.wadi_world_set_rollback(self.id, whole(frames, "frames", 0, 256), whole(interval_steps, "interval_steps", 1, 4294967295)))

    @property
    def rollback_steps(self):
        """Steps that can be gone back to, oldest first."""
        return fill(native.wadi_world_get_rollback_steps, c_uint64, self.id)

    def roll_back(self, step):
        """Goes back to the newest kept step that is not after `step`; returns it. Errors: BadArgumentError (none that old is kept)."""
        reached = c_uint64()
        check(native.wadi_world_roll_back(self.id, whole(step, "step", 0, 2**64 - 1), byref(reached)))
        return reached.value

    # ---- Command log ----

    def set_command_log(self, on=True):
        """True = remembers every edit, source, written region, trim and change of the material with its step; False = drops the log."""
        check(native.wadi_world_set_command_log(self.id, 1 if on else 0))

    def commands(self, since=None, player=None):
        """The log as bytes: all, or what counts ahead of step `since` or later, of one player or of every (None)."""
        if since is None and player is None:
            return self._bytes(native.wadi_world_get_commands, self.id)
        first = whole(since or 0, "since", 0, 2**64 - 1)
        who = _native.EVERY_PLAYER if player is None else whole(player, "player", 0, 4294967295)
        return self._bytes(native.wadi_world_get_commands_since, self.id, first, who)

    def play_commands(self, log):
        """Queues the commands of a log in a world of the same level; after the same steps both have the same hash.
        Errors, nothing queued: BadFileError, BadArgumentError (another level, or steps already done)."""
        data = bytes(log)
        check(native.wadi_world_play_commands(self.id, data, len(data)))

    def commands_cost(self, log):
        """What play_commands of these bytes would cost, as wadi.Cost."""
        return self._cost(native.wadi_world_get_commands_cost, log)

    # ---- Looking inside ----

    def plan(self):
        """The plan as text: effects on and why, passes, buffers, bytes per cell."""
        return text_of(native.wadi_world_describe_plan, self.id)

    @property
    def effects(self):
        """Effects with why each is on or off: a list of wadi.EffectInfo."""
        return fill(native.wadi_world_get_effects, _native.EffectInfo, self.id)

    @property
    def memory(self):
        """Buffers on the device [bytes] by label; labels may repeat: a list of wadi.MemoryItem."""
        return fill(native.wadi_world_get_memory, _native.MemoryItem, self.id)

    def set_profiling(self, on=True):
        """True = every step is timed from now on; see stage_timings."""
        check(native.wadi_world_set_profiling(self.id, 1 if on else 0))

    @property
    def stage_timings(self):
        """Mean times since set_profiling: a list of wadi.StageTiming, milliseconds per water step."""
        return fill(native.wadi_world_get_stage_timings, _native.StageTiming, self.id)

    def set_checking(self, on=True):
        """True = the whole state is verified after every step (InternalError names step, field and cell); slow."""
        check(native.wadi_world_set_checking(self.id, 1 if on else 0))

    def check(self):
        """Raises what broke the world for good (DeviceLostError)."""
        check(native.wadi_world_get_error(self.id))
