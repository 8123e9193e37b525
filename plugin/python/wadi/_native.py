"""What wadi.h and wadi_cuda.h declare, for ctypes: enums, structs, callbacks and calls. Written by plugin/python/write_python.py from
plugin/wadi_api.json."""
from __future__ import annotations

from ctypes import (CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p)
from enum import IntEnum
from typing import Any

from ._struct import Flag, Member, Row, Struct, Text, Whole


#: What this file was written from: the library that is loaded must have this number.
ABI_VERSION: int = 1
#: As wadi_get_version gives it: at least this has all that is named here.
VERSION: int = 4096
OUTPUT_TILES_BIT: int = 2147483648
EVERY_PLAYER: int = 18446744073709551615


class Result(IntEnum):
    """As wadi_result."""
    OK = 0
    #: a value is wrong; the message names it and its range
    ERROR_BAD_ARGUMENT = 1
    #: no such file, level, backend, device or effect
    ERROR_NOT_FOUND = 2
    #: a file is malformed; the message names the field
    ERROR_BAD_FILE = 3
    #: this build or device cannot do it
    ERROR_NOT_SUPPORTED = 4
    ERROR_OUT_OF_MEMORY = 5
    #: sticky for the world; destroy it and create another
    ERROR_DEVICE_LOST = 6
    #: our bug: please report the message
    ERROR_INTERNAL = 7
    #: not an error: ask again later
    NOT_READY = 8
    #: another thread is inside a call on this world; nothing was done
    ERROR_BUSY = 9
    #: not an error: the host's progress callback ended the call; nothing was made
    CANCELLED = 10


class LogLevel(IntEnum):
    """As wadi_log_level."""
    ERROR = 0
    WARNING = 1
    INFORMATION = 2


class Choice(IntEnum):
    """A choice that a level makes, too."""
    OFF = -1
    #: as the level says
    LEVEL = 0
    ON = 1


class ActiveTiles(IntEnum):
    """Tiles in which nothing changes any more are left out of a step; every bit stays, also in snapshots."""
    OFF = -1
    #: as the level says, by default CHEAP
    LEVEL = 0
    #: on while little of the world is awake
    AUTO = 1
    #: AUTO in large grids on GPUs, else OFF
    CHEAP = 2
    #: on, of 8 x 8 cells
    TILES_8 = 8
    TILES_16 = 16
    TILES_32 = 32
    TILES_64 = 64


class Output(IntEnum):
    """Fields for drawing and collision, one value per cell (its centre), published on the device after the steps of an update."""
    #: elevation of the ground H [m], 1 float
    TERRAIN = 0
    #: elevation of the solid surface H + hs [m], 1 float
    SAND_SURFACE = 1
    #: elevation of the visible surface H + max(W, hs) [m], 1 float
    FREE_SURFACE = 2
    #: hs [m], 1 float
    SAND_DEPTH = 3
    #: pure water above the sand, what its pores do not hold [m], 1 float
    WATER_DEPTH = 4
    #: W/(W + hs) where there is sand, else 0; 1 float
    SATURATION = 5
    #: flow map: velocity of pure water, what is seen to move, east and north [m/s], 2 floats
    FLOW = 6
    #: east and north [m/s], 2 floats
    SAND_VELOCITY = 7
    #: 0 ... 1 from the present state of the pure water (depth h, velocity u), 1 float: max(clamp((Fr^2 - 1)/3), clamp((R - 0.15)/0.5)) *
    #: clamp(10 h/dx), clamps to 0 ... 1; Fr = |u|/sqrt(g h) (fast water), R = -h div(u)/sqrt(g h) (rising, breaking fronts). With effect
    #: foam that which drifts, fades and lies on the shore, at most 1: PACKED, too
    FOAM = 8
    #: unit normal of the visible surface: east, north, up, 0; 4 floats
    NORMAL = 9
    #: elevation of the visible surface after a 3 x 3 Gaussian [m], 1 float
    SMOOTH_SURFACE = 10
    #: one texel to draw a surface with: FREE_SURFACE, WATER_DEPTH, FOAM, SATURATION; 4 floats
    PACKED = 11
    #: the same, each rounded to a 16-bit float (11 bits: a surface 16 ... 32 m up to 16 mm), at most 65504; 8 bytes
    PACKED_HALF = 12
    #: with effect wetness how wet the ground is, 1 under water, less the longer it is dry, else 0; 1 float
    WETNESS = 13
    #: with effect silt what makes the water muddy, per area of the ground [kg/m2], else 0; 1 float. Grains of 0.08 mm hide 1 - exp(-7 s)
    #: of the ground below them, finer ones more
    SILT = 14
    COUNT = 15


class OutputSet(IntEnum):
    """As wadi_output_set."""
    #: the publish before the current one
    PREVIOUS = 0
    #: the newest publish; wadi_frame.published_step
    CURRENT = 1
    #: between the two at the host's time, one dt late; outputs of 1 float, and only with wadi_update_settings.interpolate_outputs.
    #: Written anew by each update; an update leaves it as it is while the device is two updates behind
    INTERPOLATED = 2


class HandleKind(IntEnum):
    """As wadi_handle_kind."""
    #: CPU backend: an address
    HOST_POINTER = 0
    #: VkBuffer
    VULKAN_BUFFER = 1
    #: CUdeviceptr
    CUDA_POINTER = 2


class Format(IntEnum):
    """As wadi_format."""
    R32_FLOAT = 1
    R32G32_FLOAT = 2
    R32G32B32A32_FLOAT = 4
    #: 8 bytes; those above: so many floats of 4 bytes
    R16G16B16A16_FLOAT = 8


class Field(IntEnum):
    """As wadi_field."""
    #: H, elevation of the ground [m]
    TERRAIN = 0
    #: hs [m]
    SAND_DEPTH = 1
    #: W, depth of all water, above the sand and inside it [m]
    TOTAL_WATER_DEPTH = 2
    #: pure water above the sand, what its pores do not hold [m]
    WATER_DEPTH = 3
    #: H + max(W, hs), elevation of what a viewer sees [m]
    FREE_SURFACE = 4
    #: W/(W + hs) where there is sand, else 0
    SATURATION = 5
    #: pure water, cell centre [m/s]
    WATER_VELOCITY_X = 6
    WATER_VELOCITY_Y = 7
    #: [m/s]
    SAND_VELOCITY_X = 8
    SAND_VELOCITY_Y = 9
    #: water inside sand [m/s]
    MIXED_VELOCITY_X = 10
    MIXED_VELOCITY_Y = 11
    #: left stretch V - I of the sand
    STRETCH_XX = 12
    STRETCH_XY = 13
    STRETCH_YY = 14
    #: which limits hold the cell in the next step: a sum of wadi_limit bits, 0 = none
    LIMITS = 15
    #: effect foam: 1 covers the cell, at most 4 where currents pile it up
    FOAM = 16
    #: effect wetness: 1 under water, less the longer the ground is dry
    WETNESS = 17
    #: effect silt: what makes the water muddy, per area of the ground, at most 8 [kg/m2]
    SILT = 18
    COUNT = 19


