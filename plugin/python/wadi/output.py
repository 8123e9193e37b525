"""Outputs in a world's own memory: NumPy's and CUDA's array interfaces and DLPack over them."""
from __future__ import annotations

import ctypes
from collections.abc import Iterable
from ctypes import CFUNCTYPE, POINTER, PYFUNCTYPE, Structure, c_char_p, c_int, c_int32, c_int64, c_uint8, c_uint16, c_uint64, c_void_p, py_object
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ._native import HandleKind, Output
from ._struct import member

if TYPE_CHECKING:
    from . import _native

_CHANNELS = {Output.FLOW: 2, Output.SAND_VELOCITY: 2, Output.NORMAL: 4, Output.PACKED: 4, Output.PACKED_HALF: 4}
_CPU, _CUDA = 1, 2  # DLDeviceType


def bits_of(names: Output | int | str | Iterable[Output | int | str], what: str) -> int:
    """A mask from one output, or from several."""
    names = [names] if isinstance(names, (str, int)) else names
    mask = 0
    for name in names:
        mask |= 1 << member(Output, name, what)
    return mask


def layout_of(output: Output, ny: int, nx: int, pitch: int) -> tuple[np.dtype[Any], tuple[int, ...], tuple[int, ...]]:
    """(dtype, shape, strides) of an output whose rows lie `pitch` bytes apart."""
    dtype = np.dtype("<f2" if output == Output.PACKED_HALF else "<f4")
    n = _CHANNELS.get(output, 1)
    if n == 1:
        return dtype, (ny, nx), (pitch, dtype.itemsize)
    return dtype, (ny, nx, n), (pitch, n * dtype.itemsize, dtype.itemsize)


class _Device(Structure):
    _fields_ = [("type", c_int32), ("id", c_int32)]


class _Tensor(Structure):
    _fields_ = [("data", c_void_p), ("device", _Device), ("ndim", c_int32), ("code", c_uint8), ("bits", c_uint8), ("lanes", c_uint16),
                ("shape", POINTER(c_int64)), ("strides", POINTER(c_int64)), ("byte_offset", c_uint64)]


class _Managed(Structure):
    _fields_ = [("tensor", _Tensor), ("context", c_void_p), ("deleter", c_void_p)]


_lent: dict[int, Any] = {}  # what consumers of DLPack hold, by the address of its _Managed


@CFUNCTYPE(None, c_void_p)  # type: ignore[untyped-decorator]
def _returned(address: int) -> None:
    _lent.pop(address, None)


_api = ctypes.pythonapi
_new_capsule = PYFUNCTYPE(py_object, c_void_p, c_char_p, c_void_p)(("PyCapsule_New", _api))
_is_capsule = PYFUNCTYPE(c_int, c_void_p, c_char_p)(("PyCapsule_IsValid", _api))
_in_capsule = PYFUNCTYPE(c_void_p, c_void_p, c_char_p)(("PyCapsule_GetPointer", _api))
_NAME = c_char_p(b"dltensor")  # consumers rename it once they own the tensor


@PYFUNCTYPE(None, c_void_p)  # type: ignore[untyped-decorator]
def _unwanted(capsule: int) -> None:
    if _is_capsule(capsule, _NAME):
        _lent.pop(_in_capsule(capsule, _NAME), None)


class OutputView:
    """An output where the world has it. np.asarray(view) on the CPU, cupy.asarray(view) or torch.from_dlpack(view) on CUDA share its
    memory; nothing is copied. JAX takes no rows with gaps between them: give it cupy.ascontiguousarray(cupy.asarray(view)). Read only: what you write there is lost or harms nothing but
    pictures. The memory lives as long as any of them; what it shows stays until the second next update.

    output, step (water steps done in what it shows), shape (ny, nx) or (ny, nx, n), dtype, strides [bytes], address.
    """

    output: Output
    step: int
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    strides: tuple[int, ...]
    address: int
    on_cuda: bool

    def __init__(self, handle: Any, output: Output, raw: _native.OutputView) -> None:
        self._handle = handle
        self.output, self.step = output, raw.step
        self.dtype, self.shape, self.strides = layout_of(output, raw.ny, raw.nx, raw.row_pitch)
        self.address = raw.handle + raw.offset
        self.on_cuda = raw.handle_kind == HandleKind.CUDA_POINTER
        handle.views.add(self)

    def __repr__(self) -> str:
        return f"<wadi.OutputView {self.output.name.lower()} {self.shape} at step {self.step}, {'cuda' if self.on_cuda else 'cpu'}>"

    def _interface(self) -> dict[str, Any]:
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (self.address, True), "version": 3, "strides": self.strides}

    @property
    def __array_interface__(self) -> dict[str, Any]:
        """NumPy's, version 3: on the CPU alone. The array's base is this view."""
        if self.on_cuda:
            raise AttributeError("__array_interface__: this view is on CUDA")
        return self._interface()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NoReturn:
        raise TypeError("a view on CUDA is no NumPy array: ask for the output with set_outputs(..., host=True) and take output()")

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        """Version 3. The legacy default stream, which it names, waits for what the world has submitted."""
        if not self.on_cuda:
            raise AttributeError("__cuda_array_interface__: this view is on the CPU")
        from . import cuda

        cuda.signal(self._handle.world, cuda.LEGACY_STREAM)
        return {**self._interface(), "stream": cuda.LEGACY_STREAM}

    def __dlpack_device__(self) -> tuple[int, int]:
        if not self.on_cuda:
            return _CPU, 0
        from . import cuda

        return _CUDA, cuda.device_of(self.address)

    def __dlpack__(self, *, stream: int | None = None, max_version: tuple[int, int] | None = None, dl_device: tuple[int, int] | None = None,
                   copy: bool | None = None) -> Any:
        """A DLPack capsule that shares the memory. On CUDA `stream` (None or 1: the legacy default stream, 2: the thread's, -1: no order,
        else a cudaStream_t) waits for what the world has submitted. Errors: BufferError (another device, copy=True)."""
        del max_version  # the oldest form of the capsule, which every consumer takes
        device = self.__dlpack_device__()
        if dl_device is not None and tuple(dl_device) != device or copy:
            raise BufferError("__dlpack__: this view shares memory on its own device; it makes no copies")
        if self.on_cuda:
            if stream != -1:
                from . import cuda

                cuda.signal(self._handle.world, cuda.LEGACY_STREAM if stream is None else stream)
        elif stream is not None:
            raise BufferError("__dlpack__: there are no streams on the CPU")
        size = self.dtype.itemsize
        shape = (c_int64 * len(self.shape))(*self.shape)
        strides = (c_int64 * len(self.shape))(*(stride // size for stride in self.strides))
        managed = _Managed(tensor=_Tensor(data=self.address, device=_Device(*device), ndim=len(self.shape), code=2, bits=8 * size, lanes=1,
                                          shape=shape, strides=strides), deleter=ctypes.cast(_returned, c_void_p).value)
        address = ctypes.addressof(managed)
        _lent[address] = (self, managed, shape, strides)
        return _new_capsule(address, _NAME, ctypes.cast(_unwanted, c_void_p))

