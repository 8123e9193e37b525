/* Wadi: sand, water and wet sand on a height field. This is the plugin's whole interface, C99, in the order of use:
 *
 *   versions, errors . devices . worlds . steps and frames . outputs . reading . points and bodies . edits . sources
 *   material . saving and going back . command log . looking inside
 *
 * Units: metres, seconds, kilograms. Fields are row-major, nx * ny floats, x fastest. Row 0 is the south side (y = 0), column 0 the west
 * side (x = 0); z is up. "Elevation" and "surface" are heights above the level's zero. "Depth" is how thick a layer is. H is the
 * elevation of the ground, hs the depth of sand, W the depth of all water, above the sand and inside it.
 *
 * Each call says what it does, then its limits, then what it waits for and which errors it has of its own:
 *   Waits   A call without this line waits for nothing. "The steps": it waits until the steps asked for so far are done. "Room": it waits
 *           for the device if memory must be made or freed. Everything else runs beside the host.
 *   Errors  Every call that can fail returns a wadi_result; wadi_get_last_error() then has one line of text for this thread. Some errors
 *           are not repeated at each call: BAD_ARGUMENT (a null or destroyed world; a struct, array or result that is NULL and may not
 *           be; a wrong struct_size), BUSY, INTERNAL, and DEVICE_LOST (from calls that use a device). Nor is OUT_OF_MEMORY of the host's
 *           own memory. After it you must destroy the world, unless the call says otherwise. An error changes nothing where the call
 *           does not say more.
 *   Counts  *count: room in elements in, their number out; the array may be NULL to ask the number.
 * No call aborts, throws or prints. A world is used by one thread at a time: a call that meets another one inside the same world does
 * nothing and returns BUSY. Different worlds are independent. A forked child cannot use its parent's worlds. No call may come from a
 * signal handler: it may wait for a lock that the interrupted thread holds. Calls ignore the calling thread's floating-point environment,
 * and leave it as it was.
 *
 * A struct that begins with struct_size grows at its end in later versions: start from its wadi_default_*() function, then change what
 * you need. A host and a library of different versions understand each other as long as WADI_ABI_VERSION is the same. What a host's
 * struct lacks has its default. A field that a library does not know must be 0, or the library refuses the call and says so. In arrays
 * of such structs all have the size of the first. Structs without struct_size, and what enums mean, never change.
 */
#ifndef WADI_H
#define WADI_H

#include <stddef.h>
#include <stdint.h>

#if defined(WADI_STATIC) /* the library is linked into the host */
#define WADI_API
#elif defined(_WIN32)
#if defined(WADI_BUILD)
#define WADI_API __declspec(dllexport)
#else
#define WADI_API __declspec(dllimport)
#endif
#else
#define WADI_API __attribute__((visibility("default")))
#endif

/* A struct that is all zero but for its size. */
#if defined(__cplusplus)
#define WADI_ZERO_STRUCT(type) type value = {}; value.struct_size = sizeof(type)
#else
#define WADI_ZERO_STRUCT(type) type value = {0}; value.struct_size = sizeof(type)
#endif

/* Enums have 32 bits, in structs too. */
#if defined(__cplusplus)
#define WADI_ENUM : int32_t
#else
#define WADI_ENUM
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Versions, errors ---- */

/** Counts up when hosts must be compiled anew; everything else grows. */
#define WADI_ABI_VERSION 1u
#define WADI_VERSION_MAJOR 0u
#define WADI_VERSION_MINOR 1u
#define WADI_VERSION_PATCH 0u
#define WADI_MAKE_VERSION(major, minor, patch) (((major) << 22) | ((minor) << 12) | (patch))
/** The version of this header. */
#define WADI_VERSION WADI_MAKE_VERSION(WADI_VERSION_MAJOR, WADI_VERSION_MINOR, WADI_VERSION_PATCH)

/** The ABI version of the library that is loaded; compare it with WADI_ABI_VERSION. */
WADI_API uint32_t wadi_get_abi_version(void);
/** The version of the library that is loaded, as WADI_MAKE_VERSION writes it: at least WADI_VERSION has all that this header names. */
WADI_API uint32_t wadi_get_version(void);

/** 0 = no, 1 = yes. */
typedef int32_t wadi_bool;

typedef enum wadi_result WADI_ENUM {
    WADI_OK = 0,
    WADI_ERROR_BAD_ARGUMENT = 1,  /* a value is wrong; the message names it and its range */
    WADI_ERROR_NOT_FOUND = 2,     /* no such file, level, backend, device or effect */
    WADI_ERROR_BAD_FILE = 3,      /* a file is malformed; the message names the field */
    WADI_ERROR_NOT_SUPPORTED = 4, /* this build or device cannot do it */
    WADI_ERROR_OUT_OF_MEMORY = 5,
    WADI_ERROR_DEVICE_LOST = 6,   /* sticky for the world; destroy it and create another */
    WADI_ERROR_INTERNAL = 7,      /* our bug: please report the message */
    WADI_NOT_READY = 8,           /* not an error: ask again later */
    WADI_ERROR_BUSY = 9,          /* another thread is inside a call on this world; nothing was done */
    WADI_CANCELLED = 10           /* not an error: the host's progress callback ended the call; nothing was made */
} wadi_result;
typedef char wadi_enum_has_32_bits[sizeof(wadi_result) == 4 ? 1 : -1];

/** One line about the last error on this thread, "" before the first; never NULL. Calls that succeed leave it as it is; the pointer
 *  stays good as long as the thread, with the text of the newest error. */
WADI_API const char* wadi_get_last_error(void);

typedef enum wadi_log_level WADI_ENUM {
    WADI_LOG_ERROR = 0,
    WADI_LOG_WARNING = 1,
    WADI_LOG_INFORMATION = 2
} wadi_log_level;
/** Gets what the library has to tell.
 *  Warnings are advice on a level, and limits that hold a running world back, each kind once, with the time step or setting that would
 *  end it. Information is each world made and each change of its effects. An error is a lost device. Messages of drivers and validation
 *  layers come here, too.
 *  Called during a call of the library, or from a driver's thread. It must not call the library; what it throws is lost. */
typedef void (*wadi_log_callback)(void* user, wadi_log_level level, const char* message);

/* ---- Devices ---- */

typedef struct wadi_device_info {
    uint32_t struct_size;
    char backend[16];
    int32_t index;             /* within its backend */
    char name[256];
    wadi_bool is_software;     /* 1 for the CPU and for software Vulkan devices */
    uint64_t memory_bytes;     /* 0 = unknown */
} wadi_device_info;
static inline wadi_device_info wadi_default_device_info(void) {
    WADI_ZERO_STRUCT(wadi_device_info);
    return value;
}
/** Lists the devices of all backends of this build.
 *  `notes` (may be NULL) receives one line per backend without a device, saying why, cut to notes_size bytes.
 *  Errors: BAD_ARGUMENT (sizes of infos that differ). */
WADI_API wadi_result wadi_list_devices(wadi_device_info* infos, uint32_t* count, char* notes, size_t notes_size);

/** Part `n` of a pass of the CPU backend: any thread may run it, parts in any order and at once. */
typedef void (*wadi_job)(void* data, uint32_t n);
/** The host's job system: runs job(data, n) for each n below count, on any of its threads or one after the other on one, and returns
 *  when all have returned. A part that has begun may wait for others that have begun: they must be threads, not fibres of one. A part that
 *  is left out, runs twice or begins late changes no bit; none may begin after wadi_destroy_world. Called from a thread of the library,
 *  several times a step; must not throw and must not call the library. */
typedef void (*wadi_run_jobs_callback)(void* user, uint32_t count, wadi_job job, void* data);
/** The host's memory: `bytes` (1 or more) at a multiple of `alignment`, a power of two, or NULL where it refuses. They need not be zero. */
typedef void* (*wadi_allocate_callback)(void* user, size_t bytes, size_t alignment);
/** Takes back, whole, what the allocate callback gave. Both are called from threads of the library and of the host, from several at
 *  once; they must not call the library; what they throw counts as a refusal. */
typedef void (*wadi_free_callback)(void* user, void* memory, size_t bytes);

/** What a level, a snapshot or a command log needs. All sums are known before the work begins; 0 where one has no such sum.
 *  As a host's limits: the most of each, 0 = no limit but the library's own. */
