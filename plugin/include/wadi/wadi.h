/* Wadi: sand, water and wet sand on a height field. The plugin's whole interface, C99.
 *
 * Units: metres, seconds, kilograms. Fields are row-major, nx * ny floats, x fastest; row 0 is the south side (y = 0),
 * column 0 the west side (x = 0); heights point up.
 * A struct that the caller fills begins with struct_size: call its wadi_default_*() function, then change what you need.
 * Every function that can fail returns a wadi_result; wadi_get_last_error() then has one line of text for this thread.
 * No function aborts, throws or prints. A world is used by one thread at a time: a call that meets another one inside the same
 * world does nothing and returns WADI_ERROR_BUSY. Different worlds are independent.
 */
#ifndef WADI_H
#define WADI_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(WADI_BUILD)
#define WADI_API __declspec(dllexport)
#else
#define WADI_API __declspec(dllimport)
#endif
#else
#define WADI_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define WADI_ABI_VERSION 1u

/** The ABI version of the library that is loaded; compare it with WADI_ABI_VERSION. */
WADI_API uint32_t wadi_get_abi_version(void);

typedef enum wadi_result {
    WADI_OK = 0,
    WADI_ERROR_BAD_ARGUMENT = 1,  /* a value is wrong; the message names it and its range */
    WADI_ERROR_NOT_FOUND = 2,     /* no such file, level, backend, device or effect */
    WADI_ERROR_BAD_FILE = 3,      /* a file is malformed; the message names the field */
    WADI_ERROR_NOT_SUPPORTED = 4, /* this build or device cannot do it */
    WADI_ERROR_OUT_OF_MEMORY = 5,
    WADI_ERROR_DEVICE_LOST = 6,   /* sticky for the world; destroy it and create another */
    WADI_ERROR_INTERNAL = 7,      /* our bug: please report the message */
    WADI_NOT_READY = 8,           /* not an error: ask again later */
    WADI_ERROR_BUSY = 9           /* another thread is inside a call on this world; nothing was done */
} wadi_result;

/** One line about the last error on this thread; never NULL, valid until the next call on this thread. */
WADI_API const char* wadi_get_last_error(void);

/** A world by index and generation; all zero is null. Copy it freely; a destroyed one is recognised and refused. */
typedef struct wadi_world_id {
    uint32_t index;
    uint32_t generation;
} wadi_world_id;

typedef void (*wadi_log_callback)(void* user, int level, const char* message); /* level: 0 error, 1 warning, 2 information */

/** Where and how a world runs. */
typedef struct wadi_device_options {
    uint32_t struct_size;
    const char* backend;       /* "auto" (a real GPU first, else the CPU), "cpu", "vulkan", "cuda" */
    int32_t device;            /* index from wadi_list_devices, -1 = the backend's best */
    int32_t threads;           /* CPU backend: threads, 0 = all cores */
    int32_t validate;          /* 1 = Vulkan validation layers; messages go to the log callback */
    wadi_log_callback log;     /* may be NULL */
    void* log_user;
    const struct wadi_vulkan_host* vulkan_host; /* NULL, or the host's own Vulkan device (wadi_vulkan.h): backend "auto" or "vulkan" */
} wadi_device_options;
WADI_API wadi_device_options wadi_default_device_options(void);

typedef struct wadi_device_info {
    uint32_t struct_size;
    char backend[16];
    int32_t index;             /* within its backend */
    char name[256];
    int32_t is_software;       /* 1 for the CPU and for software Vulkan devices */
    uint64_t memory_bytes;     /* 0 = unknown */
} wadi_device_info;
/** Lists the devices of all backends of this build. *count: capacity in, number of devices out; infos may be NULL to ask the
 *  number. `notes` (may be NULL) receives one line per backend without a device, saying why. */
WADI_API wadi_result wadi_list_devices(wadi_device_info* infos, uint32_t* count, char* notes, size_t notes_size);

/** Overrides for a level file; a value of 0 or NULL keeps the file's. */
typedef struct wadi_level_overrides {
    uint32_t struct_size;
    int32_t nx, ny;            /* keeps the x extent and square cells, stretches maps in y, scales dt with dx */
    double dt;                 /* [s] */
    const char* method;        /* "robust" */
} wadi_level_overrides;
WADI_API wadi_level_overrides wadi_default_level_overrides(void);

