"""Pictures by matplotlib (wadi[plot]): map, section, hydrograph, animation. `source` is a World (its state now) or a Recording; of a recording
`frame` says which of its times, -1 is the last. Each takes axes `ax`, or makes a figure, and returns the axes."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .extras import need
from .recording import Recording

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from .world import World


def _axes(ax: Axes | None, size: tuple[float, float] = (6.4, 4.0)) -> Any:
    pyplot = need("matplotlib.pyplot", "plot", "wadi.plot")
    return pyplot.subplots(figsize=size, constrained_layout=True)[1] if ax is None else ax


def _field(source: World | Recording, name: str, frame: int) -> Any:
    if not isinstance(source, Recording):
        return source.read(name)
    if name not in source.fields:
        raise KeyError(f"{name!r} was not recorded; fields=[...] of record() had {', '.join(source.fields)}")
    return source.fields[name][frame]


def _time(source: World | Recording, frame: int) -> float:
    return source.times[frame] if isinstance(source, Recording) else source.time


def _extent(source: World | Recording) -> tuple[float, float, float, float]:
    (x0, y0), half = source.origin, source.dx / 2
    return x0 + source.x[0] - half, x0 + source.x[-1] + half, y0 + source.y[0] - half, y0 + source.y[-1] + half


def relief(heights: ArrayLike, dx: float, azimuth: float = 315.0, altitude: float = 45.0) -> NDArray[np.float64]:
    """Shade of a surface [m] lit from `azimuth` (degrees from north by east) at `altitude` degrees: an array of 0 ... 1."""
    south, east = np.gradient(np.asarray(heights, float), dx)
    azimuth, altitude = np.radians(azimuth), np.radians(altitude)
    sun = np.array([np.sin(azimuth) * np.cos(altitude), np.cos(azimuth) * np.cos(altitude), np.sin(altitude)])
    return np.clip((-east * sun[0] - south * sun[1] + sun[2]) / np.sqrt(1 + east**2 + south**2), 0, 1)  # type: ignore[no-any-return]


def map(source: World | Recording, field: str | Iterable[str] = "water_depth", *, frame: int = -1, ax: Axes | None = None, cmap: Any = None,
        vmin: float | None = None, vmax: float | None = None, dry: float = 1e-3, colorbar: bool = True) -> Axes:
    """A field from above over shaded ground, or several, the later above: ["sand_depth", "water_depth"]. Of depths, cells below `dry` [m]
    show what is under them. cmap, vmin, vmax as of imshow; the bar is of the last field."""
    ax = _axes(ax)
    extent, fields = _extent(source), [field] if isinstance(field, str) else list(field)
    ground = None
    if not isinstance(source, Recording):
        ground = source.read("terrain") + (source.read("sand_depth") if "sand_depth" not in fields else 0)
    elif "terrain" in source.fields:
        ground = source.fields["terrain"][frame]
    if ground is not None:
        ax.imshow(relief(ground, source.dx), origin="lower", extent=extent, cmap="Greys_r", vmin=-0.3, vmax=1.1)
    for field in fields:
        values, depth = _field(source, field, frame), field.endswith("_depth")
        shown = np.ma.masked_less(values, dry) if depth else values
        colours = cmap or ("Blues" if "water" in field else "YlOrBr" if "sand" in field else "terrain" if field in ("terrain", "free_surface") else "viridis")
        image = ax.imshow(shown, origin="lower", extent=extent, cmap=colours, vmin=0 if depth and vmin is None else vmin, vmax=vmax,
                          interpolation="nearest", alpha=0.85 if ground is not None else 1)
    if colorbar:
        unit = " [m]" if depth or field in ("terrain", "free_surface") else " [m/s]" if "velocity" in field else ""
        ax.figure.colorbar(image, ax=ax, label=field.replace("_", " ") + unit, shrink=0.85)  # type: ignore[union-attr]
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(f"{source.name}, t = {_time(source, frame):.4g} s")
    return ax


def section(source: World | Recording, *, y: float | None = None, x: float | None = None, frame: int = -1, ax: Axes | None = None,
            exaggeration: float | None = None) -> Axes:
    """Ground, sand and water along a row (y) or a column (x) [m from the grid's corner]; the middle row where neither is given.
    Of a recording, fields terrain, sand_depth and water_depth must be in it. exaggeration: of heights; None = what fits."""
    if x is not None and y is not None:
        raise TypeError("section: x or y, not both")
    ax = _axes(ax, (6.4, 3.0))
    along = source.x if x is None else source.y
    across = source.y if x is None else source.x
    at = (across[len(across) // 2] if y is None else y) if x is None else x
    k = int(np.argmin(np.abs(across - at)))
    if not across[0] - source.dx <= at <= across[-1] + source.dx:
        raise ValueError(f"section: {at} m, must lie in 0 ... {across[-1] + source.dx / 2:g} m")
    cut: Callable[[Any], Any] = (lambda plane: plane[k]) if x is None else (lambda plane: plane[:, k])
    ground, sand, water = (cut(_field(source, name, frame)).astype(float) for name in ("terrain", "sand_depth", "water_depth"))
    low = ground.min() - 0.08 * max(np.ptp(ground + sand + water), 1e-9)
    ax.fill_between(along, low, ground, color="0.55", lw=0, label="ground", step=None)
    ax.fill_between(along, ground, ground + sand, color="#d2a85a", lw=0, label="sand")
    ax.fill_between(along, ground + sand, ground + sand + water, color="#4f8fd0", lw=0, label="water")
    ax.set_xlim(along[0], along[-1])
    ax.set_ylim(low, None)
    if exaggeration is not None:
        ax.set_aspect(exaggeration)
    ax.set_xlabel(f"{'x' if x is None else 'y'} [m]")
    ax.set_ylabel("z [m]")
    ax.set_title(f"{source.name}, {'y' if x is None else 'x'} = {across[k]:.4g} m, t = {_time(source, frame):.4g} s")
    ax.legend(loc="upper right", fontsize="small")
    return ax


def hydrograph(recording: Recording, value: Literal["water_depth", "surface", "sand_depth", "speed"] = "water_depth", *,
               gauges: Iterable[str] | None = None, ax: Axes | None = None) -> Axes:
    """What the gauges of a recording show over time: "water_depth", "surface", "sand_depth" [m], or "speed" of the water [m/s].
    gauges: their names; None = all."""
    if not recording.gauges:
        raise ValueError("hydrograph: the recording has no gauges; record(..., gauges={'bridge': (x, y)})")
    ax = _axes(ax, (6.4, 3.2))
    for name in gauges or recording.gauges:
        answers = recording.gauges[name]
        series = np.hypot(*answers["velocity"].T) if value == "speed" else answers[value]
        ax.plot(recording.times, series, label=name)
    ax.set_xlabel("t [s]")
    ax.set_ylabel("speed of water [m/s]" if value == "speed" else f"{value.replace('_', ' ')} [m]")
    ax.set_xlim(recording.times[0], recording.times[-1])
    ax.grid(alpha=0.3)
    ax.legend(fontsize="small")
    return ax


def animation(recording: Recording, field: str = "water_depth", *, interval: int = 80, **options: Any) -> FuncAnimation:
    """A matplotlib animation of a recorded field; `options` as of `map`, interval between frames [ms]. Keep what it returns: to_jshtml()
    shows it in a notebook, save("a.gif", writer="pillow") writes it."""
    animate = need("matplotlib.animation", "plot", "wadi.plot")
    values = recording.fields[field]
    options.setdefault("vmax", float(values.max()) or 1.0)
    ax = map(recording, field, frame=0, **options)
    image, dry = ax.images[-1], options.get("dry", 1e-3)

    def draw(frame: int) -> tuple[Any]:
        image.set_data(np.ma.masked_less(values[frame], dry) if field.endswith("_depth") else values[frame])
        ax.set_title(f"{recording.name}, t = {recording.times[frame]:.4g} s")
        return (image,)

    return animate.FuncAnimation(ax.figure, draw, frames=len(recording), interval=interval, blit=False)  # type: ignore[no-any-return]
