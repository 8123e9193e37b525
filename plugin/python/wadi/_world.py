"""What the parts of a World know of it."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import _native
    from .world_saves import Save


class WorldBase:
    """What every part of a World may use; World says what it means."""

    id: _native.WorldId
    nx: int
    ny: int
    dx: float
    backend: str
    _handle: Any
    _pinned: set[Save]  # memory that the library writes
    _mask: int
    _host_mask: int
    _row: tuple[int, int]

    if TYPE_CHECKING:
        @property
        def info(self) -> _native.WorldInfo: ...

        def update(self, seconds: float) -> _native.Frame: ...

        def wait(self) -> None: ...