/** Creates a world from a level file (.json) or from a terrain map (.png, .r16, .npy).
 *  Errors: NOT_FOUND, BAD_FILE, BAD_ARGUMENT, OUT_OF_MEMORY, NOT_SUPPORTED. */
WADI_API wadi_result wadi_create_world_from_level(const char* path, const wadi_level_overrides* overrides,
                                                  const wadi_device_options* options, wadi_world_id* world);

/** A world from arrays: settings as the text of a level file without its "terrain", "sand", "water" and "velocity"
 *  entries, and fields of nx * ny floats. NULL = zero everywhere. */
typedef struct wadi_world_arrays {
    uint32_t struct_size;
    const char* settings_json; /* must not be NULL */
    int32_t nx, ny;            /* of the arrays; must equal the settings' grid */
    const float* terrain;      /* [m] */
    const float* sand;         /* depth [m] */
    const float* water;        /* depth [m] */
    const float* velocity_x;   /* water, at cell centres [m/s] */
    const float* velocity_y;
} wadi_world_arrays;
WADI_API wadi_world_arrays wadi_default_world_arrays(void);
WADI_API wadi_result wadi_create_world_from_arrays(const wadi_world_arrays* arrays, const wadi_device_options* options,
                                                   wadi_world_id* world);

/** Frees a world. A null or destroyed id gives BAD_ARGUMENT and changes nothing. */
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
    int32_t exact_float;          /* 1 = the device passed the exact-float self-test */
    uint32_t warning_count;
} wadi_world_info;
WADI_API wadi_world_info wadi_default_world_info(void);
WADI_API wadi_result wadi_world_get_info(wadi_world_id world, wadi_world_info* info);
/** Text of warning n of the level, or NULL. */
WADI_API const char* wadi_world_get_warning(wadi_world_id world, uint32_t n);

/** The plan as text: effects on and why, passes, buffers, bytes per cell. Returns the length without the final zero; writes at
 *  most `size` bytes including it. 0 and an error for a bad world. */
WADI_API size_t wadi_world_describe_plan(wadi_world_id world, char* text, size_t size);

/** Advances by `steps` water steps of fixed dt. Returns before the device has finished; reads wait for it. */
WADI_API wadi_result wadi_world_step(wadi_world_id world, uint32_t steps);

/** Simulated time [s] and water steps so far. Either pointer may be NULL. */
WADI_API wadi_result wadi_world_get_time(wadi_world_id world, double* seconds, uint64_t* steps);

typedef enum wadi_field {
    WADI_FIELD_TERRAIN = 0,          /* H, ground height [m] */
    WADI_FIELD_SAND_HEIGHT = 1,      /* hs, depth of sand [m] */
    WADI_FIELD_WATER_HEIGHT = 2,     /* W, depth of all water, pure and mixed [m] */
    WADI_FIELD_WATER_DEPTH = 3,      /* pure water above the sand, W - min(W, hs) [m] */
    WADI_FIELD_FREE_SURFACE = 4,     /* H + max(W, hs): what a viewer sees [m] */
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
    WADI_FIELD_COUNT = 15
} wadi_field;
/** Short name used by tools: "H", "hs", "W", "hw", "surface", "phi", "uw", "vw", "us", "vs", "um", "vm", "Vxx", "Vxy", "Vyy"; NULL if unknown. */
WADI_API const char* wadi_field_name(wadi_field field);

/** Reads a field as nx * ny floats; waits for the steps already asked for. A field that the world's effects lack reads as zero. */
WADI_API wadi_result wadi_world_read_field(wadi_world_id world, wadi_field field, float* values, size_t count);

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
    double refused;               /* [m3] of sources and rain that found no room below the declared largest height */
    int64_t sand_drift_quanta;    /* now - (initial + in - out) in quanta of height x cell area; 0 = exact */
    int64_t water_drift_quanta;
    double quantum;               /* [m] */
    double largest_sand;          /* [m] */
    double largest_water;         /* [m] */
    double largest_water_speed;   /* largest face velocity of pure and mixed water [m/s] */
    double largest_sand_speed;    /* [m/s] */
    double smallest_height;       /* least hs or W: never negative */
    uint64_t not_finite;          /* values that are NaN or infinite: never any */
    uint64_t clamped_faces;       /* faces at the velocity clamp */
    uint64_t capped_faces;        /* faces whose gravity the next step caps */
    uint64_t limited_cells;       /* cells whose outflow the next step limits */
    uint64_t hash;                /* 64-bit state hash, ghosts excluded */
} wadi_world_stats;
WADI_API wadi_world_stats wadi_default_world_stats(void);
WADI_API wadi_result wadi_world_get_stats(wadi_world_id world, wadi_world_stats* stats);