typedef struct wadi_cost {
    uint32_t struct_size;
    uint64_t cells;               /* of the grid */
    uint64_t file_bytes;          /* bytes that are read: a level's text, its maps and series; a snapshot; a log */
    uint64_t map_values;          /* numbers that maps and series hold once they are decoded */
    uint64_t work;                /* of drawing a level: looks at shapes, some nanoseconds of one thread each */
    uint64_t host_bytes;          /* of the host's memory while it loads, at most, beside those of the device */
    uint64_t device_bytes;        /* that the world holds on its device once it is loaded, at most; with the backend "cpu" they are the
                                     host's. Of a log: the bytes of its stamps */
    uint64_t steps;               /* of a level: the steps of its duration (0 for a map alone); of a snapshot: the step that it is of;
                                     of a log: its last step */
    uint64_t edits_per_step;      /* the most edits that a level or a log brings into one step */
    uint64_t commands_per_step;   /* the most other commands that a log brings into one step */
} wadi_cost;
static inline wadi_cost wadi_default_cost(void) {
    WADI_ZERO_STRUCT(wadi_cost);
    return value;
}
/** Hears how far the call that makes a world is, as a share from 0 to 1 that never falls. Returns 1 to go on, or 0 to end the call with
 *  WADI_CANCELLED. Called on that call's thread alone, at least once for each layer of a level, and also before the device is opened and
 *  before the world is handed out. It is not called while a file is decoded or a driver compiles. It must not call the library. Should
 *  not throw: whatever it throws ends the call. */
typedef wadi_bool (*wadi_progress_callback)(void* user, double share);

/** Where and how a world runs. */
typedef struct wadi_device_options {
    uint32_t struct_size;
    const char* backend;       /* "auto" (a real GPU first, else the CPU), or one that wadi_list_devices names: "cpu", "vulkan" ... */
    int32_t device;            /* index from wadi_list_devices, -1 = the backend's best */
    int32_t threads;           /* of the CPU backend, and for any to load levels and to count and hash states. 0 = all cores; the CPU
                                  backend's steps then leave one to the host's frame */
    wadi_bool validate;        /* 1 = Vulkan validation layers; messages go to the log callback */
    wadi_log_callback log;     /* may be NULL */
    void* log_user;
    const struct wadi_vulkan_host* vulkan_host; /* NULL, or the host's own Vulkan device (wadi_vulkan.h): "auto" and "vulkan" run on it,
                                                   "cuda" beside it */
    wadi_run_jobs_callback run_jobs; /* NULL, or: the CPU backend has no threads of its own but the one that takes steps in order; a
                                        pass has `threads` parts. Every bit stays, whatever the number */
    void* jobs_user;
    wadi_allocate_callback allocate_memory; /* set both callbacks or neither (NULL). With the CPU backend all that wadi_world_get_memory
                                               lists comes from here: fields, outputs, copies for the host, snapshots under way, kept
                                               states, queries. All of it is freed before wadi_destroy_world returns. If it refuses, the
                                               call fails with OUT_OF_MEMORY and the world is as it was, except that kept states are
                                               dropped where a promotion finds no room for theirs. Not from here: what a call needs while
                                               it lasts (level files, statistics), edits that wait, the command log, programs, threads.
                                               Nor is the memory of GPU backends, which is the driver's */
    wadi_free_callback free_memory;
    void* memory_user;
    const wadi_cost* most;     /* NULL, or limits of the host's own. They are checked before a level, and later a snapshot or log of this
                                  world, is read further than its header. What passes one is BAD_FILE, with the sum and the limit */
    wadi_progress_callback progress; /* NULL, or hears how far the making of the world is, and may end it */
    void* progress_user;
} wadi_device_options;
static inline wadi_device_options wadi_default_device_options(void) {
    WADI_ZERO_STRUCT(wadi_device_options);
    value.backend = "auto";
    value.device = -1;
    return value;
}

/* ---- Worlds ---- */

/** A world by index and generation; all zero is null. Copy it freely; a destroyed one is recognised and refused. */
typedef struct wadi_world_id {
    uint32_t index;
    uint32_t generation;
} wadi_world_id;

/** A choice that a level makes, too. */
typedef enum wadi_choice WADI_ENUM {
    WADI_CHOICE_OFF = -1,
    WADI_CHOICE_LEVEL = 0, /* as the level says */
    WADI_CHOICE_ON = 1
} wadi_choice;
/** Tiles in which nothing changes any more are left out of a step; every bit stays, also in snapshots. */
typedef enum wadi_active_tiles WADI_ENUM {
    WADI_ACTIVE_TILES_OFF = -1,
    WADI_ACTIVE_TILES_LEVEL = 0, /* as the level says, by default CHEAP */
    WADI_ACTIVE_TILES_AUTO = 1,  /* on while little of the world is awake */
    WADI_ACTIVE_TILES_CHEAP = 2, /* AUTO in large grids on GPUs, else OFF */
    WADI_ACTIVE_TILES_8 = 8,     /* on, of 8 x 8 cells */
    WADI_ACTIVE_TILES_16 = 16,
    WADI_ACTIVE_TILES_32 = 32,
    WADI_ACTIVE_TILES_64 = 64
} wadi_active_tiles;
/** Overrides for a level file; a value of 0 or NULL keeps the file's. */
typedef struct wadi_level_overrides {
    uint32_t struct_size;
    int32_t nx, ny;            /* keeps the x extent and square cells, stretches maps in y, scales dt with dx */
    double dt;                 /* [s] */
    const char* method;        /* "robust" or "published" */
    const char* variant;       /* one of the level's variants; NULL = the level as it is. Not for terrain maps */
    const char* accuracy;      /* "draft", "balanced" or "accurate": half, all or twice the level's cells along x and y (nx, ny win), and
                                  two sand steps per water step. "accurate" has second order for water, too. "fine": the cells of the
                                  level's fine_grid, for GPUs. NULL, or "fine" where it has none = what the level says */
    wadi_active_tiles active_tiles;
    wadi_choice fused_stages;  /* ON = several stages in one pass wherever the effects allow, OFF = one by one. Every bit stays */
    wadi_bool any_files;       /* 1 = maps and series may lie anywhere that the process can read; 0 = in the level's folder and below it
                                  alone, links followed: no "..", no path from the root on. For levels of one's own */
    uint64_t draws;            /* WADI_OUTPUT_BIT of WADI_OUTPUT_FOAM, WADI_OUTPUT_WETNESS and WADI_OUTPUT_SILT, any of them, or 0: what the
                                  host will draw of what water carries and leaves. Effects foam and wetness are then on wherever there is
                                  water, silt where there is sand, too, and the level does not force them off. They move nothing, cost a
                                  pass each, and 8, 4 and 8 bytes a cell */
} wadi_level_overrides;
static inline wadi_level_overrides wadi_default_level_overrides(void) {
    WADI_ZERO_STRUCT(wadi_level_overrides);
    return value;
}

/** An accuracy preset. */
typedef struct wadi_accuracy_preset {
    const char* name;
    double cells;        /* factor on the level's cells along x and y; 0 = the level's fine_grid */
    int32_t substeps;    /* sand steps per water step; 0 = the level's */
    int32_t water_order; /* method.water_transport_order; 0 = the level's */
} wadi_accuracy_preset;
/** Lists the accuracy presets by rising accuracy. */
WADI_API wadi_result wadi_list_accuracy_presets(wadi_accuracy_preset* presets, uint32_t* count);

/** Creates a world from a level file (.json) or from a terrain map (.png, .r16, .r32, .raw, .hgt, .npy, .asc).
 *  overrides, options: NULL = the defaults.
 *  Waits: for compilers of drivers.
 *  Errors: NOT_FOUND, BAD_FILE, BAD_ARGUMENT, OUT_OF_MEMORY, NOT_SUPPORTED; no world is made. */
WADI_API wadi_result wadi_create_world_from_level(const char* path, const wadi_level_overrides* overrides,
                                                  const wadi_device_options* options, wadi_world_id* world);

/** Reads a file that a level names, for the host's own file system. Called with data NULL first: sets *size to the file's bytes;
 *  then with room for *size bytes: fills it and sets *size to what it wrote. Returns 1, or 0 where there is no such file. `name` is
 *  as the level writes it, '/' between folders, and never leads out of the level's folder but with overrides.any_files. Called only
 *  inside wadi_create_world_from_level_text, on its thread. Should not throw: whatever it throws ends that call with INTERNAL. */
typedef wadi_bool (*wadi_read_file_callback)(void* user, const char* name, void* data, size_t* size);
/** Creates a world from the text of a level file.
 *  Maps and series that it names come from read_file; with read_file NULL it may name none: nothing is read from disk.
 *  Waits and errors: those of wadi_create_world_from_level. */
WADI_API wadi_result wadi_create_world_from_level_text(const char* json, wadi_read_file_callback read_file, void* user,
                                                       const wadi_level_overrides* overrides, const wadi_device_options* options,
                                                       wadi_world_id* world);

