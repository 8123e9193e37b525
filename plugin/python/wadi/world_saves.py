"""What a world keeps: snapshots, ways back, the command log; and looks inside."""
from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import byref, c_size_t, c_uint64
from typing import TYPE_CHECKING, Any

from . import _native
from ._library import check, encoded, fill, native, text_of
from ._native import Result
from ._struct import whole
from ._world import WorldBase

if TYPE_CHECKING:
    from ._types import StrPath


class Save:
    """A snapshot under way (World.begin_save). The world holds its memory until it has arrived."""

    _data: bytes | None

    def __init__(self, world: WorldBase) -> None:
        ticket, size = c_uint64(), c_size_t(0)
        check(native.wadi_world_save(world.id, None, byref(size)))
        check(native.wadi_world_begin_save(world.id, byref(ticket)))
        self._world, self._ticket = world, ticket.value
        self._room, self._data = ctypes.create_string_buffer(size.value), None
        world._pinned.add(self)

    def result(self) -> bytes | None:
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


class Saves(WorldBase):
    """Of a World: snapshots, ways back, the command log, looks inside."""

    # ---- Saving and going back ----

    def _bytes(self, call: Callable[..., int], *given: Any) -> bytes:
        size = c_size_t(0)
        check(call(*given, None, byref(size)))
        room = ctypes.create_string_buffer(max(1, size.value))
        check(call(*given, room, byref(size)))
        return room.raw[:size.value]

    def save(self) -> bytes:
        """The state as bytes, to the bit; the level and edits that wait are not in it. Waits for the steps."""
        return self._bytes(native.wadi_world_save, self.id)

    def load(self, snapshot: bytes | bytearray | memoryview) -> None:
        """Goes to a saved state of the same level, on whatever backend it was saved. Edits that wait are forgotten.
        Errors, the world as it was: BadFileError (no snapshot, newer, changed), BadArgumentError (of another level)."""
        data = bytes(snapshot)
        check(native.wadi_world_load(self.id, data, len(data)))

    def save_file(self, path: StrPath) -> None:
        """`save` to a file, replaced whole or not at all. Errors: NotFoundError, BadFileError."""
        check(native.wadi_world_save_file(self.id, encoded(path, "path")))

    def load_file(self, path: StrPath) -> None:
        """`load` from a file. Errors: NotFoundError, and those of `load`."""
        check(native.wadi_world_load_file(self.id, encoded(path, "path")))

    def begin_save(self) -> Save:
        """Asks for a snapshot without waiting: a wadi.Save, whose result() is None until it is there. Errors: NotReadyError (one is under
        way), OutOfMemoryError."""
        return Save(self)

    def snapshot_cost(self, snapshot: bytes | bytearray | memoryview) -> _native.Cost:
        """What `load` of these bytes would cost, as wadi.Cost."""
        return self._cost(native.wadi_world_get_snapshot_cost, snapshot)

    def _cost(self, call: Callable[..., int], data: bytes | bytearray | memoryview) -> _native.Cost:
        data, cost = bytes(data), _native.Cost()
        check(call(self.id, data, len(data), byref(cost)))
        return cost

    def set_rollback(self, frames: int, interval_steps: int = 1) -> None:
        """Keeps the newest `frames` (0 ... 256, 0 = off) states of steps that are multiples of interval_steps, on the device."""
        check(native.wadi_world_set_rollback(self.id, whole(frames, "frames", 0, 256), whole(interval_steps, "interval_steps", 1, 4294967295)))

    @property
    def rollback_steps(self) -> list[int]:
        """Steps that can be gone back to, oldest first."""
        return fill(native.wadi_world_get_rollback_steps, c_uint64, self.id)

    def roll_back(self, step: int) -> int:
        """Goes back to the newest kept step that is not after `step`; returns it. Errors: BadArgumentError (none that old is kept)."""
        reached = c_uint64()
        check(native.wadi_world_roll_back(self.id, whole(step, "step", 0, 2**64 - 1), byref(reached)))
        return reached.value

    # ---- Command log ----

    def set_command_log(self, on: bool = True) -> None:
        """True = remembers every edit, source, written region, trim and change of the material with its step; False = drops the log."""
        check(native.wadi_world_set_command_log(self.id, 1 if on else 0))

    def commands(self, since: int | None = None, player: int | None = None) -> bytes:
        """The log as bytes: all, or what counts ahead of step `since` or later, of one player or of every (None)."""
        if since is None and player is None:
            return self._bytes(native.wadi_world_get_commands, self.id)
        first = whole(since or 0, "since", 0, 2**64 - 1)
        who = _native.EVERY_PLAYER if player is None else whole(player, "player", 0, 4294967295)
        return self._bytes(native.wadi_world_get_commands_since, self.id, first, who)

    def play_commands(self, log: bytes | bytearray | memoryview) -> None:
        """Queues the commands of a log in a world of the same level; after the same steps both have the same hash.
        Errors, nothing queued: BadFileError, BadArgumentError (another level, or steps already done)."""
        data = bytes(log)
        check(native.wadi_world_play_commands(self.id, data, len(data)))

    def commands_cost(self, log: bytes | bytearray | memoryview) -> _native.Cost:
        """What play_commands of these bytes would cost, as wadi.Cost."""
        return self._cost(native.wadi_world_get_commands_cost, log)

    # ---- Looking inside ----

    def plan(self) -> str:
        """The plan as text: effects on and why, passes, buffers, bytes per cell."""
        return text_of(native.wadi_world_describe_plan, self.id)

    @property
    def effects(self) -> list[_native.EffectInfo]:
        """Effects with why each is on or off: a list of wadi.EffectInfo."""
        return fill(native.wadi_world_get_effects, _native.EffectInfo, self.id)

    @property
    def memory(self) -> list[_native.MemoryItem]:
        """Buffers on the device [bytes] by label; labels may repeat: a list of wadi.MemoryItem."""
        return fill(native.wadi_world_get_memory, _native.MemoryItem, self.id)

    def set_profiling(self, on: bool = True) -> None:
        """True = every step is timed from now on; see stage_timings."""
        check(native.wadi_world_set_profiling(self.id, 1 if on else 0))

    @property
    def stage_timings(self) -> list[_native.StageTiming]:
        """Mean times since set_profiling: a list of wadi.StageTiming, milliseconds per water step."""
        return fill(native.wadi_world_get_stage_timings, _native.StageTiming, self.id)

    def set_checking(self, on: bool = True) -> None:
        """True = the whole state is verified after every step (InternalError names step, field and cell); slow."""
        check(native.wadi_world_set_checking(self.id, 1 if on else 0))

    def check(self) -> None:
        """Raises what broke the world for good (DeviceLostError)."""
        check(native.wadi_world_get_error(self.id))