/** 1 = every step records timestamps (a separately recorded program; off by default). */
WADI_API wadi_result wadi_world_set_profiling(wadi_world_id world, int32_t on);
typedef struct wadi_stage_timing {
    char name[64];
    double milliseconds;          /* mean per water step, all its sand substeps together */
    uint32_t passes;              /* dispatches per water step */
} wadi_stage_timing;
/** Mean times since profiling was switched on. *count: capacity in, stages out; timings may be NULL to ask the number. */
WADI_API wadi_result wadi_world_get_stage_timings(wadi_world_id world, wadi_stage_timing* timings, uint32_t* count);

/* ---- Snapshots ---- */

/** Saves the state to memory, to the bit: fields, ledgers and running totals, not the level itself. *size: bytes at `data` in,
 *  bytes of the snapshot out; data may be NULL to ask the number, which waits for nothing. Waits for the steps asked for.
 *  Errors: BAD_ARGUMENT (size NULL or too small), DEVICE_LOST. */
WADI_API wadi_result wadi_world_save(wadi_world_id world, void* data, size_t* size);
/** Goes to a saved state: the world continues as the saved one would have, in every bit, on any backend that passes the
 *  exact-float test. The snapshot must be of a world of the same level settings (grid, dt, material, method, sides, sources, rain);
 *  initial fields may differ, and effects that only this world has start from zero. Waits for the device.
 *  Errors, all leaving the world unchanged: BAD_FILE (no snapshot, a newer version, truncated, changed), BAD_ARGUMENT (of another
 *  level, or with effects that this world's level forces off), DEVICE_LOST. */
WADI_API wadi_result wadi_world_load(wadi_world_id world, const void* data, size_t size);
/** wadi_world_save to a file, written as path + ".part" and renamed when it is whole. Errors: NOT_FOUND (the folder cannot be
 *  written to), BAD_FILE (writing failed). */
WADI_API wadi_result wadi_world_save_file(wadi_world_id world, const char* path);
/** wadi_world_load from a file. Errors: NOT_FOUND, and those of wadi_world_load. */
WADI_API wadi_result wadi_world_load_file(wadi_world_id world, const char* path);

/** Asks for a snapshot of the state after the steps asked for so far, or, in the middle of a step that runs in parts, after that
 *  step. Returns at once: the device copies the state aside. The first call allocates room for it. A snapshot asked for earlier
 *  that nobody has begun to fetch is forgotten. NOT_READY: the device or a worker is still at an earlier one. */
WADI_API wadi_result wadi_world_begin_save(wadi_world_id world, uint64_t* ticket);
/** Fetches it: NOT_READY until the snapshot lies in `data`, then OK, once. Never waits: a worker thread fills `data`, so from the
 *  first call on that memory must stay where it is, and the same pointer must be passed, until a call returns something else than
 *  NOT_READY or the world is destroyed. *size as in wadi_world_save; data may be NULL to ask the number.
 *  Errors: BAD_ARGUMENT (another ticket, another data, size NULL or too small), DEVICE_LOST. */
WADI_API wadi_result wadi_world_end_save(wadi_world_id world, uint64_t ticket, void* data, size_t* size);

/** 64-bit hash of the state, ghosts and terrain excluded: wadi_world_stats.hash without the rest. Equal states have equal hashes on
 *  every backend that passes the exact-float test. Waits for the steps asked for and reads the whole state. */
WADI_API wadi_result wadi_world_get_hash(wadi_world_id world, uint64_t* hash);

/* ---- Introspection ---- */