class Limit(IntEnum):
    """Bits of WADI_FIELD_LIMITS, of a cell or any of its four faces. wadi_world_stats counts the same, by faces."""
    #: water, pure or in sand, at the velocity clamp
    WATER_SPEED = 1
    #: gravity of water capped: waves are slower there
    WATER_GRAVITY = 2
    #: more water would leave than there is
    WATER_OUTFLOW = 4
    SAND_SPEED = 8
    SAND_GRAVITY = 16
    SAND_OUTFLOW = 32
    #: the column stands above method.largest_height: its heights are rounded, the books drift
    HEIGHT = 64


class BodyShape(IntEnum):
    """As wadi_body_shape."""
    BOX = 0
    SPHERE = 1


class Layer(IntEnum):
    """As wadi_layer."""
    TERRAIN = 0
    SAND = 1
    WATER = 2


class EditKind(IntEnum):
    """As wadi_edit_kind."""
    #: adds to (amount > 0) or takes from a layer within a disc or capsule
    BRUSH = 0
    #: the same by an image over a rectangle
    STAMP = 1
    #: a body that drags sand and water along and feels nothing itself; moves no mass
    PUSH = 2


class SourceShape(IntEnum):
    """As wadi_source_shape."""
    DISC = 0
    BOX = 1
    #: the cell that holds `center`
    POINT = 2


#: Gets what the library has to tell. Warnings are advice on a level, and limits that hold a running world back, each kind once, with the
#: time step or setting that would end it. Information is each world made and each change of its effects. An error is a lost device.
#: Messages of drivers and validation layers come here, too. Called during a call of the library, or from a driver's thread. It must not
#: call the library; what it throws is lost.
LogCallback = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)


#: Part `n` of a pass of the CPU backend: any thread may run it, parts in any order and at once.
Job = CFUNCTYPE(None, c_void_p, c_uint32)


#: The host's job system: runs job(data, n) for each n below count, on any of its threads or one after the other on one, and returns when
#: all have returned. A part that has begun may wait for others that have begun: they must be threads, not fibres of one. A part that is
#: left out, runs twice or begins late changes no bit; none may begin after wadi_destroy_world. Called from a thread of the library,
#: several times a step; must not throw and must not call the library.
RunJobsCallback = CFUNCTYPE(None, c_void_p, c_uint32, c_void_p, c_void_p)


#: The host's memory: `bytes` (1 or more) at a multiple of `alignment`, a power of two, or NULL where it refuses. They need not be zero.
AllocateCallback = CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)


#: Takes back, whole, what the allocate callback gave. Both are called from threads of the library and of the host, from several at once;
#: they must not call the library; what they throw counts as a refusal.
FreeCallback = CFUNCTYPE(None, c_void_p, c_void_p, c_size_t)


#: Hears how far the call that makes a world is, as a share from 0 to 1 that never falls. Returns 1 to go on, or 0 to end the call with
#: WADI_CANCELLED. Called on that call's thread alone, at least once for each layer of a level, and also before the device is opened and
#: before the world is handed out. It is not called while a file is decoded or a driver compiles. It must not call the library. Should not
#: throw: whatever it throws ends the call.
ProgressCallback = CFUNCTYPE(c_int32, c_void_p, c_double)


#: Reads a file that a level names, for the host's own file system. Called with data NULL first: sets *size to the file's bytes; then with
#: room for *size bytes: fills it and sets *size to what it wrote. Returns 1, or 0 where there is no such file. `name` is as the level
#: writes it, '/' between folders, and never leads out of the level's folder but with overrides.any_files. Called only inside
#: wadi_create_world_from_level_text, on its thread. Should not throw: whatever it throws ends that call with INTERNAL.
ReadFileCallback = CFUNCTYPE(c_int32, c_void_p, c_char_p, c_void_p, POINTER(c_size_t))


class DeviceInfo(Struct):
    """As wadi_device_info."""
    _fields_ = [("struct_size", c_uint32),
                ("_backend", c_char * 16),
                ("_index", c_int32),
                ("_name", c_char * 256),
                ("_is_software", c_int32),
                ("_memory_bytes", c_uint64)]
    struct_size: int
    backend: Text = Text("_backend")
    #: within its backend
    index: Whole = Whole("_index", c_int32)
    name: Text = Text("_name")
    #: 1 for the CPU and for software Vulkan devices
    is_software: Flag = Flag("_is_software")
    #: 0 = unknown
    memory_bytes: Whole = Whole("_memory_bytes", c_uint64)


class Cost(Struct):
    """What a level, a snapshot or a command log needs. All sums are known before the work begins; 0 where one has no such sum. As a
    host's limits: the most of each, 0 = no limit but the library's own."""
    _fields_ = [("struct_size", c_uint32),
                ("_cells", c_uint64),
                ("_file_bytes", c_uint64),
                ("_map_values", c_uint64),
                ("_work", c_uint64),
                ("_host_bytes", c_uint64),
                ("_device_bytes", c_uint64),
                ("_steps", c_uint64),
                ("_edits_per_step", c_uint64),
                ("_commands_per_step", c_uint64)]
    struct_size: int
    #: of the grid
    cells: Whole = Whole("_cells", c_uint64)
    #: bytes that are read: a level's text, its maps and series; a snapshot; a log
    file_bytes: Whole = Whole("_file_bytes", c_uint64)
    #: numbers that maps and series hold once they are decoded
    map_values: Whole = Whole("_map_values", c_uint64)
    #: of drawing a level: looks at shapes, some nanoseconds of one thread each
    work: Whole = Whole("_work", c_uint64)
    #: of the host's memory while it loads, at most, beside those of the device
    host_bytes: Whole = Whole("_host_bytes", c_uint64)
    #: that the world holds on its device once it is loaded, at most; with the backend "cpu" they are the host's. Of a log: the bytes of
    #: its stamps
    device_bytes: Whole = Whole("_device_bytes", c_uint64)
    #: of a level: the steps of its duration (0 for a map alone); of a snapshot: the step that it is of; of a log: its last step
    steps: Whole = Whole("_steps", c_uint64)
    #: the most edits that a level or a log brings into one step
    edits_per_step: Whole = Whole("_edits_per_step", c_uint64)
    #: the most other commands that a log brings into one step
    commands_per_step: Whole = Whole("_commands_per_step", c_uint64)


