"""Order between a world on CUDA and streams of CuPy, torch, JAX and others, through the driver (libcuda) alone."""
from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import byref, c_int, c_uint, c_uint64, c_void_p
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._library import NotSupportedError, check, native

if TYPE_CHECKING:
    from ._types import CudaArray
    from .world import World

#: The legacy default stream and the thread's own, as CUDA, DLPack and __cuda_array_interface__ number them.
LEGACY_STREAM: int = 1
PER_THREAD_STREAM: int = 2
_DEVICE_ORDINAL = 9  # CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL
_NO_TIMING = 2  # CU_EVENT_DISABLE_TIMING
_driver: ctypes.CDLL | None = None


def driver() -> ctypes.CDLL:
    """libcuda, ready for calls. Errors: NotSupportedError (this machine has no driver)."""
    global _driver
    if _driver is None:
        try:
            loaded = ctypes.CDLL("libcuda.so.1")
        except OSError as failed:
            raise NotSupportedError(f"CUDA's driver cannot be loaded: {failed}") from None
        _call(loaded.cuInit, c_uint(0))
        _driver = loaded
    return _driver


def _call(function: Any, *given: Any) -> None:
    status = function(*given)
    if status != 0:
        raise NotSupportedError(f"{function.__name__} of CUDA's driver failed with {status}")


def device_of(address: int) -> int:
    """Ordinal of the device on which an address lies."""
    ordinal = c_int()
    _call(driver().cuPointerGetAttribute, byref(ordinal), c_int(_DEVICE_ORDINAL), c_uint64(address))
    return ordinal.value


class _Context:
    """The primary context of a device, which worlds and CUDA's runtime use, current within a `with`."""

    def __init__(self, ordinal: int) -> None:
        self.device = c_int()
        _call(driver().cuDeviceGet, byref(self.device), c_int(ordinal))

    def __enter__(self) -> _Context:
        context = c_void_p()
        _call(driver().cuDevicePrimaryCtxRetain, byref(context), self.device)
        _call(driver().cuCtxPushCurrent_v2, context)
        return self

    def __exit__(self, *_: object) -> None:
        _call(driver().cuCtxPopCurrent_v2, byref(c_void_p()))
        _call(driver().cuDevicePrimaryCtxRelease_v2, self.device)


def _with_event(ordinal: int, use: Callable[[c_void_p], None]) -> None:
    with _Context(ordinal):
        event = c_void_p()
        _call(driver().cuEventCreate, byref(event), c_uint(_NO_TIMING))
        try:
            use(event)
        finally:
            _call(driver().cuEventDestroy_v2, event)


def _ordinal(world_id: _native.WorldId) -> int:
    """The device of a world, by an address of an output or, without one, the first device."""
    view = _native.OutputView()
    for output in range(_native.Output.COUNT):
        if native.wadi_world_get_view(world_id, output, _native.OutputSet.CURRENT, byref(view)) == 0:
            return device_of(view.handle)
    info = _native.WorldInfo()
    check(native.wadi_world_get_info(world_id, byref(info)))
    if info.backend != "cuda":
        raise NotSupportedError(f"the world is on {info.backend}: only worlds on cuda are ordered with streams")
    return 0


def signal(world: World | _native.WorldId, stream: int = LEGACY_STREAM) -> None:
    """The stream's next work comes behind all that the world has submitted. `world`: a World or its id; `stream`: a cudaStream_t as int."""
    world_id: Any = getattr(world, "id", world)

    def use(event: c_void_p) -> None:
        check(native.wadi_cuda_signal(world_id, event))
        _call(driver().cuStreamWaitEvent, c_void_p(stream), event, c_uint(0))

    _with_event(_ordinal(world_id), use)


def wait(world: World | _native.WorldId, stream: int = LEGACY_STREAM) -> None:
    """The world's next submission comes behind what the stream has been given so far: call it ahead of the update that writes over a view
    which the stream still reads."""
    world_id: Any = getattr(world, "id", world)

    def use(event: c_void_p) -> None:
        _call(driver().cuEventRecord, event, c_void_p(stream))
        check(native.wadi_cuda_wait(world_id, event))

    _with_event(_ordinal(world_id), use)


def write(world: World, field: _native.Field, region: _native.Region, values: CudaArray) -> None:
    """World.write of an array on the device."""
    given = values.__cuda_array_interface__
    shape, pitch = tuple(given["shape"]), None
    if shape != (region.ny, region.nx):
        raise ValueError(f"values: their shape is {shape}, must be {(region.ny, region.nx)}")
    if np.dtype(given["typestr"]) != np.float32:
        raise ValueError(f"values: their type is {given['typestr']}, must be <f4")
    if given.get("mask") is not None:
        raise ValueError("values: an array with a mask cannot be written")
    strides = given.get("strides") or (4 * shape[1], 4)
    pitch = strides[0]
    if strides[1] != 4 and shape[1] > 1 or pitch < 4 * shape[1] and shape[0] > 1:
        raise ValueError(f"values: their strides are {tuple(strides)}, must be (4 * nx or more, 4): rows from west to east without gaps")
    if world.backend != "cuda":
        raise NotSupportedError(f"values: an array on CUDA needs a world on cuda; this one is on {world.backend}")
    raw = _native.DeviceValues(handle_kind="cuda_pointer", handle=given["data"][0], row_pitch=pitch if shape[0] > 1 else 0)
    stream = given.get("stream")
    if stream is not None:
        wait(world, stream)
    check(native.wadi_world_write_region_from(world.id, field, byref(region), byref(raw)))
    # The values must stay until they are read: whoever frees or writes them does so behind the stream.
    signal(world, LEGACY_STREAM if stream is None else stream)