typedef struct wadi_memory_item {
    char label[64];               /* the field, or what the buffer is for */
    uint64_t bytes;
} wadi_memory_item;
/** Every buffer the world holds on its device, those for the host to read included; they add up to wadi_world_info.device_bytes.
 *  *count: capacity in, buffers out; items may be NULL to ask the number. Does not wait. */
WADI_API wadi_result wadi_world_get_memory(wadi_world_id world, wadi_memory_item* items, uint32_t* count);

typedef struct wadi_effect_info {
    char name[32];                /* as level files write it */
    int32_t on;                   /* 1 = its passes run and its fields exist */
    char why[160];                /* one sentence: why it is on or off */
} wadi_effect_info;
/** The effects and why each is on or off. *count: capacity in, effects out; effects may be NULL to ask the number. Does not
 *  wait. */
WADI_API wadi_result wadi_world_get_effects(wadi_world_id world, wadi_effect_info* effects, uint32_t* count);

/** OK, or what broke the world for good (DEVICE_LOST) with wadi_get_last_error() saying how. Does not wait: a fault that the
 *  device has not reported yet is not known. */
WADI_API wadi_result wadi_world_get_error(wadi_world_id world);

/* ---- Edits ---- */

typedef enum wadi_layer {
    WADI_LAYER_TERRAIN = 0,
    WADI_LAYER_SAND = 1,
    WADI_LAYER_WATER = 2
} wadi_layer;

typedef enum wadi_edit_kind {
    WADI_EDIT_BRUSH = 0, /* raises (amount > 0) or lowers a layer within a disc or capsule */
    WADI_EDIT_STAMP = 1, /* the same by an image over a rectangle */
    WADI_EDIT_PUSH = 2   /* a body that drags sand and water along and feels nothing itself; moves no mass */
} wadi_edit_kind;

/** One edit. It counts for cells whose centre lies inside its shape, which may lie outside the grid in part or as a whole.
 *  Positions are kept to 1/256 of a cell. */
typedef struct wadi_edit {
    uint32_t struct_size;
    int32_t kind;         /* wadi_edit_kind */
    int32_t layer;        /* wadi_layer, of brush and stamp */
    int32_t capsule;      /* brush and push: 0 = disc round (x0, y0), 1 = all within radius of the line from (x0, y0) to (x1, y1) */
    uint64_t step;        /* the water step ahead of which it acts, as wadi_world_get_time counts; 0 = the next one */
    double x0, y0;        /* [m], -1e9 ... 1e9; of a stamp the low corner */
    double x1, y1;        /* [m], capsule and stamp only; of a stamp the high corner, greater than the low one */
    double radius;        /* [m], 1e-9 ... 1e9, brush and push */
    double softness;      /* 0 ... 1, brush and push: share of the radius over which the effect falls to 0 (3 s^2 - 2 s^3) */
    double amount;        /* brush: change at the centre [m]; stamp: metres per unit of the image. At most twice
                           * method.largest_height up or down */
    double strength;      /* 0 ... 1, push: how far velocities are drawn to the body's at the centre */
    double velocity_x;    /* [m/s], -1e4 ... 1e4, push: the body's velocity */
    double velocity_y;
    uint32_t stamp;       /* stamp: its number, from wadi_world_create_stamp */
} wadi_edit;
WADI_API wadi_edit wadi_default_edit(void); /* a brush on terrain: radius 1, softness 0.5, strength 1, the rest 0 */

/** Queues `count` edits. Those of one step act in the order of the calls, ahead of that step; in the middle of a step that runs in
 *  parts "the next one" is the one after it. Depths change by whole quanta and every quantum is in the ledger; what finds no room
 *  below method.largest_height is refused and counted (wadi_world_stats.refused); no more is taken than there is. Sand and water
 *  keep their depth where terrain changes, added sand is unstrained. An edit that adds a material the world has not held so far
 *  promotes it when its step comes: buffers are allocated and programs recorded anew, once, and that step may wait for the device.
 *  Returns at once. wadi_world_load and every other way back in time drops the edits that wait: queue those of later steps again.
 *  Errors: BAD_ARGUMENT, naming edit, field and range, or `effects` when the level forces off what an edit adds; none is queued. */
WADI_API wadi_result wadi_world_edit(wadi_world_id world, const wadi_edit* edits, uint32_t count);

