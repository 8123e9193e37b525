#include "engine/engine.h"
#include "float.h"
#include "level.h"
#include "results.h"
#include "shared_device.h"
#include "terrain.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_STEPS_PER_UPDATE = 1024 };

/* Comes from any thread; the engine's log takes lines from all. */
static void log_line(void* user, wadi_log_level level, const char* message) {
    (void)user;
    if (level == WADI_LOG_ERROR)
        log_error("%s", message);
    else if (level == WADI_LOG_WARNING)
        log_warning("%s", message);
}

static wadi_result set_pace(const Terrain* terrain) {
    wadi_update_settings settings = wadi_default_update_settings();
    settings.max_steps_per_update = (uint32_t)terrain->max_steps_per_frame;
    if (terrain->wait_for_device) settings.max_steps_in_flight = 0;
    return wadi_world_set_update_settings(terrain->world, &settings);
}

/* A property that has no good value: the message names it and its range. */
static bool properties_good(Terrain* terrain) {
    if (terrain->max_steps_per_frame < 1 || terrain->max_steps_per_frame > MOST_STEPS_PER_UPDATE) {
        world_refused(terrain, 0, "max_steps_per_frame: %lld; 1 ... %d", (long long)terrain->max_steps_per_frame,
                      MOST_STEPS_PER_UPDATE);
        return false;
    }
    if (!(terrain->time_scale >= 0 && terrain->time_scale <= 1000)) {
        world_refused(terrain, 0, "time_scale: %g; 0 ... 1000", terrain->time_scale);
        return false;
    }
    if (terrain->threads < 0 || terrain->threads > INT32_MAX) {
        world_refused(terrain, 0, "threads: %lld; 0 (all cores but one) or more", (long long)terrain->threads);
        return false;
    }
    if (terrain->outputs < 0 || terrain->outputs >= WADI_OUTPUT_BIT(WADI_OUTPUT_COUNT)) {
        world_refused(terrain, 0, "outputs: %lld; bits of OUTPUT_TERRAIN ... OUTPUT_PACKED_HALF", (long long)terrain->outputs);
        return false;
    }
    return true;
}

static wadi_result make_on(Terrain* terrain, const Level* level, const char* backend, char* message, size_t size) {
    wadi_device_options options = wadi_default_device_options();
    options.backend = backend;
    options.threads = (int32_t)terrain->threads;
    options.log = log_line;
    options.vulkan_host = terrain->textures.shared ? shared_host(terrain->textures.shared) : NULL;
    return level_create_world(level, &options, &terrain->world, message, size);
}

/* On the renderer's device where that was asked for and can be; where not, the log says why and textures go through host memory.
 */
static wadi_result make(Terrain* terrain, const Level* level, char* message, size_t size) {
    static const char instead[] = "share_device: %s; textures go through host memory";
    char why[sizeof terrain->message] = "the backend is neither \"auto\" nor \"vulkan\"";
    char* text = string_text(&terrain->backend);
    const char* backend = text && *text ? text : "auto";
    const bool on_vulkan = strcmp(backend, "auto") == 0 || strcmp(backend, "vulkan") == 0;
    if (terrain->share_device && on_vulkan) terrain->textures.shared = shared_open(why, sizeof why);
    if (terrain->share_device && !terrain->textures.shared) log_warning(instead, why);
    wadi_result result = make_on(terrain, level, backend, message, size);
    if (result == WADI_ERROR_NOT_SUPPORTED && terrain->textures.shared) {
        log_warning(instead, message);
        shared_close(terrain->textures.shared, NULL);
        terrain->textures.shared = NULL;
        result = make_on(terrain, level, backend, message, size);
    }
    if (result != WADI_OK && terrain->textures.shared) {
        shared_close(terrain->textures.shared, NULL);
        terrain->textures.shared = NULL;
    }
    free(text);
    return result;
}

int64_t world_start(Terrain* terrain) {
    if (terrain->started) return world_refused(terrain, ERROR_ALREADY_IN_USE, "start: there is a world already; stop() ends it");
    const Level* level = instance_of(&level_class, terrain->level);
    if (!level) return world_refused(terrain, ERROR_UNCONFIGURED, "start: level: is not set to a WadiLevel");
    if (!properties_good(terrain)) return ERROR_INVALID_PARAMETER;
    char message[sizeof terrain->message - 16];
    wadi_result result = make(terrain, level, message, sizeof message);
    if (result != WADI_OK) {
        world_refused(terrain, 0, "start: %s", message);
        return error_of(result);
    }
    terrain->info = wadi_default_world_info();
    result = wadi_world_get_info(terrain->world, &terrain->info);
    terrain->started = true;
    terrain->lost = false;
    terrain->nanoseconds_left = 0;
    memset(terrain->sources, 0, sizeof terrain->sources);
    terrain->told_step = terrain->dirty_step = 0;
    if (result == WADI_OK) result = set_pace(terrain);
    if (result == WADI_OK) result = world_set_outputs(terrain);
    if (result == WADI_OK) result = frame_sync(terrain);
    if (result != WADI_OK) {
        const GDObjectInstanceID id = api.object_get_instance_id(terrain->object);
        const wadi_world_id failed = terrain->world;
        const int64_t error = world_failed(terrain, "start", result);
        /* device_lost may be told to who frees the node, or has started another world in it */
        if (api.object_get_instance_from_id(id) && terrain->world.index == failed.index &&
            terrain->world.generation == failed.generation)
            world_stop(terrain);
        return error;
    }
    emit(terrain->object, "started", NULL, 0);
    return ERROR_OK;
}

void world_stop(Terrain* terrain) {
    if (!terrain->started) return;
    terrain->started = false;
    if (terrain->textures.shared) shared_close(terrain->textures.shared, &terrain->textures);
    terrain->textures.shared = NULL;
    wadi_destroy_world(terrain->world); /* ahead of the memory that its worker may be filling */
    textures_clear(&terrain->textures);
    free(terrain->save_data);
    terrain->save_data = NULL;
    terrain->save_ticket = 0;
    floats_forget(terrain);
    terrain->heights_asked = false;
}

void world_settings_changed(void* self) {
    Terrain* terrain = self;
    if (!terrain->started || !properties_good(terrain)) return;
    const wadi_result result = set_pace(terrain);
    if (result != WADI_OK) world_failed(terrain, "max_steps_per_frame", result);
}

void world_outputs_changed(void* self) {
    Terrain* terrain = self;
    if (!terrain->started || !properties_good(terrain)) return;
    const wadi_result result = world_set_outputs(terrain);
    if (result != WADI_OK) world_failed(terrain, "outputs", result);
}

void terrain_start(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    *(int64_t*)result = world_start(self);
}

void terrain_stop(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    (void)result;
    world_stop(self);
}
