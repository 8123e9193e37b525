"""Maps of heights: levels of them, GeoTIFF in and out."""
from __future__ import annotations

import os
import pathlib
import subprocess
import tempfile
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._library import BadFileError, program
from .extras import need

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import Floats, StrPath

_HOLE = -9999.0


class HeightMap:
    """A map in memory. heights [m], shape (ny, nx), row 0 in the south, NaN where it has holes; dx: width of a cell [m]; origin: (x, y) of
    the south-west corner in the map's coordinates [m]; crs: the map's coordinate system as text (WKT), or None."""

    heights: Floats
    dx: float
    origin: tuple[float, float]
    crs: str | None

    def __init__(self, heights: Floats, dx: float, origin: tuple[float, float], crs: str | None) -> None:
        self.heights, self.dx, self.origin, self.crs = heights, dx, origin, crs

    def __repr__(self) -> str:
        return f"<wadi.HeightMap: {self.heights.shape[1]} x {self.heights.shape[0]} cells of {self.dx:g} m, origin {self.origin}>"


def read_geotiff(path: StrPath, cell: float | None = None, band: int = 1) -> HeightMap:
    """A GeoTIFF, or anything else that rasterio opens, as HeightMap. Needs rasterio: wadi[maps].
    A map in degrees, with cells that are not square, turned, or with another `cell` [m] than asked for is resampled (bilinear) to square
    cells of metres, one in degrees to the UTM zone of its middle. band: from 1 on.
    Errors: BadFileError (cannot be read, has no such band, says nothing of its cells)."""
    rasterio = need("rasterio", "maps", "read_geotiff")
    warp = need("rasterio.warp", "maps", "read_geotiff")
    try:
        with rasterio.open(path) as opened:
            if not 1 <= band <= opened.count:
                raise BadFileError(f"{path}: band {band}, must be 1 ... {opened.count}")
            masked = opened.read(band, masked=True)
            crs, step, bounds = opened.crs, opened.transform, opened.bounds
    except rasterio.errors.RasterioIOError as failed:
        raise BadFileError(f"{path}: {failed}") from None
    values = np.ma.filled(masked.astype(np.float32), np.nan)
    if step.is_identity:
        raise BadFileError(f"{path}: it does not say where it lies and how large its cells are")
    degrees = crs is not None and crs.is_geographic
    square = step.b == step.d == 0 and step.a > 0 > step.e and abs(step.a + step.e) < 1e-6 * step.a
    if degrees or not square or cell is not None and abs(cell - step.a) > 1e-9 * cell:
        target = crs
        if degrees:
            east, north = (bounds.left + bounds.right) / 2, (bounds.bottom + bounds.top) / 2
            target = rasterio.crs.CRS.from_epsg((32600 if north >= 0 else 32700) + int((east + 180) // 6) % 60 + 1)
        source = crs if crs is not None else rasterio.crs.CRS.from_epsg(32631)  # some metres: the same on both sides
        target = target if target is not None else source
        around = warp.calculate_default_transform(source, target, values.shape[1], values.shape[0], *bounds, resolution=cell)
        if cell is None and abs(around[0].a + around[0].e) > 1e-9 * around[0].a:
            around = warp.calculate_default_transform(source, target, values.shape[1], values.shape[0], *bounds, resolution=around[0].a)
        moved = np.full((around[2], around[1]), np.nan, np.float32)
        warp.reproject(values, moved, src_transform=step, src_crs=source, src_nodata=np.nan, dst_transform=around[0], dst_crs=target,
                       dst_nodata=np.nan, resampling=warp.Resampling.bilinear)
        values, step, crs = moved, around[0], target if crs is not None else None
    origin = (step.c, step.f + step.e * values.shape[0])
    return HeightMap(np.ascontiguousarray(values[::-1]), float(step.a), origin, None if crs is None else crs.to_wkt())


def write_geotiff(path: StrPath, values: ArrayLike | dict[str, Any], dx: float, origin: tuple[float, float] = (0.0, 0.0),
                  crs: object = None, unit: str = "m", name: str | None = None) -> None:
    """Writes arrays as a GeoTIFF of floats, NaN as holes. Needs rasterio: wadi[maps].
    values: shape (ny, nx), row 0 in the south, or a dict of such arrays by name, a band each. dx: width of a cell [m]; origin: map
    coordinates of the south-west corner [m] (World.origin); crs: what rasterio takes ("EPSG:32632", the crs of a HeightMap), or None.
    unit, name: of the band. Errors: ValueError (shapes)."""
    rasterio = need("rasterio", "maps", "write_geotiff")
    affine = need("rasterio.transform", "maps", "write_geotiff")
    bands = values if isinstance(values, dict) else {name or "value": values}
    planes = [np.asarray(plane, np.float32) for plane in bands.values()]
    shape = planes[0].shape
    if len(shape) != 2 or any(plane.shape != shape for plane in planes):
        raise ValueError(f"values: their shapes are {[plane.shape for plane in planes]}, must be one of (ny, nx)")
    step = affine.from_origin(origin[0], origin[1] + shape[0] * dx, dx, dx)
    with rasterio.open(path, "w", driver="GTiff", width=shape[1], height=shape[0], count=len(planes), dtype="float32", nodata=np.nan, crs=crs,
                       transform=step, compress="deflate") as opened:
        for number, (label, plane) in enumerate(zip(bands, planes), 1):
            opened.write(plane[::-1], number)
            opened.set_band_description(number, label)
        opened.units = [unit] * len(planes)


def write_asc(path: StrPath, values: ArrayLike, dx: float, origin: tuple[float, float] = (0.0, 0.0)) -> None:
    """Writes an array (ny, nx), row 0 in the south, as an Esri ASCII grid, NaN as holes. Arguments as those of write_geotiff."""
    plane = np.asarray(values, np.float32)
    if plane.ndim != 2:
        raise ValueError(f"values: their shape is {plane.shape}, must be (ny, nx)")
    head = (f"ncols {plane.shape[1]}\nnrows {plane.shape[0]}\nxllcorner {origin[0]!r}\nyllcorner {origin[1]!r}\ncellsize {dx!r}\n"
            f"NODATA_value {_HOLE:g}")
    np.savetxt(path, np.where(np.isnan(plane), _HOLE, plane)[::-1], fmt="%.9g", header=head, comments="")


def import_map(path: StrPath, folder: StrPath | None = None, *, cell: float | None = None, size: tuple[int, int] | None = None,
               low: float | None = None, high: float | None = None, packed: Literal["terrarium", "mapbox"] | None = None,
               flip: Literal["x", "y", "xy"] | None = None, samples: Literal["cells", "corners"] | None = None,
               holes: Literal["outside", "filled", "wall", "pit"] = "outside", preview: bool = False) -> pathlib.Path:
    """Makes a level of a map of heights, as program wadi-import does, and returns the path of its level.json, for World.
    path: .asc, .hgt, .png, .r16, .r32, .raw, .npy, or .tif (by rasterio: wadi[maps]). The map's coordinates become the level's origin.
    folder: of the level; None = the map's name without its ending. cell: width of a cell [m] where the map does not say, of a .tif that to
    which it is resampled. size: (columns, rows) of a raw map that is not square. low, high: heights of black and white [m] in maps of 8 and
    16 bits. packed: "terrarium" or "mapbox", heights in the colours of a PNG. flip: "x", "y" or "xy". samples: "cells" or "corners".
    holes: "outside", "filled", "wall" or "pit". preview: True = also preview.png.
    Errors: BadFileError with the program's text, NotFoundError (no such program in this build)."""
    source = pathlib.Path(path)
    folder = pathlib.Path(folder) if folder is not None else source.with_suffix("")
    command = [program("wadi-import"), "--out", folder, "--holes", holes]
    for option, value in (("--cell", cell), ("--min", low), ("--max", high), ("--packed", packed), ("--flip", flip), ("--samples", samples)):
        if value is not None:
            command += [option, value]
    if size is not None:
        command += ["--size", f"{size[0]}x{size[1]}"]
    if preview:
        command.append("--preview")
    with tempfile.TemporaryDirectory() as room:
        if source.suffix.lower() in (".tif", ".tiff"):
            read = read_geotiff(source, cell)
            source = pathlib.Path(room) / (source.stem + ".asc")
            write_asc(source, read.heights, read.dx, read.origin)
            if cell is not None:
                del command[command.index("--cell"):command.index("--cell") + 2]
        done = subprocess.run([os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in [*command, source]],
                              capture_output=True, text=True)
    if done.returncode != 0:
        raise BadFileError(done.stderr.strip() or f"wadi-import failed with {done.returncode}")
    return folder / "level.json"