/** Copies an image for stamps: nx * ny values (1 ... 4096 each, |value| <= 1e12), row 0 in the south, bilinear between pixels.
 *  *stamp counts up from 1; stamps live as long as the world. Allocates; may wait. Errors: BAD_ARGUMENT, OUT_OF_MEMORY. */
WADI_API wadi_result wadi_world_create_stamp(wadi_world_id world, int32_t nx, int32_t ny, const float* values, uint32_t* stamp);

/** Compiles the pipelines of every effect that the level allows, so that a later promotion only allocates and records. Costs time once
 *  (GPU drivers: up to seconds) and next to no memory; call it while loading. Does not wait for steps. */
WADI_API wadi_result wadi_world_prepare_effects(wadi_world_id world);
/** Frees the passes and buffers of materials that the world no longer holds; what it gave and took stays in the ledger. Waits for
 *  the steps asked for and reads the heights. */
WADI_API wadi_result wadi_world_trim(wadi_world_id world);

/** Cells [i0, i0 + nx) x [j0, j0 + ny); must lie within the grid. */
typedef struct wadi_region {
    uint32_t struct_size;
    int32_t i0, j0;
    int32_t nx, ny;
} wadi_region;
WADI_API wadi_region wadi_default_region(void); /* all zero but struct_size */

/** Reads a field in a region, count = nx * ny floats; waits for the steps asked for. Errors: BAD_ARGUMENT. */
WADI_API wadi_result wadi_world_read_region(wadi_world_id world, wadi_field field, const wadi_region* region, float* values, size_t count);
/** Overwrites terrain, sand height or water height [m] in a region at once, after the steps asked for, which it waits for. Values
 *  are rounded to quanta; what that adds or takes is in the ledger; velocities stay. Promotes like an edit.
 *  Errors, nothing changed: BAD_ARGUMENT (another field, a region outside, NaN, a negative depth, a column above
 *  method.largest_height: the message names the cell; `effects` forced off). */
WADI_API wadi_result wadi_world_write_region(wadi_world_id world, wadi_field field, const wadi_region* region, const float* values,
                                             size_t count);

/* ---- Command log ---- */

/** 1 = from now on remember every edit, written region and trim with its step, in host memory that grows; 0 = stop and drop the log.
 *  Off at first. Going back in time drops what was remembered for later steps. Does not wait. */
WADI_API wadi_result wadi_world_set_command_log(wadi_world_id world, int32_t on);
/** The log as bytes, with all stamps of the world: a few dozen bytes per edit, versioned and checksummed. *size: bytes at `data` in,
 *  bytes of the log out; data may be NULL to ask the number. Does not wait. Errors: BAD_ARGUMENT (size NULL or too small). */
WADI_API wadi_result wadi_world_get_commands(wadi_world_id world, void* data, size_t* size);
/** Queues the commands of a log in a world of the same level: a fresh one, or one that stands where logging began. After the same
 *  number of steps, in frames of any rhythm, both have the same hash, on every backend that passes the exact-float test. Allocates
 *  for stamps; waits where a written region or trim counts at once, as do later steps ahead of which one counts.
 *  Errors, nothing queued: BAD_FILE (no log, a newer version, truncated, changed), BAD_ARGUMENT (of another level, or with commands
 *  for steps already done). */
WADI_API wadi_result wadi_world_play_commands(wadi_world_id world, const void* data, size_t size);

/* ---- Levels from memory ---- */

/** Reads a file that a level names, for the host's own file system. Called with data NULL first: sets *size to the file's bytes;
 *  then with room for *size bytes: fills it and sets *size to what it wrote. Returns 1, or 0 where there is no such file. `name` is
 *  as the level writes it, '/' between folders. Called only inside wadi_create_world_from_level_text, on its thread. */
typedef int32_t (*wadi_read_file_callback)(void* user, const char* name, void* data, size_t* size);

/** A world from the text of a level file. Maps and series that it names come from read_file; with read_file NULL the text may name
 *  none: nothing is read from disk. Errors: those of wadi_create_world_from_level. */
WADI_API wadi_result wadi_create_world_from_level_text(const char* json, wadi_read_file_callback read_file, void* user,
                                                       const wadi_level_overrides* overrides, const wadi_device_options* options,
                                                       wadi_world_id* world);

#ifdef __cplusplus
}
#endif
#endif
