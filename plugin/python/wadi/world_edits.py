"""What changes a world: edits, sources, its material."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from ctypes import byref, c_uint32
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _native
from ._library import check, encoded, fill, native
from ._native import Edit, EditKind, Layer, Source, SourceShape
from ._struct import member, whole
from ._world import WorldBase

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import LayerName, Pair


class Material(Mapping[str, float]):
    """Numbers of a world's material by name, as level files write them: world.material["friction"] = 0.6 changes one from the next step
    on. Names and units: wadi.describe("settings"). `range(name)` gives least and most. Another name is a KeyError, a value outside a
    BadArgumentError; nothing is changed then."""

    def __init__(self, world: WorldBase) -> None:
        self._world = world

    def _infos(self) -> dict[str, _native.MaterialInfo]:
        return {info.name: info for info in fill(native.wadi_world_get_material, _native.MaterialInfo, self._world.id)}

    def __getitem__(self, name: str) -> float:
        return self._infos()[name].value

    def __setitem__(self, name: str, value: float) -> None:
        if name not in self._infos():
            raise KeyError(name)
        check(native.wadi_world_set_material(self._world.id, encoded(name, "name"), float(value)))

    def __iter__(self) -> Iterator[str]:
        return iter(self._infos())

    def __len__(self) -> int:
        return len(self._infos())

    def range(self, name: str) -> tuple[float, float]:
        """(least, most) that the number takes."""
        info = self._infos()[name]
        return info.least, info.most

    def __repr__(self) -> str:
        return f"Material({dict(self)})"


class Edits(WorldBase):
    """Of a World: edits, sources, material."""

    # ---- Edits ----

    def edit(self, *edits: Edit) -> None:
        """Queues edits, wadi.Edit each: brushes, stamps and pushes, ahead of the next step or of their own. Errors: BadArgumentError names
        edit, field and range; none is queued then."""
        if edits:
            raw = (Edit * len(edits))(*edits)
            check(native.wadi_world_edit(self.id, raw, len(edits)))

    def _brush(self, layer: Layer, x: float, y: float, amount: float, radius: float, softness: float, to: Pair | None,
               step: int, player: int) -> None:
        x1, y1 = to if to is not None else (0, 0)
        self.edit(Edit(kind=EditKind.BRUSH, layer=layer, x0=x, y0=y, x1=x1, y1=y1, capsule=to is not None, amount=amount, radius=radius,
                       softness=softness, step=step, player=player))

    def pour(self, x: float, y: float, depth: float, radius: float = 1.0, *, layer: Literal["water", "sand"] | Layer = "water",
             softness: float = 0.5, to: Pair | None = None, step: int = 0, player: int = 0) -> None:
        """Pours `depth` [m] at the centre of a disc round (x, y) [m], or along the line from there `to` (x, y).
        layer: "water" or "sand". radius [m]; softness 0 ... 1: share of the radius over which the depth falls to 0. step: the water step
        ahead of which it acts, 0 = the next. player: edits of one step act by rising player. Errors: those of `edit`."""
        layer = member(Layer, layer, "layer")
        if layer == Layer.TERRAIN or not depth >= 0:
            raise ValueError(f"pour: {'the layer is water or sand' if layer == Layer.TERRAIN else f'depth: {depth!r}, must be 0 or more; dig() takes away'}")
        self._brush(layer, x, y, depth, radius, softness, to, step, player)

    def dig(self, x: float, y: float, depth: float, radius: float = 1.0, *, layer: LayerName | Layer = "sand", softness: float = 0.5,
            to: Pair | None = None, step: int = 0, player: int = 0) -> None:
        """Takes up to `depth` [m] of a layer ("sand", "water", "terrain"), no more than there is; the rest as `pour`."""
        if not depth >= 0:
            raise ValueError(f"dig: depth: {depth!r}, must be 0 or more; pour() adds")
        self._brush(member(Layer, layer, "layer"), x, y, -depth, radius, softness, to, step, player)

    def raise_terrain(self, x: float, y: float, height: float, radius: float = 1.0, *, softness: float = 0.5, to: Pair | None = None,
                      step: int = 0, player: int = 0) -> None:
        """Raises the ground by `height` [m], or lowers it where that is below 0; the rest as `pour`."""
        self._brush(Layer.TERRAIN, x, y, height, radius, softness, to, step, player)

    def push(self, x: float, y: float, velocity: Pair, radius: float = 1.0, *, strength: float = 1.0, softness: float = 0.5,
             to: Pair | None = None, step: int = 0, player: int = 0) -> None:
        """Drags sand and water along with a body of that velocity (east, north) [m/s]. strength 0 ... 1; the rest as `pour`."""
        x1, y1 = to if to is not None else (0, 0)
        east, north = velocity
        self.edit(Edit(kind=EditKind.PUSH, x0=x, y0=y, x1=x1, y1=y1, capsule=to is not None, radius=radius, softness=softness,
                       strength=strength, velocity_x=east, velocity_y=north, step=step, player=player))

    def create_stamp(self, image: ArrayLike) -> int:
        """Copies an image (ny, nx) of 1 ... 4096 values a side, row 0 in the south, for `stamp`. Returns its number, from 1 on."""
        plane = np.ascontiguousarray(image, dtype=np.float32)
        if plane.ndim != 2:
            raise ValueError(f"image: its shape is {plane.shape}, must be (ny, nx)")
        number = c_uint32()
        check(native.wadi_world_create_stamp(self.id, plane.shape[1], plane.shape[0], plane.ctypes.data, byref(number)))
        return number.value

    def stamp(self, image: int | ArrayLike, low: Pair, high: Pair, amount: float = 1.0, *, layer: LayerName | Layer = "terrain",
              step: int = 0, player: int = 0) -> None:
        """Adds `amount` [m] times an image to a layer over the rectangle from `low` to `high`, (x, y) each [m]. image: a number from
        create_stamp, or an array, which becomes a stamp that lives as long as the world."""
        number = image if isinstance(image, int) else self.create_stamp(image)
        (x0, y0), (x1, y1) = low, high
        self.edit(Edit(kind=EditKind.STAMP, layer=layer, x0=x0, y0=y0, x1=x1, y1=y1, amount=amount, stamp=number, step=step, player=player))

    def prepare_effects(self) -> None:
        """Compiles what edits may bring later, so that they only allocate."""
        check(native.wadi_world_prepare_effects(self.id))

    def trim(self) -> None:
        """Frees what belongs to materials that the world no longer holds. Waits for the steps."""
        check(native.wadi_world_trim(self.id))

    # ---- Sources ----

    @property
    def sources(self) -> list[dict[str, Any]]:
        """Sources and drains as they are now, a list of dicts with what set_source takes."""
        return [self._source(n) for n in range(self.info.source_count)]

    def _source(self, index: int) -> dict[str, Any]:
        raw = Source()
        check(native.wadi_world_get_source(self.id, index, byref(raw)))
        found = {"shape": raw.shape.name.lower(), "sand": raw.sand, "drain": raw.drain}
        found.update({"from_": raw.from_, "to": raw.to} if raw.shape == SourceShape.BOX else {"center": raw.center})
        if raw.shape == SourceShape.DISC:
            found["radius"] = raw.radius
        if raw.set_velocity:
            found["velocity"] = raw.velocity
        for series in ("rate", "discharge", "level"):
            count, samples = getattr(raw, f"{series}_count"), getattr(raw, series)
            if count:
                found[series] = [(samples[n].time, samples[n].value) for n in range(count)]
        return found

    def set_source(self, index: int, *, shape: Literal["disc", "point", "box"] | SourceShape = "disc", center: Pair | None = None,
                   radius: float = 1.0, from_: Pair | None = None, to: Pair | None = None, rate: ArrayLike | None = None,
                   discharge: ArrayLike | None = None, level: ArrayLike | None = None, sand: bool = False, drain: bool = False,
                   velocity: Pair | None = None, step: int = 0, player: int = 0) -> None:
        """Makes source `index`, 0 ... 31, another one: opens, closes, moves or adds it.
        shape: "disc" (center, radius), "point" (center), "box" (from_, to), (x, y) each [m].
        One of rate (depth per time [m/s]), discharge [m3/s], level (elevation of water that it holds [m]; with it rate or discharge is the
        most that it moves): a number, or samples [(time [s], value), ...], linear between. rate=0 closes a tap.
        sand: True = of sand. drain: True = with level, takes away what stands above, too. velocity: (east, north) forced on the water
        inside [m/s]. step, player: as `pour`. Errors: BadArgumentError names the field and its range."""
        value: Any
        raw = Source(shape=shape, sand=sand, drain=drain, radius=radius, step=step, player=player)
        for field, value in (("center", center), ("from_", from_), ("to", to)):
            if value is not None:
                setattr(raw, field, value)
        if velocity is not None:
            raw.set_velocity, raw.velocity = True, velocity
        for field, value in (("rate", rate), ("discharge", discharge), ("level", level)):
            if value is None:
                continue
            pairs = np.asarray([(0.0, value)] if np.ndim(value) == 0 else value, dtype=float)
            if pairs.ndim != 2 or pairs.shape[1] != 2:
                raise ValueError(f"{field}: its shape is {pairs.shape}, must be a number or samples (n, 2) of time and value")
            setattr(raw, field, (_native.Sample * len(pairs))(*(_native.Sample(time=t, value=v) for t, v in pairs)))
            setattr(raw, f"{field}_count", len(pairs))
        check(native.wadi_world_set_source(self.id, whole(index, "index", 0, 31), byref(raw)))

    @property
    def material(self) -> Material:
        """Numbers of the material by name, to read and to set: a wadi.Material."""
        return Material(self)