/** What wadi_create_world_from_level, or ..._text, would cost. The level's text and series are read, and the headers of its maps;
 *  nothing is decoded or drawn and no device is opened. overrides: NULL = the defaults.
 *  Errors: those of the call that it is of, as far as that much shows them. */
WADI_API wadi_result wadi_get_level_cost(const char* path, const wadi_level_overrides* overrides, wadi_cost* cost);
WADI_API wadi_result wadi_get_level_text_cost(const char* json, wadi_read_file_callback read_file, void* user,
                                              const wadi_level_overrides* overrides, wadi_cost* cost);

/** A world from arrays: settings, and fields of nx * ny floats. NULL = zero everywhere. The settings are the text of a level file without
 *  its "terrain", "sand", "water", "velocities", "roughness" and "rain_map" entries. They may name no files. */
typedef struct wadi_world_arrays {
    uint32_t struct_size;
    const char* settings_json; /* must not be NULL; texts may stand in single quotes: "{'grid': {'nx': 64, 'ny': 64, 'dx': 0.5}, ...}" */
    int32_t nx, ny;            /* of the arrays; must equal the settings' grid */
    const float* terrain;      /* elevation of the ground [m] */
    const float* sand;         /* depth hs [m] */
    const float* water;        /* depth of all water, W [m] */
    const float* velocity_x;   /* water, at cell centres [m/s] */
    const float* velocity_y;
    const float* roughness;    /* what cells add to material.manning, 0 ... 1 [s/m^(1/3)] */
    const float* rain_map;     /* how many times the settings' "rain" falls on each cell, 0 ... 100; NULL = once everywhere */
} wadi_world_arrays;
static inline wadi_world_arrays wadi_default_world_arrays(void) {
    WADI_ZERO_STRUCT(wadi_world_arrays);
    return value;
}
/** Creates a world from arrays.
 *  Waits and errors: those of wadi_create_world_from_level. */
WADI_API wadi_result wadi_create_world_from_arrays(const wadi_world_arrays* arrays, const wadi_device_options* options,
                                                   wadi_world_id* world);

/** Frees a world.
 *  Waits: for what the device is at. */
WADI_API wadi_result wadi_destroy_world(wadi_world_id world);

typedef struct wadi_world_info {
    uint32_t struct_size;
    char name[64];
    int32_t nx, ny;
    double dx;                    /* [m] */
    double dt;                    /* water time step [s] */
    int32_t substeps;             /* T: sand substeps per water step */
    double duration;              /* the level's own length [s] */
    uint32_t passes_per_water_step;   /* dispatches outside the sand substeps */
    uint32_t passes_per_sand_substep;
    double bytes_per_cell;        /* state, ping-pong and scratch */
    uint64_t device_bytes;        /* everything the world holds on the device */
    char backend[16];
    char device_name[256];
    wadi_bool exact_float;        /* 1 = the device passed the exact-float self-test */
    uint32_t warning_count;
    double origin_x, origin_y;    /* of the grid's south-west corner in the coordinates of the map that the level was cut from, for a host
                                     to show [m]; 0 without a map. Every call counts from the corner */
    uint64_t source_count;        /* sources and drains that the world has now: wadi_world_get_source */
} wadi_world_info;
static inline wadi_world_info wadi_default_world_info(void) {
    WADI_ZERO_STRUCT(wadi_world_info);
    return value;
}
/** Tells what a world is. */
WADI_API wadi_result wadi_world_get_info(wadi_world_id world, wadi_world_info* info);
/** The text of warning n of the level; NULL and an error beyond the last. It lives as long as the world. */
WADI_API const char* wadi_world_get_warning(wadi_world_id world, uint32_t n);

/* ---- Steps and frames ---- */

/** How wadi_world_update turns host time into water steps. */
typedef struct wadi_update_settings {
    uint32_t struct_size;
    uint32_t max_steps_per_update; /* 1 ... 1024, default 8: time beyond it is dropped */
    uint32_t max_steps_in_flight;  /* 0 ... 64, default 8: once the device has this many unfinished water steps (or its queue of
                                      submissions is full), time is dropped. 0 = drop nothing for that reason; the call may wait */
    wadi_bool spread;              /* 1 = a water step is submitted as 1 water part and T sand parts, evenly over its dt. The bits are
                                      the same, and the load has no peak every dt. Default 0 */
    wadi_bool interpolate_outputs; /* 1 = every update also writes the interpolated set of the outputs; default 0 */
} wadi_update_settings;
static inline wadi_update_settings wadi_default_update_settings(void) {
    WADI_ZERO_STRUCT(wadi_update_settings);
    value.max_steps_per_update = 8;
    value.max_steps_in_flight = 8;
    return value;
}
/** Sets how updates take steps, from the next one on.
 *  Waits: nothing, unless interpolate_outputs changes: room, as wadi_world_set_outputs.
 *  Errors: BAD_ARGUMENT (out of range), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_set_update_settings(wadi_world_id world, const wadi_update_settings* settings);

/** What one update did. */
typedef struct wadi_frame {
    uint32_t struct_size;
    uint32_t steps;                /* water steps that became whole in this update */
    uint64_t total_steps;          /* whole water steps since creation */
    double time;                   /* simulated: total_steps * dt [s] */
    double interpolation;          /* in [0, 1): how far the host's clock is from the last whole step to the one to come. A renderer
                                      shows (1 - f) * last but one + f * last, one dt late, and moves evenly */
    uint64_t published_step;       /* of the outputs' current set; UINT64_MAX = none yet */
    uint64_t dropped_nanoseconds;       /* host time that became no step in this update; steps is then less than it asks for */
    uint64_t dropped_nanoseconds_total; /* and since the world was created */
    uint64_t limits_step;          /* the step of the newest look for limits that has arrived; UINT64_MAX = none yet. A world with a log
                                      callback looks every 64 steps where limits are at work, told below as wadi_world_stats does */
    uint64_t wet_faces, clamped_water_faces, capped_water_faces;
    uint64_t sand_faces, clamped_sand_faces, capped_sand_faces;
    uint64_t high_columns;
    double unlimited_dt;           /* [s] */
} wadi_frame;
static inline wadi_frame wadi_default_frame(void) {
    WADI_ZERO_STRUCT(wadi_frame);
    return value;
}
/** Advances by `host_nanoseconds` of host time since the last update (0 is allowed), then publishes the outputs: the call of each frame.
 *  Steps are fixed. After a total of t nanoseconds, less those dropped, floor(t / dt) water steps are done (dt as the double dt * 1e9,
 *  the quotient exact). So the same total gives the same bits in frames of any length. You may call wadi_world_step between updates. Its
 *  steps are beside this clock, which goes on where it was. Every call that reads or changes the state first finishes a step that
 *  `spread` began; the update in which it falls due does not repeat it.
 *  Waits: nothing, unless max_steps_in_flight is 0; a step ahead of which an edit brings a new material may (wadi_world_edit).
 *  Errors: OUT_OF_MEMORY (a new material). One that fails has not taken the time: repeated, it takes what steps are left of it. */
WADI_API wadi_result wadi_world_update(wadi_world_id world, uint64_t host_nanoseconds, wadi_frame* frame);

/** Advances by `steps` water steps of fixed dt.
 *  Returns before the device has finished; reads wait for it.
 *  Waits: while the device's queue is full.
 *  Errors: OUT_OF_MEMORY (a new material; the steps ahead of it are taken, wadi_world_get_time counts them). */
WADI_API wadi_result wadi_world_step(wadi_world_id world, uint32_t steps);

/** Simulated time [s] and water steps so far. Either pointer may be NULL. */
WADI_API wadi_result wadi_world_get_time(wadi_world_id world, double* seconds, uint64_t* steps);

/* ---- Outputs ---- */