class DeviceOptions(Struct):
    """Where and how a world runs."""
    _fields_ = [("struct_size", c_uint32),
                ("_backend", c_char_p),
                ("_device", c_int32),
                ("_threads", c_int32),
                ("_validate", c_int32),
                ("log", LogCallback),
                ("log_user", c_void_p),
                ("vulkan_host", c_void_p),
                ("run_jobs", RunJobsCallback),
                ("jobs_user", c_void_p),
                ("allocate_memory", AllocateCallback),
                ("free_memory", FreeCallback),
                ("memory_user", c_void_p),
                ("most", POINTER(Cost)),
                ("progress", ProgressCallback),
                ("progress_user", c_void_p)]
    _defaults_ = {"backend": "auto",
                  "device": -1}
    struct_size: int
    #: "auto" (a real GPU first, else the CPU), or one that wadi_list_devices names: "cpu", "vulkan" ...
    backend: Text = Text("_backend")
    #: index from wadi_list_devices, -1 = the backend's best
    device: Whole = Whole("_device", c_int32)
    #: of the CPU backend, and for any to load levels and to count and hash states. 0 = all cores; the CPU backend's steps then leave one
    #: to the host's frame
    threads: Whole = Whole("_threads", c_int32)
    #: 1 = Vulkan validation layers; messages go to the log callback
    validate: Flag = Flag("_validate")
    #: may be NULL
    log: Any
    log_user: int | None
    #: NULL, or the host's own Vulkan device (wadi_vulkan.h): "auto" and "vulkan" run on it, "cuda" beside it
    vulkan_host: int | None
    #: NULL, or: the CPU backend has no threads of its own but the one that takes steps in order; a pass has `threads` parts. Every bit
    #: stays, whatever the number
    run_jobs: Any
    jobs_user: int | None
    #: set both callbacks or neither (NULL). With the CPU backend all that wadi_world_get_memory lists comes from here: fields, outputs,
    #: copies for the host, snapshots under way, kept states, queries. All of it is freed before wadi_destroy_world returns. If it
    #: refuses, the call fails with OUT_OF_MEMORY and the world is as it was, except that kept states are dropped where a promotion finds
    #: no room for theirs. Not from here: what a call needs while it lasts (level files, statistics), edits that wait, the command log,
    #: programs, threads. Nor is the memory of GPU backends, which is the driver's
    allocate_memory: Any
    free_memory: Any
    memory_user: int | None
    #: NULL, or limits of the host's own. They are checked before a level, and later a snapshot or log of this world, is read further than
    #: its header. What passes one is BAD_FILE, with the sum and the limit
    most: Any
    #: NULL, or hears how far the making of the world is, and may end it
    progress: Any
    progress_user: int | None


class WorldId(Struct):
    """A world by index and generation; all zero is null. Copy it freely; a destroyed one is recognised and refused."""
    _fields_ = [("_index", c_uint32),
                ("_generation", c_uint32)]
    index: Whole = Whole("_index", c_uint32)
    generation: Whole = Whole("_generation", c_uint32)


class LevelOverrides(Struct):
    """Overrides for a level file; a value of 0 or NULL keeps the file's."""
    _fields_ = [("struct_size", c_uint32),
                ("_nx", c_int32),
                ("_ny", c_int32),
                ("dt", c_double),
                ("_method", c_char_p),
                ("_variant", c_char_p),
                ("_accuracy", c_char_p),
                ("_active_tiles", c_int32),
                ("_fused_stages", c_int32),
                ("_any_files", c_int32),
                ("_draws", c_uint64)]
    struct_size: int
    #: keeps the x extent and square cells, stretches maps in y, scales dt with dx
    nx: Whole = Whole("_nx", c_int32)
    #: keeps the x extent and square cells, stretches maps in y, scales dt with dx
    ny: Whole = Whole("_ny", c_int32)
    #: [s]
    dt: float
    #: "robust" or "published"
    method: Text = Text("_method")
    #: one of the level's variants; NULL = the level as it is. Not for terrain maps
    variant: Text = Text("_variant")
    #: "draft", "balanced" or "accurate": half, all or twice the level's cells along x and y (nx, ny win), and two sand steps per water
    #: step. "accurate" has second order for water, too. "fine": the cells of the level's fine_grid, for GPUs. NULL, or "fine" where it
    #: has none = what the level says
    accuracy: Text = Text("_accuracy")
    active_tiles: Member[ActiveTiles] = Member("_active_tiles", ActiveTiles)
    #: ON = several stages in one pass wherever the effects allow, OFF = one by one. Every bit stays
    fused_stages: Member[Choice] = Member("_fused_stages", Choice)
    #: 1 = maps and series may lie anywhere that the process can read; 0 = in the level's folder and below it alone, links followed: no
    #: "..", no path from the root on. For levels of one's own
    any_files: Flag = Flag("_any_files")
    #: WADI_OUTPUT_BIT of WADI_OUTPUT_FOAM, WADI_OUTPUT_WETNESS and WADI_OUTPUT_SILT, any of them, or 0: what the host will draw of what
    #: water carries and leaves. Effects foam and wetness are then on wherever there is water, silt where there is sand, too, and the
    #: level does not force them off. They move nothing, cost a pass each, and 8, 4 and 8 bytes a cell
    draws: Whole = Whole("_draws", c_uint64)


class AccuracyPreset(Struct):
    """An accuracy preset."""
    _fields_ = [("_name", c_char_p),
                ("cells", c_double),
                ("_substeps", c_int32),
                ("_water_order", c_int32)]
    name: Text = Text("_name")
    #: factor on the level's cells along x and y; 0 = the level's fine_grid
    cells: float
    #: sand steps per water step; 0 = the level's
    substeps: Whole = Whole("_substeps", c_int32)
    #: method.water_transport_order; 0 = the level's
    water_order: Whole = Whole("_water_order", c_int32)


