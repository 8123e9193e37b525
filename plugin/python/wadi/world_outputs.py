"""What a world shows: outputs, fields, statistics, points."""
from __future__ import annotations

import ctypes
import time as clock
from collections.abc import Iterable
from ctypes import byref, c_uint32, c_uint64, c_void_p
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _native
from ._library import NotSupportedError, check, native
from ._native import Field, Output, OutputSet, QueryResult, Region, Result
from ._struct import member
from ._world import WorldBase
from .output import OutputView, bits_of, layout_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    import xarray

    from ._types import Cells, CudaArray, Floats

#: What `query` answers, one element per point: fields of wadi.QueryResult, velocity and normal as arrays of 2 and 3.
QUERY_DTYPE: np.dtype[np.void] = np.dtype([("terrain", "f4"), ("sand_depth", "f4"), ("water_depth", "f4"), ("surface", "f4"),
                                           ("velocity", "f4", 2), ("normal", "f4", 3), ("saturation", "f4"), ("inside", "i4")])
assert QUERY_DTYPE.itemsize == ctypes.sizeof(QueryResult)


class Outputs(WorldBase):
    """Of a World: outputs in place, fields, statistics, points."""

    # ---- Outputs ----

    def _refuse_views(self, what: str) -> None:
        if self._handle is not None and len(self._handle.views):
            raise BufferError(f"{what}: {len(self._handle.views)} views of outputs are alive, whose memory it would free; delete them first")

    def set_outputs(self, *outputs: Output | str | Iterable[Output | str], host: bool | None = None) -> None:
        """Chooses what `update` and `publish` publish: names of wadi.Output ("free_surface", "flow" ...); none = nothing.
        host: True = copied to the host's memory, for `output` on any backend; False = on the device, for `view`; None = True with the
        backend "vulkan", else False.
        Errors: BufferError while views of another choice are alive, OutOfMemoryError."""
        names: Any = outputs[0] if len(outputs) == 1 and not isinstance(outputs[0], (str, int)) else outputs
        mask = bits_of(names, "outputs")
        host = self.backend == "vulkan" if host is None else host
        on_device, on_host = (0, mask) if host else (mask, 0)
        if on_device != self._mask or on_host != self._host_mask:
            self._refuse_views("set_outputs")
        check(native.wadi_world_set_outputs(self.id, on_device))
        self._mask = on_device
        check(native.wadi_world_set_host_outputs(self.id, on_host))
        self._host_mask = on_host

    def publish(self) -> _native.Frame:
        """Publishes the outputs of the state now, without a step, and waits until they are there. Returns wadi.Frame."""
        frame = self.update(0)
        check(native.wadi_world_wait_for_outputs(self.id))
        return frame

    def view(self, output: Output | str, which: Literal["current", "previous", "interpolated"] | OutputSet = "current") -> OutputView:
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

    def output(self, output: Output | str) -> NDArray[Any]:
        """A copy of an output as published last, as a NumPy array of shape (ny, nx) or (ny, nx, n). Waits until it is there.
        Errors: those of `view`; on a GPU the output must be asked for with host=True."""
        number = member(Output, output, "output")
        if self._host_mask >> number & 1 == 0 and self.backend == "cpu":
            return np.array(self.view(number))
        check(native.wadi_world_wait_for_outputs(self.id))
        data, pitch, step = c_void_p(), c_uint64(), c_uint64()
        check(native.wadi_world_get_host_output(self.id, number, byref(data), byref(pitch), byref(step)))
        dtype, shape, strides = layout_of(number, self.ny, self.nx, pitch.value)
        room: Any = (ctypes.c_char * (pitch.value * self.ny)).from_address(data.value)  # type: ignore[arg-type]
        return np.ndarray(shape, dtype, room, strides=strides).copy()  # type: ignore[no-any-return]

    # ---- Reading and writing fields ----

    def _region(self, region: Cells | None) -> Region:
        if region is None:
            return Region(i0=0, j0=0, nx=self.nx, ny=self.ny)
        i0, j0, nx, ny = region.as_dict().values() if isinstance(region, Region) else region  # type: ignore[attr-defined]
        found = Region(i0=i0, j0=j0, nx=nx, ny=ny)
        if not (0 <= found.i0 and 0 <= found.j0 and 0 < found.nx <= self.nx - found.i0 and 0 < found.ny <= self.ny - found.j0):
            raise ValueError(f"region: (i0, j0, nx, ny) = {(i0, j0, nx, ny)}, must lie in the grid of {self.nx} x {self.ny} cells")
        return found

    def read(self, field: Field | str, region: Cells | None = None, out: Floats | None = None) -> Floats:
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

    def write(self, field: Field | str, values: ArrayLike | CudaArray, region: Cells | None = None, wait: bool = True) -> None:
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

            return cuda.write(self, number, raw, values)  # type: ignore[arg-type]
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

    def stats(self) -> _native.WorldStats:
        """State now, as wadi.WorldStats: volumes, extremes, limits at work, ledger, hash. Reads the whole state."""
        stats = _native.WorldStats()
        check(native.wadi_world_get_stats(self.id, byref(stats)))
        return stats

    def budget(self) -> dict[str, Any]:
        """The ledger [m3]: {"water": {"initial", "in", "out", "now", "drift"}, "sand": {...}, "refused"}. drift = now - (initial + in -
        out), counted in whole quanta: exactly 0 as long as columns stay below method.largest_height."""
        stats = self.stats()
        cell = stats.quantum * self.dx**2
        volumes = {kind: {"initial": getattr(stats, f"{kind}_initial"), "in": getattr(stats, f"{kind}_in"), "out": getattr(stats, f"{kind}_out"),
                          "now": getattr(stats, f"{kind}_volume"), "drift": getattr(stats, f"{kind}_drift_quanta") * cell}
                   for kind in ("water", "sand")}
        return {**volumes, "refused": stats.refused}

    def hash(self) -> int:
        """64-bit hash of the state. Equal states have equal hashes on every backend that passes the exact-float test."""
        found = c_uint64()
        check(native.wadi_world_get_hash(self.id, byref(found)))
        return found.value

    def to_xarray(self, fields: str | Iterable[Field | str] = ("terrain", "sand_depth", "water_depth", "free_surface")) -> xarray.Dataset:
        """Fields of the state now as an xarray.Dataset with units and coordinates, those of the map where there is one. Needs xarray:
        wadi[xarray]."""
        from .dataset import of_world

        return of_world(self, fields)  # type: ignore[arg-type]

    # ---- Points ----

    def ask(self, points: ArrayLike) -> int:
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

    def answer(self, ticket: int) -> NDArray[np.void] | None:
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

    def query(self, points: ArrayLike) -> NDArray[np.void]:
        """The state at points after the steps asked for, waited for: an array of wadi.QUERY_DTYPE with the fields terrain, sand_depth,
        water_depth, surface [m], velocity [m/s], normal, saturation, inside (0 outside the grid). Points as `ask` takes them."""
        ticket = self.ask(points)
        self.wait()
        while (answers := self.answer(ticket)) is None:
            clock.sleep(1e-4)
        return answers