/** Fields for drawing and collision, one value per cell (its centre), published on the device after the steps of an update. */
typedef enum wadi_output WADI_ENUM {
    WADI_OUTPUT_TERRAIN = 0,        /* elevation of the ground H [m], 1 float */
    WADI_OUTPUT_SAND_SURFACE = 1,   /* elevation of the solid surface H + hs [m], 1 float */
    WADI_OUTPUT_FREE_SURFACE = 2,   /* elevation of the visible surface H + max(W, hs) [m], 1 float */
    WADI_OUTPUT_SAND_DEPTH = 3,     /* hs [m], 1 float */
    WADI_OUTPUT_WATER_DEPTH = 4,    /* pure water above the sand, what its pores do not hold [m], 1 float */
    WADI_OUTPUT_SATURATION = 5,     /* W/(W + hs) where there is sand, else 0; 1 float */
    WADI_OUTPUT_FLOW = 6,           /* flow map: velocity of pure water, what is seen to move, east and north [m/s], 2 floats */
    WADI_OUTPUT_SAND_VELOCITY = 7,  /* east and north [m/s], 2 floats */
    WADI_OUTPUT_FOAM = 8,           /* 0 ... 1 from the present state of the pure water (depth h, velocity u), 1 float:
                                       max(clamp((Fr^2 - 1)/3), clamp((R - 0.15)/0.5)) * clamp(10 h/dx), clamps to 0 ... 1;
                                       Fr = |u|/sqrt(g h) (fast water), R = -h div(u)/sqrt(g h) (rising, breaking fronts).
                                       With effect foam that which drifts, fades and lies on the shore, at most 1: PACKED, too */
    WADI_OUTPUT_NORMAL = 9,         /* unit normal of the visible surface: east, north, up, 0; 4 floats */
    WADI_OUTPUT_SMOOTH_SURFACE = 10, /* elevation of the visible surface after a 3 x 3 Gaussian [m], 1 float */
    WADI_OUTPUT_PACKED = 11,        /* one texel to draw a surface with: FREE_SURFACE, WATER_DEPTH, FOAM, SATURATION; 4 floats */
    WADI_OUTPUT_PACKED_HALF = 12,   /* the same, each rounded to a 16-bit float (11 bits: a surface 16 ... 32 m up to 16 mm), at most
                                       65504; 8 bytes */
    WADI_OUTPUT_WETNESS = 13,       /* with effect wetness how wet the ground is, 1 under water, less the longer it is dry, else 0; 1 float */
    WADI_OUTPUT_SILT = 14,          /* with effect silt what makes the water muddy, per area of the ground [kg/m2], else 0; 1 float. Grains
                                       of 0.08 mm hide 1 - exp(-7 s) of the ground below them, finer ones more */
    WADI_OUTPUT_COUNT = 15
} wadi_output;
/** Outputs, each by WADI_OUTPUT_BIT. */
typedef uint32_t wadi_output_mask;
/** Bit of an output in a mask. */
#define WADI_OUTPUT_BIT(output) (1u << (output))
/** One more bit for wadi_world_set_outputs: lowest and highest elevation of tiles and their changes, wadi_world_get_tiles. */
#define WADI_OUTPUT_TILES_BIT 0x80000000u

/** Chooses what every update publishes; 0 = nothing, which costs nothing.
 *  Each output takes three buffers (previous, current, being written), the tiles in addition those of SAND_SURFACE and FREE_SURFACE.
 *  Where the mask changes, views taken before are void, and there is nothing to view until the next update.
 *  Waits: room, where the mask changes.
 *  Errors: BAD_ARGUMENT (an unknown bit), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_set_outputs(wadi_world_id world, wadi_output_mask mask);

typedef enum wadi_output_set WADI_ENUM {
    WADI_OUTPUT_PREVIOUS = 0,     /* the publish before the current one */
    WADI_OUTPUT_CURRENT = 1,      /* the newest publish; wadi_frame.published_step */
    WADI_OUTPUT_INTERPOLATED = 2  /* between the two at the host's time, one dt late; outputs of 1 float, and only with
                                     wadi_update_settings.interpolate_outputs. Written anew by each update; an update leaves it
                                     as it is while the device is two updates behind */
} wadi_output_set;
typedef enum wadi_handle_kind WADI_ENUM {
    WADI_HANDLE_HOST_POINTER = 0,  /* CPU backend: an address */
    WADI_HANDLE_VULKAN_BUFFER = 1, /* VkBuffer */
    WADI_HANDLE_CUDA_POINTER = 2   /* CUdeviceptr */
} wadi_handle_kind;
typedef enum wadi_format WADI_ENUM {
    WADI_FORMAT_R32_FLOAT = 1,
    WADI_FORMAT_R32G32_FLOAT = 2,
    WADI_FORMAT_R32G32B32A32_FLOAT = 4,
    WADI_FORMAT_R16G16B16A16_FLOAT = 8 /* 8 bytes; those above: so many floats of 4 bytes */
} wadi_format;
/** Where a published field lies on the device. Read only. */
typedef struct wadi_output_view {
    uint32_t struct_size;
    wadi_handle_kind handle_kind;
    uint64_t handle;               /* the same for a buffer until wadi_world_set_outputs changes the mask */
    uint64_t offset;               /* of cell (0, 0), past the ghost cells [bytes]; VkBufferImageCopy.bufferOffset */
    uint64_t row_pitch;            /* [bytes]; over the size of a cell it is VkBufferImageCopy.bufferRowLength */
    uint64_t buffer_bytes;
    int32_t nx, ny;
    wadi_format format;
    uint64_t step;                 /* water steps done in the state it shows; INTERPOLATED: in the current set */
    wadi_bool finished;            /* 1 = the device has written it. 0 = it will have, ahead of anything that you submit after it. A
                                      host that reads elsewhere (the CPU backend's address) must wait for 1 */
} wadi_output_view;
static inline wadi_output_view wadi_default_output_view(void) {
    WADI_ZERO_STRUCT(wadi_output_view);
    return value;
}
/** Views an output on the device.
 *  PREVIOUS and CURRENT stay as they are during the next update at least: a publish writes the third set.
 *  Errors: BAD_ARGUMENT (no such output or set, not asked for), NOT_READY (not published yet; PREVIOUS: only once). */
WADI_API wadi_result wadi_world_get_view(wadi_world_id world, wadi_output output, wadi_output_set set, wadi_output_view* view);

/** Chooses outputs whose publishes are also copied to host memory, for hosts that share no API with the device; 0 = none.
 *  They need not be in the mask of wadi_world_set_outputs.
 *  Waits and errors: those of wadi_world_set_outputs. */
WADI_API wadi_result wadi_world_set_host_outputs(wadi_world_id world, wadi_output_mask mask);
/** Waits until what the newest update published is there for all to see: the next wadi_world_get_host_output, _get_tiles and
 *  _get_dirty_regions give it, and views of the current set are `finished`. For programs that print, film or compute, and for tests; a
 *  game goes on drawing what has arrived. Steps of wadi_world_step are published by an update, which may be of 0 nanoseconds. What those
 *  calls gave before stays valid as it would have.
 *  Waits: the steps.
 *  Errors: BAD_ARGUMENT (no output was asked for), NOT_READY (no update has published yet). */
WADI_API wadi_result wadi_world_wait_for_outputs(wadi_world_id world);
/** The newest copy that has arrived, usually of the update before.
 *  Cell (i, j) begins at byte j * row_pitch + i * bytes of a cell; PACKED_HALF has four 16-bit floats there (const uint16_t*). The
 *  same for all calls until an update or wadi_world_wait_for_outputs; valid until the second next update or until a mask changes.
 *  row_pitch [bytes] and step may be NULL.
 *  Errors: BAD_ARGUMENT (no such output, not asked for), NOT_READY (none has arrived yet). */
WADI_API wadi_result wadi_world_get_host_output(wadi_world_id world, wadi_output output, const float** data, uint64_t* row_pitch,
                                                uint64_t* step);

/** The cells (i, j) with i0 <= i < i0 + nx and j0 <= j < j0 + ny. */
typedef struct wadi_region {
    int32_t i0, j0;
    int32_t nx, ny;
} wadi_region;
/** A tile of 32 x 32 cells (less at the east and north rim): cells i ... i + nx - 1, j ... j + ny - 1. */
typedef struct wadi_tile {
    int32_t i, j, nx, ny;
    float solid_min, solid_max;    /* elevation of the solid surface H + hs [m] */
    float free_min, free_max;      /* elevation of the visible surface H + max(W, hs) [m] */
    int64_t changed_step;          /* step of the newest publish that changed the solid or visible surface of a cell; at first that of
                                      the first publish */
} wadi_tile;
/** The newest tiles that have arrived from the device, in rows from south to north.
 *  Needs WADI_OUTPUT_TILES_BIT. *step (may be NULL): of the publish.
 *  Errors: BAD_ARGUMENT (not asked for), NOT_READY (none has arrived yet). */
WADI_API wadi_result wadi_world_get_tiles(wadi_world_id world, wadi_tile* tiles, uint32_t* count, uint64_t* step);
/** Rectangles that hold every cell whose solid or visible surface changed in a publish after step `since_step` (-1 = ever).
 *  They are tiles, neighbours in a row of tiles as one. Pass *step of one call as since_step to the next, and -1 after wadi_world_load.
 *  Errors: those of wadi_world_get_tiles; BAD_ARGUMENT (since_step below -1). */