class WorldArrays(Struct):
    """A world from arrays: settings, and fields of nx * ny floats. NULL = zero everywhere. The settings are the text of a level file
    without its "terrain", "sand", "water", "velocities", "roughness" and "rain_map" entries. They may name no files."""
    _fields_ = [("struct_size", c_uint32),
                ("_settings_json", c_char_p),
                ("_nx", c_int32),
                ("_ny", c_int32),
                ("terrain", c_void_p),
                ("sand", c_void_p),
                ("water", c_void_p),
                ("velocity_x", c_void_p),
                ("velocity_y", c_void_p),
                ("roughness", c_void_p),
                ("rain_map", c_void_p)]
    struct_size: int
    #: must not be NULL; texts may stand in single quotes: "{'grid': {'nx': 64, 'ny': 64, 'dx': 0.5}, ...}"
    settings_json: Text = Text("_settings_json")
    #: of the arrays; must equal the settings' grid
    nx: Whole = Whole("_nx", c_int32)
    #: of the arrays; must equal the settings' grid
    ny: Whole = Whole("_ny", c_int32)
    #: elevation of the ground [m]
    terrain: int | None
    #: depth hs [m]
    sand: int | None
    #: depth of all water, W [m]
    water: int | None
    #: water, at cell centres [m/s]
    velocity_x: int | None
    velocity_y: int | None
    #: what cells add to material.manning, 0 ... 1 [s/m^(1/3)]
    roughness: int | None
    #: how many times the settings' "rain" falls on each cell, 0 ... 100; NULL = once everywhere
    rain_map: int | None


class WorldInfo(Struct):
    """As wadi_world_info."""
    _fields_ = [("struct_size", c_uint32),
                ("_name", c_char * 64),
                ("_nx", c_int32),
                ("_ny", c_int32),
                ("dx", c_double),
                ("dt", c_double),
                ("_substeps", c_int32),
                ("duration", c_double),
                ("_passes_per_water_step", c_uint32),
                ("_passes_per_sand_substep", c_uint32),
                ("bytes_per_cell", c_double),
                ("_device_bytes", c_uint64),
                ("_backend", c_char * 16),
                ("_device_name", c_char * 256),
                ("_exact_float", c_int32),
                ("_warning_count", c_uint32),
                ("origin_x", c_double),
                ("origin_y", c_double),
                ("_source_count", c_uint64)]
    struct_size: int
    name: Text = Text("_name")
    nx: Whole = Whole("_nx", c_int32)
    ny: Whole = Whole("_ny", c_int32)
    #: [m]
    dx: float
    #: water time step [s]
    dt: float
    #: T: sand substeps per water step
    substeps: Whole = Whole("_substeps", c_int32)
    #: the level's own length [s]
    duration: float
    #: dispatches outside the sand substeps
    passes_per_water_step: Whole = Whole("_passes_per_water_step", c_uint32)
    passes_per_sand_substep: Whole = Whole("_passes_per_sand_substep", c_uint32)
    #: state, ping-pong and scratch
    bytes_per_cell: float
    #: everything the world holds on the device
    device_bytes: Whole = Whole("_device_bytes", c_uint64)
    backend: Text = Text("_backend")
    device_name: Text = Text("_device_name")
    #: 1 = the device passed the exact-float self-test
    exact_float: Flag = Flag("_exact_float")
    warning_count: Whole = Whole("_warning_count", c_uint32)
    #: of the grid's south-west corner in the coordinates of the map that the level was cut from, for a host to show [m]; 0 without a map.
    #: Every call counts from the corner
    origin_x: float
    #: of the grid's south-west corner in the coordinates of the map that the level was cut from, for a host to show [m]; 0 without a map.
    #: Every call counts from the corner
    origin_y: float
    #: sources and drains that the world has now: wadi_world_get_source
    source_count: Whole = Whole("_source_count", c_uint64)


class UpdateSettings(Struct):
    """How wadi_world_update turns host time into water steps."""
    _fields_ = [("struct_size", c_uint32),
                ("_max_steps_per_update", c_uint32),
                ("_max_steps_in_flight", c_uint32),
                ("_spread", c_int32),
                ("_interpolate_outputs", c_int32)]
    _defaults_ = {"max_steps_per_update": 8,
                  "max_steps_in_flight": 8}
    struct_size: int
    #: 1 ... 1024, default 8: time beyond it is dropped
    max_steps_per_update: Whole = Whole("_max_steps_per_update", c_uint32)
    #: 0 ... 64, default 8: once the device has this many unfinished water steps (or its queue of submissions is full), time is dropped. 0
    #: = drop nothing for that reason; the call may wait
    max_steps_in_flight: Whole = Whole("_max_steps_in_flight", c_uint32)
    #: 1 = a water step is submitted as 1 water part and T sand parts, evenly over its dt. The bits are the same, and the load has no peak
    #: every dt. Default 0
    spread: Flag = Flag("_spread")
    #: 1 = every update also writes the interpolated set of the outputs; default 0
    interpolate_outputs: Flag = Flag("_interpolate_outputs")


class Frame(Struct):
    """What one update did."""
    _fields_ = [("struct_size", c_uint32),
                ("_steps", c_uint32),
                ("_total_steps", c_uint64),
                ("time", c_double),
                ("interpolation", c_double),
                ("_published_step", c_uint64),
                ("_dropped_nanoseconds", c_uint64),
                ("_dropped_nanoseconds_total", c_uint64),
                ("_limits_step", c_uint64),
                ("_wet_faces", c_uint64),
                ("_clamped_water_faces", c_uint64),
                ("_capped_water_faces", c_uint64),
                ("_sand_faces", c_uint64),
                ("_clamped_sand_faces", c_uint64),
                ("_capped_sand_faces", c_uint64),
                ("_high_columns", c_uint64),
                ("unlimited_dt", c_double)]
    struct_size: int
    #: water steps that became whole in this update
    steps: Whole = Whole("_steps", c_uint32)
    #: whole water steps since creation
    total_steps: Whole = Whole("_total_steps", c_uint64)
    #: simulated: total_steps * dt [s]
    time: float
    #: in [0, 1): how far the host's clock is from the last whole step to the one to come. A renderer shows (1 - f) * last but one + f *
    #: last, one dt late, and moves evenly
    interpolation: float
    #: of the outputs' current set; UINT64_MAX = none yet
    published_step: Whole = Whole("_published_step", c_uint64)
    #: host time that became no step in this update; steps is then less than it asks for
    dropped_nanoseconds: Whole = Whole("_dropped_nanoseconds", c_uint64)
    #: and since the world was created
    dropped_nanoseconds_total: Whole = Whole("_dropped_nanoseconds_total", c_uint64)
    #: the step of the newest look for limits that has arrived; UINT64_MAX = none yet. A world with a log callback looks every 64 steps
    #: where limits are at work, told below as wadi_world_stats does
    limits_step: Whole = Whole("_limits_step", c_uint64)
    wet_faces: Whole = Whole("_wet_faces", c_uint64)
    clamped_water_faces: Whole = Whole("_clamped_water_faces", c_uint64)
    capped_water_faces: Whole = Whole("_capped_water_faces", c_uint64)
    sand_faces: Whole = Whole("_sand_faces", c_uint64)
    clamped_sand_faces: Whole = Whole("_clamped_sand_faces", c_uint64)
    capped_sand_faces: Whole = Whole("_capped_sand_faces", c_uint64)
    high_columns: Whole = Whole("_high_columns", c_uint64)
    #: [s]
    unlimited_dt: float


