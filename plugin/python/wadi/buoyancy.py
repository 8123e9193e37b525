"""Bodies that float."""
from __future__ import annotations

from ctypes import POINTER, byref, c_float, c_uint32, cast
from typing import TYPE_CHECKING, Any

import numpy as np

from ._library import check, native
from ._native import Body, QueryResult

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._types import Floats


def buoyancy_points(body: Body) -> Floats:
    """Points to ask a world for (World.ask, World.query) for a wadi.Body: an array of shape (n, 2), x and y [m].
    Errors: BadArgumentError names the field of the body."""
    count = c_uint32()
    check(native.wadi_buoyancy_points(byref(body), None, byref(count)))
    xy = np.empty((count.value, 2), np.float32)
    check(native.wadi_buoyancy_points(byref(body), xy.ctypes.data, byref(count)))
    return xy


def buoyancy_force(body: Body, answers: NDArray[Any]) -> tuple[Floats, Floats]:
    """Force [N] and torque about the body's middle [N m] of the water, arrays of 3, from the answers for those points. The body's weight is
    not in them. Errors: BadArgumentError (a field of the body, answers of another number)."""
    force, torque = (c_float * 3)(), (c_float * 3)()
    results = cast(np.ascontiguousarray(answers).ctypes.data, POINTER(QueryResult))
    check(native.wadi_buoyancy_force(byref(body), results, len(answers), force, torque))
    return np.array(force), np.array(torque)