WADI_API wadi_result wadi_world_get_dirty_regions(wadi_world_id world, int64_t since_step, wadi_region* regions, uint32_t* count,
                                                  uint64_t* step);

/* ---- Reading ---- */

typedef enum wadi_field WADI_ENUM {
    WADI_FIELD_TERRAIN = 0,          /* H, elevation of the ground [m] */
    WADI_FIELD_SAND_DEPTH = 1,       /* hs [m] */
    WADI_FIELD_TOTAL_WATER_DEPTH = 2, /* W, depth of all water, above the sand and inside it [m] */
    WADI_FIELD_WATER_DEPTH = 3,      /* pure water above the sand, what its pores do not hold [m] */
    WADI_FIELD_FREE_SURFACE = 4,     /* H + max(W, hs), elevation of what a viewer sees [m] */
    WADI_FIELD_SATURATION = 5,       /* W/(W + hs) where there is sand, else 0 */
    WADI_FIELD_WATER_VELOCITY_X = 6, /* pure water, cell centre [m/s] */
    WADI_FIELD_WATER_VELOCITY_Y = 7,
    WADI_FIELD_SAND_VELOCITY_X = 8,  /* [m/s] */
    WADI_FIELD_SAND_VELOCITY_Y = 9,
    WADI_FIELD_MIXED_VELOCITY_X = 10, /* water inside sand [m/s] */
    WADI_FIELD_MIXED_VELOCITY_Y = 11,
    WADI_FIELD_STRETCH_XX = 12,      /* left stretch V - I of the sand */
    WADI_FIELD_STRETCH_XY = 13,
    WADI_FIELD_STRETCH_YY = 14,
    WADI_FIELD_LIMITS = 15,          /* which limits hold the cell in the next step: a sum of wadi_limit bits, 0 = none */
    WADI_FIELD_FOAM = 16,            /* effect foam: 1 covers the cell, at most 4 where currents pile it up */
    WADI_FIELD_WETNESS = 17,         /* effect wetness: 1 under water, less the longer the ground is dry */
    WADI_FIELD_SILT = 18,            /* effect silt: what makes the water muddy, per area of the ground, at most 8 [kg/m2] */
    WADI_FIELD_COUNT = 19
} wadi_field;
/** Bits of WADI_FIELD_LIMITS, of a cell or any of its four faces. wadi_world_stats counts the same, by faces. */
typedef enum wadi_limit WADI_ENUM {
    WADI_LIMIT_WATER_SPEED = 1,   /* water, pure or in sand, at the velocity clamp */
    WADI_LIMIT_WATER_GRAVITY = 2, /* gravity of water capped: waves are slower there */
    WADI_LIMIT_WATER_OUTFLOW = 4, /* more water would leave than there is */
    WADI_LIMIT_SAND_SPEED = 8,
    WADI_LIMIT_SAND_GRAVITY = 16,
    WADI_LIMIT_SAND_OUTFLOW = 32,
    WADI_LIMIT_HEIGHT = 64        /* the column stands above method.largest_height: its heights are rounded, the books drift */
} wadi_limit;
/** Short name used by tools: "H", "hs", "W", "hw", "surface", "phi", "uw", "vw", "us", "vs", "um", "vm", "Vxx", "Vxy", "Vyy", "limits",
 *  "foam", "wet", "silt"; NULL if unknown. */
WADI_API const char* wadi_field_name(wadi_field field);

/** Reads a field, count = nx * ny floats.
 *  A field that the world's effects lack reads as zero.
 *  Waits: the steps.
 *  Errors: BAD_ARGUMENT (field, count). */
WADI_API wadi_result wadi_world_read_field(wadi_world_id world, wadi_field field, float* values, size_t count);
/** Reads a field in a region within the grid, count = its nx * ny floats.
 *  Waits: the steps.
 *  Errors: BAD_ARGUMENT (field, region, count). */
WADI_API wadi_result wadi_world_read_region(wadi_world_id world, wadi_field field, const wadi_region* region, float* values, size_t count);

/** State now: extremes, limits at work, and the ledger. */
typedef struct wadi_world_stats {
    uint32_t struct_size;
    double time;                  /* [s] */
    uint64_t steps;
    double sand_volume;           /* [m3] now */
    double water_volume;
    double sand_initial;          /* [m3] at creation */
    double water_initial;
    double sand_in, sand_out;     /* [m3] by sources, sinks, rain, evaporation and sides since creation */
    double water_in, water_out;
    double refused;               /* [m3] of sources and rain that found no room below method.largest_height, the highest elevation */
    int64_t sand_drift_quanta;    /* now - (initial + in - out) in quanta of depth x cell area; 0 = exact; sums stop at 2^60 */
    int64_t water_drift_quanta;
    double quantum;               /* [m] */
    double largest_sand_depth;    /* hs [m] */
    double largest_total_water_depth; /* W [m] */
    double largest_water_speed;   /* largest face velocity of pure and mixed water [m/s] */
    double largest_sand_speed;    /* [m/s] */
    double smallest_depth;        /* least hs or W [m]: never negative */
    uint64_t not_finite;          /* values that are NaN or infinite: never any */
    uint64_t clamped_faces;       /* faces at the velocity clamp */
    uint64_t capped_faces;        /* faces whose gravity the next step caps */
    uint64_t limited_cells;       /* cells whose outflow the next step limits */
    uint64_t tiles, active_tiles; /* of the world, and of those the ones that the newest step ran over; 0 without active tiles. Where water
                                     and sand have a list each, those in the longer one */
    uint64_t hash;                /* 64-bit state hash, ghosts excluded */
    uint64_t high_columns;        /* columns of terrain, sand and water above method.largest_height, which flow and pushes can pile up:
                                     there heights are rounded like any float, and the books drift */
    uint64_t wet_faces;           /* faces beside water deeper than method.dry_threshold, inside it too: what the next three are of */
    uint64_t clamped_water_faces; /* those of the counts above that hold water; the rest hold sand */
    uint64_t capped_water_faces;
    uint64_t limited_water_cells;
    uint64_t sand_faces;          /* faces beside sand deeper than method.dry_threshold */
    double unlimited_dt;          /* the time step with which, as far as this state tells, neither clamp nor cap would hold water; dt where
                                     none does [s] */
} wadi_world_stats;
static inline wadi_world_stats wadi_default_world_stats(void) {
    WADI_ZERO_STRUCT(wadi_world_stats);
    return value;
}
/** Takes the statistics: reads the whole state, so not for every frame.
 *  Waits: the steps. */
WADI_API wadi_result wadi_world_get_stats(wadi_world_id world, wadi_world_stats* stats);
/** 64-bit hash of the state, ghosts and terrain excluded: wadi_world_stats.hash without the rest.
 *  Equal states have equal hashes on every backend that passes the exact-float test. Reads the whole state.
 *  Waits: the steps. */
WADI_API wadi_result wadi_world_get_hash(wadi_world_id world, uint64_t* hash);

/* ---- Points and bodies ---- */

/** The state at one point. */
typedef struct wadi_query_result {
    float terrain;                /* elevation of the ground [m]; elevations and depths are bilinear between cell centres */
    float sand_depth;             /* [m] */
    float water_depth;            /* pure water above the sand [m]; 0 where all four cells around are dry */
    float surface;                /* elevation of the visible surface, H + max(W, hs) [m]. At the water's edge it leads from the
                                     water's surface in the last wet cell to the ground of the dry one, as a mesh through the cell
                                     centres does */
    float velocity[2];            /* of the pure water, between faces [m/s]; 0 on dry faces */
    float normal[3];              /* of the visible surface, unit length, up; slopes bilinear between cell centres */
    float saturation;             /* W/(W + hs) of the sand, 0 without sand */
    wadi_bool inside;             /* 0: the point is outside the grid, all else is 0 */
} wadi_query_result;

/** Asks for the state at `count` (1 ... 65536) points of the world: x, y of each in metres from the south-west corner of the grid.
 *  Answered for the state after the steps asked for so far or, in the middle of a step that runs in parts, after that step. Eight batches
 *  may be under way. The first eight calls allocate.
 *  Waits: nothing, but room for the first eight calls with more points than before (in powers of two, 1024 at least).
 *  Errors: NOT_READY (eight are under way), BAD_ARGUMENT (count, a coordinate that is NaN or infinite), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_query(wadi_world_id world, const float* xy, uint32_t count, uint64_t* ticket);
/** The answers in the order of the points, their number and the step they are of.
 *  They may be fetched again until eight later batches were asked for. results may be NULL to ask count and step only; count and step
 *  may be NULL.
 *  Errors: NOT_READY (not there yet), BAD_ARGUMENT (unknown or too old a ticket, capacity below the number). */