class OutputView(Struct):
    """Where a published field lies on the device. Read only."""
    _fields_ = [("struct_size", c_uint32),
                ("_handle_kind", c_int32),
                ("_handle", c_uint64),
                ("_offset", c_uint64),
                ("_row_pitch", c_uint64),
                ("_buffer_bytes", c_uint64),
                ("_nx", c_int32),
                ("_ny", c_int32),
                ("_format", c_int32),
                ("_step", c_uint64),
                ("_finished", c_int32)]
    struct_size: int
    handle_kind: Member[HandleKind] = Member("_handle_kind", HandleKind)
    #: the same for a buffer until wadi_world_set_outputs changes the mask
    handle: Whole = Whole("_handle", c_uint64)
    #: of cell (0, 0), past the ghost cells [bytes]; VkBufferImageCopy.bufferOffset
    offset: Whole = Whole("_offset", c_uint64)
    #: [bytes]; over the size of a cell it is VkBufferImageCopy.bufferRowLength
    row_pitch: Whole = Whole("_row_pitch", c_uint64)
    buffer_bytes: Whole = Whole("_buffer_bytes", c_uint64)
    nx: Whole = Whole("_nx", c_int32)
    ny: Whole = Whole("_ny", c_int32)
    format: Member[Format] = Member("_format", Format)
    #: water steps done in the state it shows; INTERPOLATED: in the current set
    step: Whole = Whole("_step", c_uint64)
    #: 1 = the device has written it. 0 = it will have, ahead of anything that you submit after it. A host that reads elsewhere (the CPU
    #: backend's address) must wait for 1
    finished: Flag = Flag("_finished")


class Region(Struct):
    """The cells (i, j) with i0 <= i < i0 + nx and j0 <= j < j0 + ny."""
    _fields_ = [("_i0", c_int32),
                ("_j0", c_int32),
                ("_nx", c_int32),
                ("_ny", c_int32)]
    i0: Whole = Whole("_i0", c_int32)
    j0: Whole = Whole("_j0", c_int32)
    nx: Whole = Whole("_nx", c_int32)
    ny: Whole = Whole("_ny", c_int32)


class Tile(Struct):
    """A tile of 32 x 32 cells (less at the east and north rim): cells i ... i + nx - 1, j ... j + ny - 1."""
    _fields_ = [("_i", c_int32),
                ("_j", c_int32),
                ("_nx", c_int32),
                ("_ny", c_int32),
                ("solid_min", c_float),
                ("solid_max", c_float),
                ("free_min", c_float),
                ("free_max", c_float),
                ("_changed_step", c_int64)]
    i: Whole = Whole("_i", c_int32)
    j: Whole = Whole("_j", c_int32)
    nx: Whole = Whole("_nx", c_int32)
    ny: Whole = Whole("_ny", c_int32)
    #: elevation of the solid surface H + hs [m]
    solid_min: float
    #: elevation of the solid surface H + hs [m]
    solid_max: float
    #: elevation of the visible surface H + max(W, hs) [m]
    free_min: float
    #: elevation of the visible surface H + max(W, hs) [m]
    free_max: float
    #: step of the newest publish that changed the solid or visible surface of a cell; at first that of the first publish
    changed_step: Whole = Whole("_changed_step", c_int64)


class WorldStats(Struct):
    """State now: extremes, limits at work, and the ledger."""
    _fields_ = [("struct_size", c_uint32),
                ("time", c_double),
                ("_steps", c_uint64),
                ("sand_volume", c_double),
                ("water_volume", c_double),
                ("sand_initial", c_double),
                ("water_initial", c_double),
                ("sand_in", c_double),
                ("sand_out", c_double),
                ("water_in", c_double),
                ("water_out", c_double),
                ("refused", c_double),
                ("_sand_drift_quanta", c_int64),
                ("_water_drift_quanta", c_int64),
                ("quantum", c_double),
                ("largest_sand_depth", c_double),
                ("largest_total_water_depth", c_double),
                ("largest_water_speed", c_double),
                ("largest_sand_speed", c_double),
                ("smallest_depth", c_double),
                ("_not_finite", c_uint64),
                ("_clamped_faces", c_uint64),
                ("_capped_faces", c_uint64),
                ("_limited_cells", c_uint64),
                ("_tiles", c_uint64),
                ("_active_tiles", c_uint64),
                ("_hash", c_uint64),
                ("_high_columns", c_uint64),
                ("_wet_faces", c_uint64),
                ("_clamped_water_faces", c_uint64),
                ("_capped_water_faces", c_uint64),
                ("_limited_water_cells", c_uint64),
                ("_sand_faces", c_uint64),
                ("unlimited_dt", c_double)]
    struct_size: int
    #: [s]
    time: float
    steps: Whole = Whole("_steps", c_uint64)
    #: [m3] now
    sand_volume: float
    water_volume: float
    #: [m3] at creation
    sand_initial: float
    water_initial: float
    #: [m3] by sources, sinks, rain, evaporation and sides since creation
    sand_in: float
    #: [m3] by sources, sinks, rain, evaporation and sides since creation
    sand_out: float
    water_in: float
    water_out: float
    #: [m3] of sources and rain that found no room below method.largest_height, the highest elevation
    refused: float
    #: now - (initial + in - out) in quanta of depth x cell area; 0 = exact; sums stop at 2^60
    sand_drift_quanta: Whole = Whole("_sand_drift_quanta", c_int64)
    water_drift_quanta: Whole = Whole("_water_drift_quanta", c_int64)
    #: [m]
    quantum: float
    #: hs [m]
    largest_sand_depth: float
    #: W [m]
    largest_total_water_depth: float
    #: largest face velocity of pure and mixed water [m/s]
    largest_water_speed: float
    #: [m/s]
    largest_sand_speed: float
    #: least hs or W [m]: never negative
    smallest_depth: float
    #: values that are NaN or infinite: never any
    not_finite: Whole = Whole("_not_finite", c_uint64)
    #: faces at the velocity clamp
    clamped_faces: Whole = Whole("_clamped_faces", c_uint64)
    #: faces whose gravity the next step caps
    capped_faces: Whole = Whole("_capped_faces", c_uint64)
    #: cells whose outflow the next step limits
    limited_cells: Whole = Whole("_limited_cells", c_uint64)
    #: of the world, and of those the ones that the newest step ran over; 0 without active tiles. Where water and sand have a list each,
    #: those in the longer one
    tiles: Whole = Whole("_tiles", c_uint64)
    #: of the world, and of those the ones that the newest step ran over; 0 without active tiles. Where water and sand have a list each,
    #: those in the longer one
    active_tiles: Whole = Whole("_active_tiles", c_uint64)
    #: 64-bit state hash, ghosts excluded
    hash: Whole = Whole("_hash", c_uint64)
    #: columns of terrain, sand and water above method.largest_height, which flow and pushes can pile up: there heights are rounded like
    #: any float, and the books drift
    high_columns: Whole = Whole("_high_columns", c_uint64)
    #: faces beside water deeper than method.dry_threshold, inside it too: what the next three are of
    wet_faces: Whole = Whole("_wet_faces", c_uint64)
    #: those of the counts above that hold water; the rest hold sand
    clamped_water_faces: Whole = Whole("_clamped_water_faces", c_uint64)
    capped_water_faces: Whole = Whole("_capped_water_faces", c_uint64)
    limited_water_cells: Whole = Whole("_limited_water_cells", c_uint64)
    #: faces beside sand deeper than method.dry_threshold
    sand_faces: Whole = Whole("_sand_faces", c_uint64)
    #: the time step with which, as far as this state tells, neither clamp nor cap would hold water; dt where none does [s]
    unlimited_dt: float


