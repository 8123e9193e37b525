"""Wadi: sand, water and wet sand on a height field.

    import wadi
    with wadi.World(wadi.levels()["canyon"]) as world:
        world.run(5)
        depth = world.read("water_depth")

World is where to begin. Functions and classes of this package say in their texts what they take, give and refuse.
"""
from . import cuda, plot
from ._library import (BadArgumentError, BadFileError, BusyError, CancelledError, DeviceLostError, Error, InternalError, NotFoundError,
                       NotReadyError, NotSupportedError, OutOfMemoryError, accuracy_presets, describe, devices, field_name, levels, program,
                       version)
from ._native import (AccuracyPreset, ActiveTiles, Body, BodyShape, Cost, DeviceInfo, Edit, EditKind, EffectInfo, Field, Frame, Layer, Limit,
                      LogLevel, MaterialInfo, MemoryItem, Output, OutputSet, QueryResult, Region, Result, Source, SourceShape, StageTiming,
                      UpdateSettings, WorldInfo, WorldStats)
from .buoyancy import buoyancy_force, buoyancy_points
from .extras import MissingExtraError
from .maps import HeightMap, import_map, read_geotiff, write_asc, write_geotiff
from .output import OutputView
from .recording import Recording
from .world import World, level_cost
from .world_edits import Material
from .world_outputs import QUERY_DTYPE
from .world_saves import Save

#: Of the library that is loaded.
__version__ = version()
__all__ = [name for name in dir() if not name.startswith("_")]