WADI_API wadi_result wadi_world_get_query(wadi_world_id world, uint64_t ticket, wadi_query_result* results, uint32_t capacity,
                                          uint32_t* count, uint64_t* step);

typedef enum wadi_body_shape WADI_ENUM {
    WADI_BODY_BOX = 0,
    WADI_BODY_SPHERE = 1
} wadi_body_shape;
/** A body in the water. World axes: x east, y north, z up. */
typedef struct wadi_body {
    uint32_t struct_size;
    wadi_body_shape shape;
    float position[3];            /* of its middle [m] */
    float orientation[4];         /* unit quaternion x, y, z, w from the body's axes to the world's; spheres ignore it */
    float half_size[3];           /* box: half edges along its own axes [m], above 0 */
    float radius;                 /* sphere [m], above 0 */
    float velocity[3];            /* [m/s] */
    float angular_velocity[3];    /* about the world's axes [rad/s] */
    float water_density;          /* [kg/m3], 0 or more; default 1000 */
    float gravity;                /* [m/s2], 0 or more; default 9.81 */
    float linear_drag;            /* of the whole body [kg/s], 0 or more; default 0 */
    float quadratic_drag;         /* drag coefficient, dimensionless, 0 or more; default 1 */
    int32_t samples;              /* columns per side, 1 ... 16; default 4 */
} wadi_body;
static inline wadi_body wadi_default_body(void) {
    WADI_ZERO_STRUCT(wadi_body);
    value.orientation[3] = 1;
    value.half_size[0] = 0.5f;
    value.half_size[1] = 0.5f;
    value.half_size[2] = 0.5f;
    value.radius = 0.5f;
    value.water_density = 1000;
    value.gravity = 9.81f;
    value.quadratic_drag = 1;
    value.samples = 4;
    return value;
}

/** The points to pass to wadi_world_query for a body: samples * samples for a box, those within the circle for a sphere.
 *  Needs no world. *count: points that fit xy in, points out; xy may be NULL to ask the number.
 *  Errors: BAD_ARGUMENT (a field of the body, too little room). */
WADI_API wadi_result wadi_buoyancy_points(const wadi_body* body, float* xy, uint32_t* count);
/** Force [N] and torque about the body's middle [N m] of the water, from the answers for those points.
 *  The body may have moved meanwhile. It is cut into columns, upright or along its steepest axis. Where V of a column lies between bed
 *  and surface:
 *  buoyancy  water_density * gravity * V, upwards, at the middle of that part;
 *  drag      V / volume * (linear_drag * du + water_density * quadratic_drag * area * |du| * du / 2) there, with du the water's
 *            velocity (vertical: 0) less the body's, area = pi radius^2 or volume^(2/3) of a box.
 *  The weight of the body is not in it; points outside the grid give nothing. Needs no world.
 *  Errors: BAD_ARGUMENT (a field of the body, count not that of wadi_buoyancy_points). */
WADI_API wadi_result wadi_buoyancy_force(const wadi_body* body, const wadi_query_result* results, uint32_t count, float force[3],
                                         float torque[3]);

/* ---- Edits ---- */

typedef enum wadi_layer WADI_ENUM {
    WADI_LAYER_TERRAIN = 0,
    WADI_LAYER_SAND = 1,
    WADI_LAYER_WATER = 2
} wadi_layer;
typedef enum wadi_edit_kind WADI_ENUM {
    WADI_EDIT_BRUSH = 0, /* adds to (amount > 0) or takes from a layer within a disc or capsule */
    WADI_EDIT_STAMP = 1, /* the same by an image over a rectangle */
    WADI_EDIT_PUSH = 2   /* a body that drags sand and water along and feels nothing itself; moves no mass */
} wadi_edit_kind;

/** One edit. A cell at a hard rim counts by the share that lies inside. The shape may lie outside the grid in part or as a whole.
 *  Positions are kept to 1/256 of a cell. */
typedef struct wadi_edit {
    uint32_t struct_size;
    wadi_edit_kind kind;
    wadi_layer layer;     /* of brush and stamp */
    wadi_bool capsule;    /* brush and push: 0 = disc round (x0, y0), 1 = all within radius of the line from (x0, y0) to (x1, y1) */
    uint64_t step;        /* the water step ahead of which it acts, as wadi_world_get_time counts; 0 = the next one */
    double x0, y0;        /* [m], -1e9 ... 1e9; of a stamp the low corner */
    double x1, y1;        /* [m], capsule and stamp only; of a stamp the high corner, greater than the low one */
    double radius;        /* [m], 1e-9 ... 1e9, brush and push */
    double softness;      /* 0 ... 1, brush and push: share of the radius over which the effect falls to 0 (3 s^2 - 2 s^3) */
    double amount;        /* brush: change at the centre [m], of the terrain's elevation or of a layer's depth, water's being W;
                           * stamp: the same per unit of the image. At most twice method.largest_height up or down */
    double strength;      /* 0 ... 1, push: how far velocities are drawn to the body's at the centre */
    double velocity_x;    /* [m/s], -1e4 ... 1e4, push: the body's velocity */
    double velocity_y;
    uint32_t stamp;       /* stamp: its number, from wadi_world_create_stamp */
    uint64_t player;      /* 0 ... 4294967295: those of one step act by rising player, whoever was queued first; default 0 */
} wadi_edit;
static inline wadi_edit wadi_default_edit(void) {
    WADI_ZERO_STRUCT(wadi_edit);
    value.radius = 1;
    value.softness = 0.5;
    value.strength = 1;
    return value;
}

/** Queues `count` edits.
 *  Ahead of a step its edits act by rising `player`, and those of one player in the order of the calls. In lockstep give each player a
 *  number, and it does not matter whose edits reach a machine first. In the middle of a step that runs in parts "the next one" is the one
 *  after it.
 *  Depths change by whole quanta and every quantum is in the ledger. What finds no room below method.largest_height is refused and
 *  counted (wadi_world_stats.refused). No more is taken than there is. Sand and water keep their depth where terrain changes. Added sand
 *  is unstrained, or in balance with method.prestress.
 *  An edit that adds a material the world has not held so far promotes it when its step comes. Buffers are then allocated and programs
 *  recorded anew, once, and that step may wait for the device.
 *  Edits of the level itself act ahead of these and are no part of the command log. Going back in time, by wadi_world_load or in another
 *  way, drops the edits that wait: queue those of later steps again.
 *  Errors: BAD_ARGUMENT, naming edit, field and range, or `effects` when the level forces off what an edit adds; none is queued. */
WADI_API wadi_result wadi_world_edit(wadi_world_id world, const wadi_edit* edits, uint32_t count);

/** Copies an image for stamps: nx * ny values (1 ... 4096 each, |value| <= 1e12), row 0 in the south, bilinear between pixels.
 *  *stamp counts up from 1; stamps live as long as the world.
 *  Waits: room.
 *  Errors: BAD_ARGUMENT, OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_create_stamp(wadi_world_id world, int32_t nx, int32_t ny, const float* values, uint32_t* stamp);

/** Overwrites TERRAIN, SAND_DEPTH or TOTAL_WATER_DEPTH [m] in a region at once, after the steps asked for.
 *  Values are rounded to quanta; what that adds or takes is in the ledger; velocities stay. Promotes like an edit.
 *  Waits: the steps.
 *  Errors: BAD_ARGUMENT (another field, a region outside, NaN, a negative depth, a column above method.largest_height: the message
 *  names the cell; `effects` forced off), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_write_region(wadi_world_id world, wadi_field field, const wadi_region* region, const float* values,
                                             size_t count);

/** Rows of floats in memory of the device or the host, the south first. */
typedef struct wadi_device_values {
    uint32_t struct_size;
    wadi_handle_kind handle_kind; /* HOST_POINTER: any world, read before the call returns. Else memory of the API that the world runs
                                     in: CUDA_POINTER of its device, or VULKAN_BUFFER of its vulkan_host, made with
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT, CONCURRENT or owned by queue_family */
    uint64_t handle;              /* address, or VkBuffer */
    uint64_t offset;              /* of the region's south-west value [bytes], a multiple of 4 */
    uint64_t row_pitch;           /* [bytes], a multiple of 4, at least 4 * nx of the region; 0 = 4 * nx */
} wadi_device_values;
static inline wadi_device_values wadi_default_device_values(void) {
    WADI_ZERO_STRUCT(wadi_device_values);
    return value;
}
/** wadi_world_write_region of values that the host need not see: copied and checked on the device, after the steps asked for. A value
 *  that wadi_world_write_region takes gives the same bits, and with method.quantum above 0 the same counts. Which it refuses the host
 *  cannot be told in time:
 *  too high or too low   is cut to what the cell has room for; what was cut (beyond twice method.largest_height: that) is counted in
 *                        wadi_world_stats.refused;
 *  NaN or infinite       the cell stays as it is, and method.largest_height is counted there.
 *  SAND_DEPTH and TOTAL_WATER_DEPTH promote the world whatever the values are. Device memory is read behind all that the host put on
 *  the world's queue and points of wadi_vulkan_wait, with CUDA behind events of wadi_cuda_wait. It must stay as it is until that is done
 *  (behind wadi_vulkan_signal, wadi_cuda_signal, or on the queue).
 *  Waits: room for a larger region than before, and for compilers of drivers at first; of HOST_POINTER the fifth write for the first;
 *  while the device's queue is full.
 *  Errors: BAD_ARGUMENT (another field, a region outside, a field of `values`: the message says what is allowed; `effects` forced off),
 *  NOT_SUPPORTED (while the command log is on; device memory where the world knows none of the host's), NOT_READY (recorded work would
 *  be overtaken), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_write_region_from(wadi_world_id world, wadi_field field, const wadi_region* region,
                                                  const wadi_device_values* values);

/** Compiles the pipelines of every effect that the level allows, so that a later promotion only allocates and records.
 *  Costs time once (GPU drivers: up to seconds) and next to no memory; call it while loading.
 *  Waits: for compilers of drivers. */
