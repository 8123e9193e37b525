"""Fields as xarray has them: with units and coordinates, by the CF conventions."""
from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._native import Field
from ._struct import member
from .extras import need

if TYPE_CHECKING:
    import xarray

    from .recording import Recording
    from .world import World

_METRES = ("TERRAIN", "SAND_DEPTH", "TOTAL_WATER_DEPTH", "WATER_DEPTH", "FREE_SURFACE")
_TEXTS = {"TERRAIN": "elevation of the ground", "SAND_DEPTH": "depth of sand", "TOTAL_WATER_DEPTH": "depth of all water, above and in the sand",
          "WATER_DEPTH": "depth of water above the sand", "FREE_SURFACE": "elevation of the visible surface",
          "SATURATION": "share of water in sand", "LIMITS": "which limits hold the cell, bits of wadi.Limit"}


def _attributes(field: Field | str) -> dict[str, str]:
    name = member(Field, field, "field").name
    text = _TEXTS.get(name, name.lower().replace("_", " "))
    unit = "m" if name in _METRES else "m s-1" if "VELOCITY" in name else "1"
    return {"units": unit, "long_name": text}


def _grid(found: World | Recording) -> dict[str, Any]:
    axis = {"units": "m"}
    if tuple(found.origin) == (0, 0):
        return {"x": ("x", found.x, {**axis, "long_name": "east of the grid's corner"}),
                "y": ("y", found.y, {**axis, "long_name": "north of the grid's corner"})}
    return {"x": ("x", found.x + found.origin[0], {**axis, "long_name": "easting", "standard_name": "projection_x_coordinate"}),
            "y": ("y", found.y + found.origin[1], {**axis, "long_name": "northing", "standard_name": "projection_y_coordinate"})}


def of_world(world: World,
             fields: str | Iterable[Field | str] = ("terrain", "sand_depth", "water_depth", "free_surface")) -> xarray.Dataset:
    """World.to_xarray."""
    xarray = need("xarray", "xarray", "to_xarray")
    names = [fields] if isinstance(fields, str) else list(fields)
    data = {str(name): (("y", "x"), world.read(name), _attributes(name)) for name in names}
    return xarray.Dataset(data,  # type: ignore[no-any-return]
                          coords={**_grid(world), "time": ((), world.time, {"units": "s", "long_name": "simulated time"})},
                          attrs={"title": world.name, "source": "Wadi", "Conventions": "CF-1.10", "cell_size_m": world.dx})


def of_recording(recording: Recording) -> xarray.Dataset:
    """Recording.to_xarray."""
    xarray = need("xarray", "xarray", "to_xarray")
    data: dict[str, Any] = {name: (("time", "y", "x"), values, _attributes(name)) for name, values in recording.fields.items()}
    coords = {**_grid(recording), "time": ("time", recording.times, {"units": "s", "long_name": "simulated time"})}
    if recording.gauges:
        places = np.array(list(recording.points.values())) + np.asarray(recording.origin)
        coords.update(gauge=("gauge", list(recording.gauges)), gauge_x=("gauge", places[:, 0], {"units": "m"}), gauge_y=("gauge", places[:, 1], {"units": "m"}))
        for name, unit in (("water_depth", "m"), ("surface", "m"), ("sand_depth", "m")):
            series = np.stack([gauge[name] for gauge in recording.gauges.values()], axis=1)
            data[f"gauge_{name}"] = (("time", "gauge"), series, {"units": unit})
    return xarray.Dataset(data, coords=coords,  # type: ignore[no-any-return]
                          attrs={"title": recording.name, "source": "Wadi", "Conventions": "CF-1.10", "cell_size_m": recording.dx})
