"""Wadi: sand, water and wet sand on a height field.

    import wadi
    with wadi.World(wadi.levels()["canyon"]) as world:
        world.run(5)
        depth = world.read("water_depth")

World is where to begin. Functions and classes of this package say in their texts what they take, give and refuse.
"""
# "X as X" tells type checkers that X is meant for those who import the package.
from . import cuda as cuda, plot as plot
from ._library import (BadArgumentError as BadArgumentError, BadFileError as BadFileError, BusyError as BusyError,
                       CancelledError as CancelledError, DeviceLostError as DeviceLostError, Error as Error, InternalError as InternalError,
                       NotFoundError as NotFoundError, NotReadyError as NotReadyError, NotSupportedError as NotSupportedError,
                       OutOfMemoryError as OutOfMemoryError, accuracy_presets as accuracy_presets, describe as describe, devices as devices,
                       field_name as field_name, levels as levels, program as program, version as version)
from ._native import (AccuracyPreset as AccuracyPreset, ActiveTiles as ActiveTiles, Body as Body, BodyShape as BodyShape, Cost as Cost,
                      DeviceInfo as DeviceInfo, Edit as Edit, EditKind as EditKind, EffectInfo as EffectInfo, Field as Field,
                      Frame as Frame, Layer as Layer, Limit as Limit, LogLevel as LogLevel, MaterialInfo as MaterialInfo,
                      MemoryItem as MemoryItem, Output as Output, OutputSet as OutputSet, QueryResult as QueryResult, Region as Region,
                      Result as Result, Source as Source, SourceShape as SourceShape, StageTiming as StageTiming,
                      UpdateSettings as UpdateSettings, WorldInfo as WorldInfo, WorldStats as WorldStats)
from .buoyancy import buoyancy_force as buoyancy_force, buoyancy_points as buoyancy_points
from .extras import MissingExtraError as MissingExtraError
from .maps import (HeightMap as HeightMap, import_map as import_map, read_geotiff as read_geotiff, write_asc as write_asc,
                   write_geotiff as write_geotiff)
from .output import OutputView as OutputView
from .recording import Recording as Recording
from .world import World as World, level_cost as level_cost
from .world_edits import Material as Material
from .world_outputs import QUERY_DTYPE as QUERY_DTYPE
from .world_saves import Save as Save

#: Of the library that is loaded.
__version__: str = version()
__all__: list[str] = [name for name in dir() if not name.startswith("_")]