WADI_API wadi_result wadi_world_prepare_effects(wadi_world_id world);
/** Frees the passes and buffers of materials that the world no longer holds; what it gave and took stays in the ledger.
 *  Waits: the steps, and reads the depths. */
WADI_API wadi_result wadi_world_trim(wadi_world_id world);

/* ---- Sources ---- */

/** A value at a time. In a series it is linear between samples and constant outside; one sample is constant. */
typedef struct wadi_sample {
    double time;                  /* simulated, as wadi_world_get_time counts [s] */
    double value;
} wadi_sample;
typedef enum wadi_source_shape WADI_ENUM {
    WADI_SOURCE_DISC = 0,
    WADI_SOURCE_BOX = 1,
    WADI_SOURCE_POINT = 2         /* the cell that holds `center` */
} wadi_source_shape;
/** A source or drain of a world: a tap, a spring, a pump, a conveyor. Numbers as "sources" of level files have them. */
typedef struct wadi_source {
    uint32_t struct_size;
    wadi_source_shape shape;
    wadi_bool sand;               /* 1 = of sand, 0 = of water */
    wadi_bool drain;              /* 1 = with `level`: takes away what stands above, too */
    double center[2];             /* x, y of point and disc [m] */
    double radius;                /* disc [m], above 0 */
    double from[2], to[2];        /* x, y of a box's south-west and north-east corner [m], `to` the greater */
    wadi_bool set_velocity;       /* 1 = `velocity` holds */
    uint32_t rate_count;          /* samples, 0 ... 4096; 0 = there is no such series. A source has a rate, a discharge or a level; with
                                     a level the other is the most that it moves */
    uint32_t discharge_count;
    uint32_t level_count;
    double velocity[2];           /* forced on the water inside while something is added [m/s], -1e4 ... 1e4 */
    const wadi_sample* rate;      /* depth per time [m/s], -1e4 ... 1e4; below 0 it takes away; 0 = off */
    const wadi_sample* discharge; /* volume per time [m3/s], -1e9 ... 1e9, shared by the cells inside */
    const wadi_sample* level;     /* of water: elevation of the surface that it holds in each cell [m] */
    uint64_t step;                /* wadi_world_set_source: the water step ahead of which it changes; 0 = the next one */
    uint64_t player;              /* as wadi_edit.player */
} wadi_source;
static inline wadi_source wadi_default_source(void) {
    WADI_ZERO_STRUCT(wadi_source);
    value.radius = 1;
    return value;
}
/** Source `index` as it is now, 0 ... wadi_world_info.source_count - 1: those of the level come first, in its order. The series stay where
 *  they are until the next call of it on this world or wadi_destroy_world. step and player are 0.
 *  Errors: BAD_ARGUMENT (no such source: the message says how many there are). */
WADI_API wadi_result wadi_world_get_source(wadi_world_id world, uint32_t index, wadi_source* source);
/** Makes source `index`, 0 ... 31, another one: moves it, opens or closes it, or adds one. It waits for its step like an edit, with edits'
 *  rule of players, and acts ahead of them. To close a tap give it one sample of 0; sources are never taken out. Those below `index` that
 *  the world lacks come along, closed. Series are copied. What the ledger has of the source stays. The command log has the change.
 *  Snapshots and kept steps hold the sources of their moment. Like edits, changes that wait are in no snapshot and no kept step, and
 *  every way back in time drops them.
 *  Other values of the series cost a look at them. Another place, shape or number of sources records the step anew once its own comes:
 *  some milliseconds, so move taps seldom, or pour with a brush that follows. The first source of a material promotes the world, as an
 *  edit does.
 *  Waits: nothing; ahead of a step at which a source comes to another place wadi_world_step and _update wait for the steps before.
 *  Errors: BAD_ARGUMENT, naming the field and its range (a shape outside the grid, a rate beside a discharge, times that do not rise, a
 *  step that is done, `effects` that the level forces off), NOT_SUPPORTED (the command log is on and full for that step); nothing is
 *  changed. What only shows at its step, OUT_OF_MEMORY or NOT_READY (inside a recording), is an error of wadi_world_step or _update. */
WADI_API wadi_result wadi_world_set_source(wadi_world_id world, uint32_t index, const wadi_source* source);

/* ---- Material ---- */

/** One number of the material. */
typedef struct wadi_material_info {
    char name[32];                /* as level files write it: "friction", "cohesion_wet", "saturation[0]" */
    double value;                 /* now; units as in level files */
    double least, most;           /* what wadi_world_set_material takes */
} wadi_material_info;
/** Lists the numbers of the material and their present values. */
WADI_API wadi_result wadi_world_get_material(wadi_world_id world, wadi_material_info* infos, uint32_t* count);
/** Changes one of them from the next whole step on, in the level's units.
 *  Effects follow as for a level with that value. 0 in young_modulus, exchange_rate, diffusion_rate, bed_friction and manning, or
 *  bed_shear drops its effect, and with elastoplastic the strain of the sand. A value above 0 brings the effect, which allocates. Where
 *  effects stay, no pipeline is made: the step is recorded anew, once per change.
 *  Ahead of the first step the world becomes that of a level with the value, in every bit. Later, sand keeps the strain that it has (with
 *  method.prestress, that in balance with the material it was drawn with).
 *  The command log has the change. Snapshots and kept steps hold the values of their moment and bring them back. The level's warnings
 *  are not checked again.
 *  Waits: nothing, but the steps if it is called ahead of the first step, or if young_modulus was 0.
 *  Errors: NOT_FOUND (name), BAD_ARGUMENT (out of range, NaN, saturations out of order, or a number of an effect that the level forces
 *  off: the message says which), OUT_OF_MEMORY, NOT_READY (inside a recording). */
WADI_API wadi_result wadi_world_set_material(wadi_world_id world, const char* name, double value);

/* ---- Saving and going back ---- */

/** Saves the state to memory, to the bit: fields, ledgers and running totals, not the level itself nor edits and sources that wait.
 *  *size: bytes at `data` in, bytes of the snapshot out; data may be NULL to ask the number.
 *  Waits: the steps; nothing to ask the number.
 *  Errors: BAD_ARGUMENT (size too small). */
WADI_API wadi_result wadi_world_save(wadi_world_id world, void* data, size_t* size);
/** Goes to a saved state: the world continues as the saved one would have, in every bit, on any backend that passes the exact-float
 *  test.
 *  The snapshot must be of a world of the same level settings (grid, dt, material, method, sides, sources, rain). Its material and
 *  sources are taken as they were changed by then. Initial fields may differ. Effects that only this world has start from zero, and the
 *  world is promoted to those that only the snapshot has. Edits and sources that wait and steps kept for roll-back are forgotten.
 *  Waits: the steps.
 *  Errors, the world as it was, also where the host's own memory ends: BAD_FILE (no snapshot, a newer version, truncated, changed),
 *  BAD_ARGUMENT (of another level, or with effects that this world's level forces off), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_load(wadi_world_id world, const void* data, size_t size);
/** What wadi_world_load of these bytes would cost; the world stays as it is.
 *  Errors: those of wadi_world_load that the snapshot's header shows. */
