/* Written by plugin/write_api.py from wadi.h and wadi_cuda.h. For hosts that open the library at run time and run on without it; C99.
 *
 * Define WADI_LOADER_IMPLEMENTATION in one file ahead of including this. The functions are members of a table:
 *   wadi_functions wadi;
 *   const char* missing = wadi_load_functions(&wadi, find, user);   NULL: all are there, and the library's ABI is the header's
 *   wadi.create_world_from_level(...)
 * `find` gives the address of a name: dlsym, GetProcAddress, or the engine's own. wadi.h gives types and initialisers. */
#ifndef WADI_LOADER_H
#define WADI_LOADER_H

#include <wadi/wadi_cuda.h>

#define WADI_FUNCTIONS(X) \
    X(uint32_t, get_abi_version, (void)) \
    X(uint32_t, get_version, (void)) \
    X(const char*, get_last_error, (void)) \
    X(wadi_result, list_devices, (wadi_device_info* infos, uint32_t* count, char* notes, size_t notes_size)) \
    X(wadi_result, list_accuracy_presets, (wadi_accuracy_preset* presets, uint32_t* count)) \
    X(wadi_result, create_world_from_level, (const char* path, const wadi_level_overrides* overrides, const wadi_device_options* options, wadi_world_id* world)) \
    X(wadi_result, create_world_from_level_text, (const char* json, wadi_read_file_callback read_file, void* user, const wadi_level_overrides* overrides, const wadi_device_options* options, wadi_world_id* world)) \
    X(wadi_result, get_level_cost, (const char* path, const wadi_level_overrides* overrides, wadi_cost* cost)) \
    X(wadi_result, get_level_text_cost, (const char* json, wadi_read_file_callback read_file, void* user, const wadi_level_overrides* overrides, wadi_cost* cost)) \
    X(wadi_result, create_world_from_arrays, (const wadi_world_arrays* arrays, const wadi_device_options* options, wadi_world_id* world)) \
    X(wadi_result, destroy_world, (wadi_world_id world)) \
    X(wadi_result, world_get_info, (wadi_world_id world, wadi_world_info* info)) \
    X(const char*, world_get_warning, (wadi_world_id world, uint32_t n)) \
    X(wadi_result, world_set_update_settings, (wadi_world_id world, const wadi_update_settings* settings)) \
    X(wadi_result, world_update, (wadi_world_id world, uint64_t host_nanoseconds, wadi_frame* frame)) \
    X(wadi_result, world_step, (wadi_world_id world, uint32_t steps)) \
    X(wadi_result, world_get_time, (wadi_world_id world, double* seconds, uint64_t* steps)) \
    X(wadi_result, world_set_outputs, (wadi_world_id world, wadi_output_mask mask)) \
    X(wadi_result, world_get_view, (wadi_world_id world, wadi_output output, wadi_output_set set, wadi_output_view* view)) \
    X(wadi_result, world_set_host_outputs, (wadi_world_id world, wadi_output_mask mask)) \
    X(wadi_result, world_wait_for_outputs, (wadi_world_id world)) \
    X(wadi_result, world_get_host_output, (wadi_world_id world, wadi_output output, const float** data, uint64_t* row_pitch, uint64_t* step)) \
    X(wadi_result, world_get_tiles, (wadi_world_id world, wadi_tile* tiles, uint32_t* count, uint64_t* step)) \
    X(wadi_result, world_get_dirty_regions, (wadi_world_id world, int64_t since_step, wadi_region* regions, uint32_t* count, uint64_t* step)) \
    X(const char*, field_name, (wadi_field field)) \
    X(wadi_result, world_read_field, (wadi_world_id world, wadi_field field, float* values, size_t count)) \
    X(wadi_result, world_read_region, (wadi_world_id world, wadi_field field, const wadi_region* region, float* values, size_t count)) \
    X(wadi_result, world_get_stats, (wadi_world_id world, wadi_world_stats* stats)) \
    X(wadi_result, world_get_hash, (wadi_world_id world, uint64_t* hash)) \
    X(wadi_result, world_query, (wadi_world_id world, const float* xy, uint32_t count, uint64_t* ticket)) \
    X(wadi_result, world_get_query, (wadi_world_id world, uint64_t ticket, wadi_query_result* results, uint32_t capacity, uint32_t* count, uint64_t* step)) \
    X(wadi_result, buoyancy_points, (const wadi_body* body, float* xy, uint32_t* count)) \
    X(wadi_result, buoyancy_force, (const wadi_body* body, const wadi_query_result* results, uint32_t count, float force[3], float torque[3])) \
    X(wadi_result, world_edit, (wadi_world_id world, const wadi_edit* edits, uint32_t count)) \
    X(wadi_result, world_create_stamp, (wadi_world_id world, int32_t nx, int32_t ny, const float* values, uint32_t* stamp)) \
    X(wadi_result, world_write_region, (wadi_world_id world, wadi_field field, const wadi_region* region, const float* values, size_t count)) \
    X(wadi_result, world_write_region_from, (wadi_world_id world, wadi_field field, const wadi_region* region, const wadi_device_values* values)) \
    X(wadi_result, world_prepare_effects, (wadi_world_id world)) \
    X(wadi_result, world_trim, (wadi_world_id world)) \
    X(wadi_result, world_get_source, (wadi_world_id world, uint32_t index, wadi_source* source)) \
    X(wadi_result, world_set_source, (wadi_world_id world, uint32_t index, const wadi_source* source)) \
    X(wadi_result, world_get_material, (wadi_world_id world, wadi_material_info* infos, uint32_t* count)) \
    X(wadi_result, world_set_material, (wadi_world_id world, const char* name, double value)) \
    X(wadi_result, world_save, (wadi_world_id world, void* data, size_t* size)) \
    X(wadi_result, world_load, (wadi_world_id world, const void* data, size_t size)) \
    X(wadi_result, world_get_snapshot_cost, (wadi_world_id world, const void* data, size_t size, wadi_cost* cost)) \
    X(wadi_result, world_save_file, (wadi_world_id world, const char* path)) \
    X(wadi_result, world_load_file, (wadi_world_id world, const char* path)) \
    X(wadi_result, world_begin_save, (wadi_world_id world, uint64_t* ticket)) \
    X(wadi_result, world_end_save, (wadi_world_id world, uint64_t ticket, void* data, size_t* size)) \
    X(wadi_result, world_set_rollback, (wadi_world_id world, uint32_t frames, uint32_t interval_steps)) \
    X(wadi_result, world_get_rollback_steps, (wadi_world_id world, uint64_t* steps, uint32_t* count)) \
    X(wadi_result, world_roll_back, (wadi_world_id world, uint64_t step, uint64_t* reached)) \
    X(wadi_result, world_set_command_log, (wadi_world_id world, wadi_bool on)) \
    X(wadi_result, world_get_commands, (wadi_world_id world, void* data, size_t* size)) \
    X(wadi_result, world_get_commands_since, (wadi_world_id world, uint64_t step, uint64_t player, void* data, size_t* size)) \
    X(wadi_result, world_play_commands, (wadi_world_id world, const void* data, size_t size)) \
    X(wadi_result, world_get_commands_cost, (wadi_world_id world, const void* data, size_t size, wadi_cost* cost)) \
    X(size_t, world_describe_plan, (wadi_world_id world, char* text, size_t size)) \
    X(size_t, describe_table, (const char* table, char* text, size_t size)) \
    X(wadi_result, world_get_effects, (wadi_world_id world, wadi_effect_info* effects, uint32_t* count)) \
    X(wadi_result, world_get_memory, (wadi_world_id world, wadi_memory_item* items, uint32_t* count)) \
    X(wadi_result, world_set_profiling, (wadi_world_id world, wadi_bool on)) \
    X(wadi_result, world_get_stage_timings, (wadi_world_id world, wadi_stage_timing* timings, uint32_t* count)) \
    X(wadi_result, world_set_checking, (wadi_world_id world, wadi_bool on)) \
    X(wadi_result, world_get_error, (wadi_world_id world)) \
    X(wadi_result, cuda_wait, (wadi_world_id world, void* event)) \
    X(wadi_result, cuda_signal, (wadi_world_id world, void* event))

