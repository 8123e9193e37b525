"""Types that annotations of several files name."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Callable, Literal, Optional, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from ._native import Region

#: A file or a folder by its name.
StrPath = Union[str, "os.PathLike[str]"]
#: Files that a level's text names: their folder, their bytes by name, or a function that gives them.
Files = Union[StrPath, Mapping[str, bytes], Callable[[str], Optional[bytes]]]
#: Values of cells or points.
Floats = NDArray[np.float32]
#: (x, y) [m], or (east, north) [m/s].
Pair = Iterable[float]
#: Cells of a grid: (i0, j0, nx, ny).
Cells = Union[Region, Iterable[int]]
#: A bar of progress: with, without, or where somebody can see it.
Bar = Optional[bool]
#: A layer by its name in lower case.
LayerName = Literal["terrain", "sand", "water"]


class CudaArray(Protocol):
    """An array in the memory of a CUDA device, as CuPy, torch and JAX have them."""

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]: ...