WADI_API wadi_result wadi_world_get_snapshot_cost(wadi_world_id world, const void* data, size_t size, wadi_cost* cost);
/** wadi_world_save to a file.
 *  Written beside it under a name that ends in ".part" and that no other call has, brought to the disk and renamed when it is whole. So
 *  several savers to one path each leave a whole file. A process that is killed meanwhile leaves its part.
 *  Waits: the steps, the disk.
 *  Errors, an earlier file unchanged: NOT_FOUND (the folder cannot be written to), BAD_FILE (writing failed, or path is a folder, pipe or
 *  device). */
WADI_API wadi_result wadi_world_save_file(wadi_world_id world, const char* path);
/** wadi_world_load from a regular file; one larger than any snapshot of this world is refused unread.
 *  Waits: the steps, the disk.
 *  Errors: NOT_FOUND, and those of wadi_world_load. */
WADI_API wadi_result wadi_world_load_file(wadi_world_id world, const char* path);

/** Asks for a snapshot of the state after the steps asked for so far, or, in the middle of a step that runs in parts, after that step.
 *  The device copies the state aside; the first call allocates room for it. A snapshot asked for earlier that nobody has begun to fetch is
 *  forgotten.
 *  Errors: NOT_READY (the device or a worker is still at an earlier one), OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_begin_save(wadi_world_id world, uint64_t* ticket);
/** Fetches it: NOT_READY until the snapshot lies in `data`, then OK, once.
 *  A worker thread fills `data`. From the first call on that memory must stay where it is, and you must pass the same pointer, until a
 *  call returns OK or the world is destroyed. An error does not end that. *size as in wadi_world_save; data may be NULL to ask the number.
 *  Where the system refuses that thread a call fills `data` itself.
 *  Errors: BAD_ARGUMENT (another ticket, another data, size too small), DEVICE_LOST (before the copy aside was done). */
WADI_API wadi_result wadi_world_end_save(wadi_world_id world, uint64_t ticket, void* data, size_t* size);

/** Keeps earlier states on the device: the newest `frames` (0 ... 256; 0 = off, frees them) of the state now and of every later step
 *  that is a multiple of interval_steps (1 or more).
 *  Each takes the bytes of a snapshot, allocated here. States kept before are forgotten.
 *  Waits: nothing, but may when it frees.
 *  Errors: BAD_ARGUMENT, OUT_OF_MEMORY (nothing is kept then). */
WADI_API wadi_result wadi_world_set_rollback(wadi_world_id world, uint32_t frames, uint32_t interval_steps);
/** Lists the steps that can be gone back to, oldest first. */
WADI_API wadi_result wadi_world_get_rollback_steps(wadi_world_id world, uint64_t* steps, uint32_t* count);
/** Goes back to the newest kept step <= `step`, written to *reached (may be NULL).
 *  Later kept steps, edits and sources that wait are forgotten. The world goes on from there as it did the first time, in every bit,
 *  given the same input. Steps with an effect that the world has lost since are forgotten.
 *  Waits: nothing, but the steps where material or sources were others then.
 *  Errors: BAD_ARGUMENT (no step that old is kept). */
WADI_API wadi_result wadi_world_roll_back(wadi_world_id world, uint64_t step, uint64_t* reached);

/* ---- Command log ---- */

/** 1 = from now on remember every edit, source, written region, trim and change of the material with its step, in host memory that grows;
 *  0 = stop and drop the log.
 *  Off at first. Going back in time drops what was remembered for later steps. While it is on wadi_world_write_region_from is refused. */
WADI_API wadi_result wadi_world_set_command_log(wadi_world_id world, wadi_bool on);
/** The log as bytes, with all stamps of the world: a few dozen bytes per edit, versioned and checksummed.
 *  *size: bytes at `data` in, bytes of the log out; data may be NULL to ask the number.
 *  Errors: BAD_ARGUMENT (size too small). */
WADI_API wadi_result wadi_world_get_commands(wadi_world_id world, void* data, size_t* size);
/** Every player, for wadi_world_get_commands_since. */
#define WADI_EVERY_PLAYER 0xFFFFFFFFFFFFFFFFu
/** wadi_world_get_commands, of the commands that count ahead of `step` or a later one and are of one player alone, with the stamps that
 *  they use. A lockstep game sends this each turn, where every player queues for the steps of the turn after next. Commands other than
 *  edits and sources are of player 0. Played commands are in the log, too: ask for your own player, and none goes round twice.
 *  Errors: BAD_ARGUMENT (size too small; player above 4294967295 but WADI_EVERY_PLAYER). */
WADI_API wadi_result wadi_world_get_commands_since(wadi_world_id world, uint64_t step, uint64_t player, void* data, size_t* size);
/** Queues the commands of a log in a world of the same level: a fresh one, or one that stands where logging began.
 *  Stamps that the world has are not made again. After the same number of steps, in frames of any rhythm, both have the same hash, on
 *  every backend that passes the exact-float test.
 *  Waits: room for stamps; the steps where a written region or trim counts at once, as do later steps ahead of which one counts.
 *  Errors, nothing queued: BAD_FILE (no log, a newer version, truncated, changed), BAD_ARGUMENT (of another level, or with commands for
 *  steps already done). */
WADI_API wadi_result wadi_world_play_commands(wadi_world_id world, const void* data, size_t size);
/** What wadi_world_play_commands of these bytes would cost; nothing is queued.
 *  Errors: those of wadi_world_play_commands. */
WADI_API wadi_result wadi_world_get_commands_cost(wadi_world_id world, const void* data, size_t size, wadi_cost* cost);

/* ---- Looking inside ---- */

/** The plan as text: effects on and why, passes, buffers, bytes per cell.
 *  Returns the length without the final zero; writes at most `size` bytes including it. 0 and an error for a bad world. */
WADI_API size_t wadi_world_describe_plan(wadi_world_id world, char* text, size_t size);

/** A table of the library as text, of any world and none: "settings" (keys of level files with unit, range, default), "effects",
 *  "fields", "stages", or "schema" (the settings as JSON).
 *  Returns the length without the final zero; writes at most `size` bytes including it. 0 and an error for another name. */
WADI_API size_t wadi_describe_table(const char* table, char* text, size_t size);

typedef struct wadi_effect_info {
    char name[32];                /* as level files write it */
    wadi_bool on;                 /* 1 = its passes run and its fields exist */
    char why[160];                /* one sentence: why it is on or off */
} wadi_effect_info;
/** Lists the effects and why each is on or off. */
WADI_API wadi_result wadi_world_get_effects(wadi_world_id world, wadi_effect_info* effects, uint32_t* count);

typedef struct wadi_memory_item {
    char label[64];               /* the field, or what the buffer is for */
    uint64_t bytes;
} wadi_memory_item;
/** Lists every buffer that the world holds on its device, those for the host to read included; they add up to
 *  wadi_world_info.device_bytes. */
WADI_API wadi_result wadi_world_get_memory(wadi_world_id world, wadi_memory_item* items, uint32_t* count);

/** 1 = every step records timestamps, by programs recorded for it; off at first.
 *  Waits: the steps that are timed. */
WADI_API wadi_result wadi_world_set_profiling(wadi_world_id world, wadi_bool on);
typedef struct wadi_stage_timing {
    char name[64];
    double milliseconds;          /* mean per water step, all its sand substeps together */
    uint32_t passes;              /* dispatches per water step */
} wadi_stage_timing;
/** Lists the mean times since profiling was switched on.
 *  Waits: the steps that are timed. */
WADI_API wadi_result wadi_world_get_stage_timings(wadi_world_id world, wadi_stage_timing* timings, uint32_t* count);

/** 1 = after every step the whole state is read and verified; off at first. Every number is finite, no depth is negative, no speed is
 *  above its clamp, and every quantum is in the books. The last three are not checked with method "published", and the books not of
 *  columns near method.largest_height. The call that takes a step which breaks one returns WADI_ERROR_INTERNAL, and wadi_get_last_error()
 *  names step, field and cell. Use it to look for a fault: each step is waited for, and takes many times as long. */
WADI_API wadi_result wadi_world_set_checking(wadi_world_id world, wadi_bool on);

/** OK, or what broke the world for good (DEVICE_LOST) with wadi_get_last_error() saying how.
 *  A fault that the device has not reported yet is not known. */
WADI_API wadi_result wadi_world_get_error(wadi_world_id world);

#ifdef __cplusplus
}
#endif
#endif
