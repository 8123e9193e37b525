"""A level from objects of a scene: heights are where vertical rays meet their meshes from above."""
import io
import math

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

MANNING = 0.03  # roughness of natural ground [s/m^(1/3)]
SAND_WEIGHT = 2e4  # of full sand, per depth [Pa/m]


def _bounds(thing):
    corners = np.array([thing.matrix_world @ Vector(corner) for corner in thing.bound_box])
    return corners.min(axis=0), corners.max(axis=0)


def _npy(plane):
    data = io.BytesIO()
    np.save(data, np.asarray(plane, np.float32))
    return data.getvalue()


class Ground:
    """The grid over an object, and heights of meshes at its cells' centres. cells: along the longer side of the object's bounds."""

    def __init__(self, thing, cells, depsgraph):
        if thing is None:
            raise ValueError("terrain: no object is chosen")
        if thing.type != "MESH":
            raise ValueError(f"terrain: {thing.name} is no mesh")
        low, high = _bounds(thing.evaluated_get(depsgraph))
        size = high - low
        if not min(size[0], size[1]) > 0:
            raise ValueError(f"terrain: {thing.name} is {size[0]:g} x {size[1]:g} m wide, must be wider than 0")
        self.dx = float(max(size[0], size[1]) / cells)
        self.nx, self.ny = (max(4, math.floor(side / self.dx + 1e-6)) for side in size[:2])
        self.origin, self._top, self._depsgraph = tuple(map(float, low)), float(high[2]), depsgraph

    def heights(self, thing, name):
        """Elevations above the origin, shape (ny, nx), NaN where the mesh is not met."""
        if thing.type != "MESH":
            raise ValueError(f"{name}: {thing.name} is no mesh")
        seen = thing.evaluated_get(self._depsgraph)
        tree = BVHTree.FromObject(thing, self._depsgraph)
        to_world, inverse = seen.matrix_world, seen.matrix_world.inverted_safe()
        down = inverse.to_3x3() @ Vector((0, 0, -1))
        top = max(_bounds(seen)[1][2], self._top) + 1
        found = np.full((self.ny, self.nx), np.nan, np.float32)
        for j in range(self.ny):
            y = self.origin[1] + (j + 0.5) * self.dx
            for i in range(self.nx):
                place = tree.ray_cast(inverse @ Vector((self.origin[0] + (i + 0.5) * self.dx, y, top)), down)[0]
                if place is not None:
                    found[j, i] = (to_world @ place).z - self.origin[2]
        if np.isnan(found).all():
            raise ValueError(f"{name}: {thing.name} lies under no cell of the terrain")
        return found


def level(terrain, cells, depsgraph, sand=None, sand_depth=0.0, water=None, water_depth=0.0, inflow=None, discharge=0.0, open_sides=True):
    """A level's text and files for wadi.World, and what the cache keeps of it.
    sand, water: meshes whose upper side is the surface, or None and a depth [m] everywhere. inflow: an object where `discharge` [m3/s] of
    water comes up; its radius is the larger half of its size in x and y, two cells at least."""
    grid = Ground(terrain, cells, depsgraph)
    ground = grid.heights(terrain, "terrain")
    missing = int(np.isnan(ground).sum())
    lowest = float(np.nanmin(ground))
    files = {"terrain.npy": _npy(ground)}
    full = {"format_version": 1, "name": terrain.name, "grid": {"nx": grid.nx, "ny": grid.ny, "dx": grid.dx},
            "terrain": [{"file": "terrain.npy", "holes": "outside"}], "material": {"manning": MANNING}}
    highest, deepest = water_depth, sand_depth if sand is None else 0.0
    for name, thing, depth in (("sand", sand, sand_depth), ("water", water, water_depth)):
        if thing is not None:
            surface = grid.heights(thing, name)
            depth = max(0.0, float(np.nanmax(surface - ground)))
            highest, deepest = highest + depth, max(deepest, depth) if name == "sand" else deepest
            files[f"{name}.npy"] = _npy(np.where(np.isnan(surface), lowest - 1, surface))
            full[name] = [{"file": f"{name}.npy", "absolute": True, **({"inside_sand": True} if name == "water" else {})}]
        elif depth > 0:
            full[name] = [{"shape": "plane", "height": depth}]
    if inflow is not None:
        low, high = _bounds(inflow)
        middle = inflow.matrix_world.translation
        place = [middle.x - grid.origin[0], middle.y - grid.origin[1]]
        if not (0 <= place[0] < grid.nx * grid.dx and 0 <= place[1] < grid.ny * grid.dx):
            raise ValueError(f"inflow: {inflow.name} stands outside the terrain")
        full["sources"] = [{"shape": "disc", "center": place, "material": "water",
                            "radius": max(2 * grid.dx, 0.5 * float(max(high[0] - low[0], high[1] - low[1]))), "discharge": discharge}]
        highest += grid.dx
    if open_sides:
        full["sides"] = {side: {"kind": "outflow"} for side in ("west", "east", "south", "north")}
    if deepest > 0:
        full["material"]["young_modulus"] = 10 * SAND_WEIGHT * deepest
    # Steps that waves need five of to cross a cell, and water that has run down the slopes.
    full["dt"] = 0.2 * grid.dx / math.sqrt(9.81 * max(highest + deepest, grid.dx, 0.5 * (float(np.nanmax(ground)) - lowest)))
    return full, files, {"origin": grid.origin, "cells_without_ground": missing}
