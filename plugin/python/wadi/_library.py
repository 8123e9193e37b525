"""Finds and loads the library, turns its results into exceptions, and holds what needs no world."""
from __future__ import annotations

import ctypes
import os
import pathlib
from collections.abc import Callable
from ctypes import byref, c_char_p, c_uint32, create_string_buffer
from typing import TYPE_CHECKING, Any, Literal

from . import _native
from ._native import Result

if TYPE_CHECKING:
    from ._types import StrPath

_folder = pathlib.Path(__file__).resolve().parent


class Error(Exception):
    """What the library refused. `result` is its wadi_result; the message names the field and its range where there is one."""

    result: Result = Result.ERROR_INTERNAL


class BadArgumentError(Error, ValueError):
    """A value is wrong; the message names it and its range. Also a world that is closed."""

    result = Result.ERROR_BAD_ARGUMENT


class NotFoundError(Error, LookupError):
    """No such file, level, backend, device or effect."""

    result = Result.ERROR_NOT_FOUND


class BadFileError(Error, ValueError):
    """A file, a level's text, a snapshot or a log is malformed, or asks for more than its host allows; the message names the field."""

    result = Result.ERROR_BAD_FILE


class NotSupportedError(Error):
    """This build or device cannot do it."""

    result = Result.ERROR_NOT_SUPPORTED


class OutOfMemoryError(Error, MemoryError):
    """The device's or the host's memory ends. A world that runs out of the host's must be closed, unless the call says otherwise."""

    result = Result.ERROR_OUT_OF_MEMORY


class DeviceLostError(Error):
    """The device is lost: close the world and make another."""

    result = Result.ERROR_DEVICE_LOST


class InternalError(Error):
    """A bug of Wadi's, or what set_checking(True) found: please report the message."""

    result = Result.ERROR_INTERNAL


class NotReadyError(Error):
    """Nothing is there yet: ask again later."""

    result = Result.NOT_READY


class BusyError(Error):
    """Another thread is inside a call on this world; nothing was done."""

    result = Result.ERROR_BUSY


class CancelledError(Error):
    """The progress callback ended the call; nothing was made."""

    result = Result.CANCELLED


_errors = {kind.result: kind for kind in Error.__subclasses__()}


def _find() -> pathlib.Path:
    named = os.environ.get("WADI_LIBRARY")
    path = pathlib.Path(named) if named else _folder / "lib" / "libwadi.so.1"
    if not path.exists():
        hint = "WADI_LIBRARY names it" if named else "install the wheel, or name a built libwadi.so in the environment variable WADI_LIBRARY"
        raise ImportError(f"wadi: there is no library {path}: {hint}")
    return path.resolve()


def _load(path: pathlib.Path) -> ctypes.CDLL:
    library = ctypes.CDLL(str(path))
    found = library.wadi_get_abi_version()
    if found != _native.ABI_VERSION:
        raise ImportError(f"wadi: {path} has ABI version {found}, this package wants {_native.ABI_VERSION}")
    library.wadi_get_version.restype = c_uint32
    if library.wadi_get_version() < _native.VERSION:
        raise ImportError(f"wadi: {path} is older than this package")
    for name, (returns, takes) in _native.CALLS.items():
        call = getattr(library, name)
        call.restype, call.argtypes = returns, takes
    return library


path: pathlib.Path = _find()
native: ctypes.CDLL = _load(path)


def check(result: int) -> None:
    """Raises what a call returned, where that is not OK."""
    if result:
        raise error(result)


def error(result: int) -> Error:
    """The exception of a result, with the library's text."""
    result = Result(result)
    text = native.wadi_get_last_error().decode("utf-8", "replace")
    return _errors[result](text if result != Result.NOT_READY else text or "not ready")


def fill(call: Callable[..., int], kind: type[Any], *given: Any) -> list[Any]:
    """A list of structs from a call that takes (..., array, count)."""
    count = c_uint32(0)
    check(call(*given, None, byref(count)))
    items = (kind * max(1, count.value))()
    if hasattr(kind, "struct_size"):
        for item in items:
            item.struct_size = ctypes.sizeof(kind)
    check(call(*given, items, byref(count)))
    return list(items)[:count.value]


def text_of(call: Callable[..., int], *given: Any) -> str:
    """A text from a call that takes (..., text, size) and returns its length."""
    length = call(*given, None, 0)
    if length == 0:
        raise error(Result.ERROR_BAD_ARGUMENT)
    room = create_string_buffer(length + 1)
    call(*given, room, length + 1)
    return room.value.decode("utf-8", "replace")


def version() -> str:
    """The version of the library that is loaded, as "0.1.0"."""
    number = native.wadi_get_version()
    return f"{number >> 22}.{number >> 12 & 1023}.{number & 4095}"


def devices() -> tuple[list[_native.DeviceInfo], str]:
    """Devices of all backends of the library: a list of wadi.DeviceInfo, and a text with one line for each backend that has none."""
    count = c_uint32(0)
    notes = create_string_buffer(4096)
    check(native.wadi_list_devices(None, byref(count), notes, len(notes)))
    infos = (_native.DeviceInfo * max(1, count.value))(*(_native.DeviceInfo() for _ in range(count.value)))
    check(native.wadi_list_devices(infos, byref(count), None, 0))
    return list(infos)[:count.value], notes.value.decode("utf-8", "replace")


def accuracy_presets() -> list[_native.AccuracyPreset]:
    """Names that the keyword `accuracy` takes, by rising accuracy, as a list of wadi.AccuracyPreset."""
    return fill(native.wadi_list_accuracy_presets, _native.AccuracyPreset)


def describe(table: Literal["settings", "effects", "fields", "stages", "schema"]) -> str:
    """A table of the library as text: "settings" (keys of level files with unit, range, default), "effects", "fields", "stages", or
    "schema" (the settings as JSON)."""
    return text_of(native.wadi_describe_table, str(table).encode())


def field_name(field: int) -> str:
    """Short name of a field that tools use: "hs", "W", "hw" ..."""
    return native.wadi_field_name(int(field)).decode()  # type: ignore[no-any-return]


def folder_of(what: str) -> pathlib.Path:
    """A folder beside the library: "bin", or "share/wadi/levels" of a wheel."""
    return path.parent.parent / what


def levels() -> dict[str, pathlib.Path]:
    """The levels that come along: their file by name, as {"canyon": Path(".../canyon/level.json"), ...}. World takes such a file."""
    shipped = folder_of("share/wadi/levels")
    if not shipped.is_dir():  # a source tree
        shipped = _folder.parents[2] / "samples" / "levels"
    found = {file.parent.name: file for file in sorted(shipped.glob("*/level.json"))}
    if not found:
        raise NotFoundError(f"no levels in {shipped}")
    return found


def program(name: str) -> pathlib.Path:
    """The program of that name which comes along: "wadi-recorder", "wadi-import", "wadi-tune", "wadi-viewer".
    NotFoundError where this wheel or build has none."""
    file = folder_of("bin") / name
    if not file.is_file():
        raise NotFoundError(f"{name} is not in {file.parent}: this build of Wadi has no such program")
    return file


def encoded(text: StrPath, what: str) -> c_char_p:
    """A text for the library; ValueError that names `what` where it holds a zero character."""
    data: str | bytes = os.fspath(text)
    data = data if isinstance(data, bytes) else data.encode("utf-8", "surrogateescape")
    if b"\0" in data:
        raise ValueError(f"{what}: a text may hold no zero character")
    return c_char_p(data)