typedef struct wadi_functions {
#define WADI_MEMBER(RETURNS, NAME, ARGUMENTS) RETURNS (*NAME) ARGUMENTS;
    WADI_FUNCTIONS(WADI_MEMBER)
#undef WADI_MEMBER
} wadi_functions;

/** The address of a function of the library, or NULL. */
typedef void (*(*wadi_find_function)(void* user, const char* name))(void);

#ifdef __cplusplus
extern "C" {
#endif
/** Fills the table. NULL, or the name of the first function that the library lacks: it is older than this header; or
 *  "wadi_get_abi_version" where its ABI version is another, and it must not be used. */
const char* wadi_load_functions(wadi_functions* functions, wadi_find_function find, void* user);
#ifdef __cplusplus
}
#endif

#ifdef WADI_LOADER_IMPLEMENTATION
const char* wadi_load_functions(wadi_functions* functions, wadi_find_function find, void* user) {
#define WADI_FIND(RETURNS, NAME, ARGUMENTS) \
    functions->NAME = (RETURNS (*) ARGUMENTS)find(user, "wadi_" #NAME); \
    if (!functions->NAME) return "wadi_" #NAME;
    WADI_FUNCTIONS(WADI_FIND)
#undef WADI_FIND
    return functions->get_abi_version() == WADI_ABI_VERSION ? (const char*)0 : "wadi_get_abi_version";
}
#endif
#endif