class QueryResult(Struct):
    """The state at one point."""
    _fields_ = [("terrain", c_float),
                ("sand_depth", c_float),
                ("water_depth", c_float),
                ("surface", c_float),
                ("_velocity", c_float * 2),
                ("_normal", c_float * 3),
                ("saturation", c_float),
                ("_inside", c_int32)]
    #: elevation of the ground [m]; elevations and depths are bilinear between cell centres
    terrain: float
    #: [m]
    sand_depth: float
    #: pure water above the sand [m]; 0 where all four cells around are dry
    water_depth: float
    #: elevation of the visible surface, H + max(W, hs) [m]. At the water's edge it leads from the water's surface in the last wet cell to
    #: the ground of the dry one, as a mesh through the cell centres does
    surface: float
    #: of the pure water, between faces [m/s]; 0 on dry faces
    velocity: Row = Row("_velocity")
    #: of the visible surface, unit length, up; slopes bilinear between cell centres
    normal: Row = Row("_normal")
    #: W/(W + hs) of the sand, 0 without sand
    saturation: float
    #: 0: the point is outside the grid, all else is 0
    inside: Flag = Flag("_inside")


class Body(Struct):
    """A body in the water. World axes: x east, y north, z up."""
    _fields_ = [("struct_size", c_uint32),
                ("_shape", c_int32),
                ("_position", c_float * 3),
                ("_orientation", c_float * 4),
                ("_half_size", c_float * 3),
                ("radius", c_float),
                ("_velocity", c_float * 3),
                ("_angular_velocity", c_float * 3),
                ("water_density", c_float),
                ("gravity", c_float),
                ("linear_drag", c_float),
                ("quadratic_drag", c_float),
                ("_samples", c_int32)]
    _defaults_ = {"orientation": [0, 0, 0, 1.0],
                  "half_size": [0.5, 0.5, 0.5],
                  "radius": 0.5,
                  "water_density": 1000.0,
                  "gravity": 9.81,
                  "quadratic_drag": 1.0,
                  "samples": 4}
    struct_size: int
    shape: Member[BodyShape] = Member("_shape", BodyShape)
    #: of its middle [m]
    position: Row = Row("_position")
    #: unit quaternion x, y, z, w from the body's axes to the world's; spheres ignore it
    orientation: Row = Row("_orientation")
    #: box: half edges along its own axes [m], above 0
    half_size: Row = Row("_half_size")
    #: sphere [m], above 0
    radius: float
    #: [m/s]
    velocity: Row = Row("_velocity")
    #: about the world's axes [rad/s]
    angular_velocity: Row = Row("_angular_velocity")
    #: [kg/m3], 0 or more; default 1000
    water_density: float
    #: [m/s2], 0 or more; default 9.81
    gravity: float
    #: of the whole body [kg/s], 0 or more; default 0
    linear_drag: float
    #: drag coefficient, dimensionless, 0 or more; default 1
    quadratic_drag: float
    #: columns per side, 1 ... 16; default 4
    samples: Whole = Whole("_samples", c_int32)


class Edit(Struct):
    """One edit. A cell at a hard rim counts by the share that lies inside. The shape may lie outside the grid in part or as a whole.
    Positions are kept to 1/256 of a cell."""
    _fields_ = [("struct_size", c_uint32),
                ("_kind", c_int32),
                ("_layer", c_int32),
                ("_capsule", c_int32),
                ("_step", c_uint64),
                ("x0", c_double),
                ("y0", c_double),
                ("x1", c_double),
                ("y1", c_double),
                ("radius", c_double),
                ("softness", c_double),
                ("amount", c_double),
                ("strength", c_double),
                ("velocity_x", c_double),
                ("velocity_y", c_double),
                ("_stamp", c_uint32),
                ("_player", c_uint64)]
    _defaults_ = {"radius": 1.0,
                  "softness": 0.5,
                  "strength": 1.0}
    struct_size: int
    kind: Member[EditKind] = Member("_kind", EditKind)
    #: of brush and stamp
    layer: Member[Layer] = Member("_layer", Layer)
    #: brush and push: 0 = disc round (x0, y0), 1 = all within radius of the line from (x0, y0) to (x1, y1)
    capsule: Flag = Flag("_capsule")
    #: the water step ahead of which it acts, as wadi_world_get_time counts; 0 = the next one
    step: Whole = Whole("_step", c_uint64)
    #: [m], -1e9 ... 1e9; of a stamp the low corner
    x0: float
    #: [m], -1e9 ... 1e9; of a stamp the low corner
    y0: float
    #: [m], capsule and stamp only; of a stamp the high corner, greater than the low one
    x1: float
    #: [m], capsule and stamp only; of a stamp the high corner, greater than the low one
    y1: float
    #: [m], 1e-9 ... 1e9, brush and push
    radius: float
    #: 0 ... 1, brush and push: share of the radius over which the effect falls to 0 (3 s^2 - 2 s^3)
    softness: float
    #: brush: change at the centre [m], of the terrain's elevation or of a layer's depth, water's being W; stamp: the same per unit of the
    #: image. At most twice method.largest_height up or down
    amount: float
    #: 0 ... 1, push: how far velocities are drawn to the body's at the centre
    strength: float
    #: [m/s], -1e4 ... 1e4, push: the body's velocity
    velocity_x: float
    velocity_y: float
    #: stamp: its number, from wadi_world_create_stamp
    stamp: Whole = Whole("_stamp", c_uint32)
    #: 0 ... 4294967295: those of one step act by rising player, whoever was queued first; default 0
    player: Whole = Whole("_player", c_uint64)


