"""What a world did over time, and the bar that shows how far it is."""
from __future__ import annotations

import contextlib
import importlib.util
import math
import sys
import time as clock
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .extras import need

if TYPE_CHECKING:
    from numpy.typing import NDArray
    import xarray

    from ._native import Field
    from ._types import Bar, Floats, Pair
    from .world import World


def progress_bar(progress: Bar, steps: int, name: str) -> contextlib.AbstractContextManager[Callable[[int], Any]]:
    """A context whose value is told how many more steps are done."""
    if progress is None:
        progress = importlib.util.find_spec("tqdm") is not None and sys.stderr is not None and sys.stderr.isatty()
    if not progress:
        return contextlib.nullcontext(lambda steps: None)
    bar = need("tqdm.auto", "progress", "progress=True").tqdm(total=steps, desc=name, unit=" steps", leave=False)

    @contextlib.contextmanager
    def shown() -> Iterator[Callable[[int], Any]]:
        with bar:
            yield bar.update

    return shown()


class Recording:
    """Fields and gauges of a world over time (World.record).

    times     [s], shape (n,)
    fields    by name: arrays of shape (n, ny, nx), float32, row 0 in the south
    gauges    by name: arrays of shape (n,) with the fields of wadi.QUERY_DTYPE ("water_depth", "surface", "velocity" ...)
    points    of the gauges, by name: (x, y) [m from the grid's corner]
    x, y      of the cells' centres [m from the grid's corner]; origin: what to add for map coordinates
    seconds   of the computer's time that it took
    """

    name: str
    dx: float
    x: NDArray[np.floating[Any]]
    y: NDArray[np.floating[Any]]
    origin: tuple[float, float]
    times: NDArray[np.float64]
    fields: dict[str, Floats]
    gauges: dict[str, NDArray[Any]]
    points: dict[str, tuple[float, ...]]
    seconds: float

    def __init__(self, name: str, dx: float, x: NDArray[np.floating[Any]], y: NDArray[np.floating[Any]],
                 origin: tuple[float, float], times: NDArray[np.float64], fields: dict[str, Floats], gauges: dict[str, NDArray[Any]],
                 points: dict[str, tuple[float, ...]], seconds: float) -> None:
        self.name, self.dx, self.x, self.y, self.origin = name, dx, x, y, origin
        self.times, self.fields, self.gauges, self.points, self.seconds = times, fields, gauges, points, seconds

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<wadi.Recording of {self.name!r}: {len(self)} times, fields {', '.join(self.fields)}, gauges {', '.join(self.gauges) or 'none'}>"

    @classmethod
    def of(cls, world: World, seconds: float, every: float, fields: str | Iterable[Field | str], gauges: Mapping[str, Pair],
           progress: Bar) -> Recording:
        for what, value in (("seconds", seconds), ("every", every)):
            if not (math.isfinite(value) and value >= 0):
                raise ValueError(f"{what}: {value!r}, must be 0 or more")
        stride = max(1, round(every / world.dt))
        count = round(seconds / world.dt) // stride + 1
        names = [fields] if isinstance(fields, str) else [str(name) for name in fields]
        kept = {name: np.empty((count, world.ny, world.nx), np.float32) for name in names}
        points = {name: tuple(map(float, point)) for name, point in gauges.items()}
        times, answers = np.empty(count), []
        begun = clock.perf_counter()
        with progress_bar(progress, (count - 1) * stride, world.name) as told:
            for n in range(count):
                if n:
                    world.step(stride)
                for name, values in kept.items():
                    world.read(name, out=values[n])
                if points:
                    answers.append(world.query(list(points.values())))
                times[n] = world.time
                if n:
                    told(stride)
        found = {name: np.array([answer[k] for answer in answers]) for k, name in enumerate(points)}
        return cls(world.name, world.dx, world.x, world.y, world.origin, times, kept, found, points, clock.perf_counter() - begun)

    def to_xarray(self) -> xarray.Dataset:
        """An xarray.Dataset with units and coordinates (needs xarray: wadi[xarray])."""
        from .dataset import of_recording

        return of_recording(self)