class DeviceValues(Struct):
    """Rows of floats in memory of the device or the host, the south first."""
    _fields_ = [("struct_size", c_uint32),
                ("_handle_kind", c_int32),
                ("_handle", c_uint64),
                ("_offset", c_uint64),
                ("_row_pitch", c_uint64)]
    struct_size: int
    #: HOST_POINTER: any world, read before the call returns. Else memory of the API that the world runs in: CUDA_POINTER of its device,
    #: or VULKAN_BUFFER of its vulkan_host, made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT, CONCURRENT or owned by queue_family
    handle_kind: Member[HandleKind] = Member("_handle_kind", HandleKind)
    #: address, or VkBuffer
    handle: Whole = Whole("_handle", c_uint64)
    #: of the region's south-west value [bytes], a multiple of 4
    offset: Whole = Whole("_offset", c_uint64)
    #: [bytes], a multiple of 4, at least 4 * nx of the region; 0 = 4 * nx
    row_pitch: Whole = Whole("_row_pitch", c_uint64)


class Sample(Struct):
    """A value at a time. In a series it is linear between samples and constant outside; one sample is constant."""
    _fields_ = [("time", c_double),
                ("value", c_double)]
    #: simulated, as wadi_world_get_time counts [s]
    time: float
    value: float


class Source(Struct):
    """A source or drain of a world: a tap, a spring, a pump, a conveyor. Numbers as "sources" of level files have them."""
    _fields_ = [("struct_size", c_uint32),
                ("_shape", c_int32),
                ("_sand", c_int32),
                ("_drain", c_int32),
                ("_center", c_double * 2),
                ("radius", c_double),
                ("_from_", c_double * 2),
                ("_to", c_double * 2),
                ("_set_velocity", c_int32),
                ("_rate_count", c_uint32),
                ("_discharge_count", c_uint32),
                ("_level_count", c_uint32),
                ("_velocity", c_double * 2),
                ("rate", POINTER(Sample)),
                ("discharge", POINTER(Sample)),
                ("level", POINTER(Sample)),
                ("_step", c_uint64),
                ("_player", c_uint64)]
    _defaults_ = {"radius": 1.0}
    struct_size: int
    shape: Member[SourceShape] = Member("_shape", SourceShape)
    #: 1 = of sand, 0 = of water
    sand: Flag = Flag("_sand")
    #: 1 = with `level`: takes away what stands above, too
    drain: Flag = Flag("_drain")
    #: x, y of point and disc [m]
    center: Row = Row("_center")
    #: disc [m], above 0
    radius: float
    #: x, y of a box's south-west and north-east corner [m], `to` the greater
    from_: Row = Row("_from_")
    #: x, y of a box's south-west and north-east corner [m], `to` the greater
    to: Row = Row("_to")
    #: 1 = `velocity` holds
    set_velocity: Flag = Flag("_set_velocity")
    #: samples, 0 ... 4096; 0 = there is no such series. A source has a rate, a discharge or a level; with a level the other is the most
    #: that it moves
    rate_count: Whole = Whole("_rate_count", c_uint32)
    discharge_count: Whole = Whole("_discharge_count", c_uint32)
    level_count: Whole = Whole("_level_count", c_uint32)
    #: forced on the water inside while something is added [m/s], -1e4 ... 1e4
    velocity: Row = Row("_velocity")
    #: depth per time [m/s], -1e4 ... 1e4; below 0 it takes away; 0 = off
    rate: Any
    #: volume per time [m3/s], -1e9 ... 1e9, shared by the cells inside
    discharge: Any
    #: of water: elevation of the surface that it holds in each cell [m]
    level: Any
    #: wadi_world_set_source: the water step ahead of which it changes; 0 = the next one
    step: Whole = Whole("_step", c_uint64)
    #: as wadi_edit.player
    player: Whole = Whole("_player", c_uint64)


class MaterialInfo(Struct):
    """One number of the material."""
    _fields_ = [("_name", c_char * 32),
                ("value", c_double),
                ("least", c_double),
                ("most", c_double)]
    #: as level files write it: "friction", "cohesion_wet", "saturation[0]"
    name: Text = Text("_name")
    #: now; units as in level files
    value: float
    #: what wadi_world_set_material takes
    least: float
    #: what wadi_world_set_material takes
    most: float


class EffectInfo(Struct):
    """As wadi_effect_info."""
    _fields_ = [("_name", c_char * 32),
                ("_on", c_int32),
                ("_why", c_char * 160)]
    #: as level files write it
    name: Text = Text("_name")
    #: 1 = its passes run and its fields exist
    on: Flag = Flag("_on")
    #: one sentence: why it is on or off
    why: Text = Text("_why")


class MemoryItem(Struct):
    """As wadi_memory_item."""
    _fields_ = [("_label", c_char * 64),
                ("_bytes", c_uint64)]
    #: the field, or what the buffer is for
    label: Text = Text("_label")
    bytes: Whole = Whole("_bytes", c_uint64)


class StageTiming(Struct):
    """As wadi_stage_timing."""
    _fields_ = [("_name", c_char * 64),
                ("milliseconds", c_double),
                ("_passes", c_uint32)]
    name: Text = Text("_name")
    #: mean per water step, all its sand substeps together
    milliseconds: float
    #: dispatches per water step
    passes: Whole = Whole("_passes", c_uint32)


#: Each call: what it returns, what it takes.
CALLS: dict[str, tuple[Any, list[Any]]] = {
    "wadi_get_abi_version": (c_uint32, []),
    "wadi_get_version": (c_uint32, []),
    "wadi_get_last_error": (c_char_p, []),
    "wadi_list_devices": (c_int32, [POINTER(DeviceInfo), POINTER(c_uint32), c_char_p, c_size_t]),
    "wadi_list_accuracy_presets": (c_int32, [POINTER(AccuracyPreset), POINTER(c_uint32)]),
    "wadi_create_world_from_level": (c_int32, [c_char_p, POINTER(LevelOverrides), POINTER(DeviceOptions), POINTER(WorldId)]),
    "wadi_create_world_from_level_text": (c_int32, [c_char_p, ReadFileCallback, c_void_p, POINTER(LevelOverrides), POINTER(DeviceOptions),
        POINTER(WorldId)]),
    "wadi_get_level_cost": (c_int32, [c_char_p, POINTER(LevelOverrides), POINTER(Cost)]),
    "wadi_get_level_text_cost": (c_int32, [c_char_p, ReadFileCallback, c_void_p, POINTER(LevelOverrides), POINTER(Cost)]),
    "wadi_create_world_from_arrays": (c_int32, [POINTER(WorldArrays), POINTER(DeviceOptions), POINTER(WorldId)]),
    "wadi_destroy_world": (c_int32, [WorldId]),
    "wadi_world_get_info": (c_int32, [WorldId, POINTER(WorldInfo)]),
    "wadi_world_get_warning": (c_char_p, [WorldId, c_uint32]),
    "wadi_world_set_update_settings": (c_int32, [WorldId, POINTER(UpdateSettings)]),
    "wadi_world_update": (c_int32, [WorldId, c_uint64, POINTER(Frame)]),
    "wadi_world_step": (c_int32, [WorldId, c_uint32]),
    "wadi_world_get_time": (c_int32, [WorldId, POINTER(c_double), POINTER(c_uint64)]),
    "wadi_world_set_outputs": (c_int32, [WorldId, c_uint32]),
    "wadi_world_get_view": (c_int32, [WorldId, c_int32, c_int32, POINTER(OutputView)]),
    "wadi_world_set_host_outputs": (c_int32, [WorldId, c_uint32]),
    "wadi_world_wait_for_outputs": (c_int32, [WorldId]),
    "wadi_world_get_host_output": (c_int32, [WorldId, c_int32, POINTER(c_void_p), POINTER(c_uint64), POINTER(c_uint64)]),
    "wadi_world_get_tiles": (c_int32, [WorldId, POINTER(Tile), POINTER(c_uint32), POINTER(c_uint64)]),
    "wadi_world_get_dirty_regions": (c_int32, [WorldId, c_int64, POINTER(Region), POINTER(c_uint32), POINTER(c_uint64)]),
    "wadi_field_name": (c_char_p, [c_int32]),
    "wadi_world_read_field": (c_int32, [WorldId, c_int32, c_void_p, c_size_t]),
    "wadi_world_read_region": (c_int32, [WorldId, c_int32, POINTER(Region), c_void_p, c_size_t]),
    "wadi_world_get_stats": (c_int32, [WorldId, POINTER(WorldStats)]),
    "wadi_world_get_hash": (c_int32, [WorldId, POINTER(c_uint64)]),
    "wadi_world_query": (c_int32, [WorldId, c_void_p, c_uint32, POINTER(c_uint64)]),
    "wadi_world_get_query": (c_int32, [WorldId, c_uint64, POINTER(QueryResult), c_uint32, POINTER(c_uint32), POINTER(c_uint64)]),
    "wadi_buoyancy_points": (c_int32, [POINTER(Body), c_void_p, POINTER(c_uint32)]),
    "wadi_buoyancy_force": (c_int32, [POINTER(Body), POINTER(QueryResult), c_uint32, c_void_p, c_void_p]),
    "wadi_world_edit": (c_int32, [WorldId, POINTER(Edit), c_uint32]),
    "wadi_world_create_stamp": (c_int32, [WorldId, c_int32, c_int32, c_void_p, POINTER(c_uint32)]),
    "wadi_world_write_region": (c_int32, [WorldId, c_int32, POINTER(Region), c_void_p, c_size_t]),
    "wadi_world_write_region_from": (c_int32, [WorldId, c_int32, POINTER(Region), POINTER(DeviceValues)]),
    "wadi_world_prepare_effects": (c_int32, [WorldId]),
    "wadi_world_trim": (c_int32, [WorldId]),
    "wadi_world_get_source": (c_int32, [WorldId, c_uint32, POINTER(Source)]),
    "wadi_world_set_source": (c_int32, [WorldId, c_uint32, POINTER(Source)]),
    "wadi_world_get_material": (c_int32, [WorldId, POINTER(MaterialInfo), POINTER(c_uint32)]),
    "wadi_world_set_material": (c_int32, [WorldId, c_char_p, c_double]),
    "wadi_world_save": (c_int32, [WorldId, c_void_p, POINTER(c_size_t)]),
    "wadi_world_load": (c_int32, [WorldId, c_void_p, c_size_t]),
    "wadi_world_get_snapshot_cost": (c_int32, [WorldId, c_void_p, c_size_t, POINTER(Cost)]),
    "wadi_world_save_file": (c_int32, [WorldId, c_char_p]),
    "wadi_world_load_file": (c_int32, [WorldId, c_char_p]),
    "wadi_world_begin_save": (c_int32, [WorldId, POINTER(c_uint64)]),
    "wadi_world_end_save": (c_int32, [WorldId, c_uint64, c_void_p, POINTER(c_size_t)]),
    "wadi_world_set_rollback": (c_int32, [WorldId, c_uint32, c_uint32]),
    "wadi_world_get_rollback_steps": (c_int32, [WorldId, POINTER(c_uint64), POINTER(c_uint32)]),
    "wadi_world_roll_back": (c_int32, [WorldId, c_uint64, POINTER(c_uint64)]),
    "wadi_world_set_command_log": (c_int32, [WorldId, c_int32]),
    "wadi_world_get_commands": (c_int32, [WorldId, c_void_p, POINTER(c_size_t)]),
    "wadi_world_get_commands_since": (c_int32, [WorldId, c_uint64, c_uint64, c_void_p, POINTER(c_size_t)]),
    "wadi_world_play_commands": (c_int32, [WorldId, c_void_p, c_size_t]),
    "wadi_world_get_commands_cost": (c_int32, [WorldId, c_void_p, c_size_t, POINTER(Cost)]),
    "wadi_world_describe_plan": (c_size_t, [WorldId, c_char_p, c_size_t]),
    "wadi_describe_table": (c_size_t, [c_char_p, c_char_p, c_size_t]),
    "wadi_world_get_effects": (c_int32, [WorldId, POINTER(EffectInfo), POINTER(c_uint32)]),
    "wadi_world_get_memory": (c_int32, [WorldId, POINTER(MemoryItem), POINTER(c_uint32)]),
    "wadi_world_set_profiling": (c_int32, [WorldId, c_int32]),
    "wadi_world_get_stage_timings": (c_int32, [WorldId, POINTER(StageTiming), POINTER(c_uint32)]),
    "wadi_world_set_checking": (c_int32, [WorldId, c_int32]),
    "wadi_world_get_error": (c_int32, [WorldId]),
    "wadi_cuda_wait": (c_int32, [WorldId, c_void_p]),
    "wadi_cuda_signal": (c_int32, [WorldId, c_void_p]),
}
