#include "due.h"
#include "engine/engine.h"
#include "float.h"
#include "results.h"
#include "shared_device.h"
#include "terrain.h"

static wadi_output_mask mask_of(const Terrain* terrain) { return (wadi_output_mask)terrain->outputs; }

/* Brings the newest publish into the textures. */
static bool show(Terrain* terrain, uint64_t step) {
    Textures* textures = &terrain->textures;
    if (textures->shared) return textures_update_shared(textures, terrain->world, mask_of(terrain), step);
    return textures_update_host(textures, terrain->world, &terrain->info, mask_of(terrain), step);
}

static void tell_dropped(Terrain* terrain, uint64_t nanoseconds) {
    if (nanoseconds == 0) return;
    Variant argument = variant_of_float((double)nanoseconds * 1e-9);
    emit(terrain->object, "time_dropped", &argument, 1);
}

static void tell_changes(Terrain* terrain) {
    if (!has_listeners(terrain->object, "world_changed")) return;
    Array regions;
    size_t count = 0;
    uint64_t step;
    if (surface_dirty_regions(terrain, (int64_t)terrain->told_step, &regions, &count, &step) != WADI_OK) return;
    terrain->told_step = step;
    Variant argument = variant_of(GDEXTENSION_VARIANT_TYPE_ARRAY, &regions);
    value_free(GDEXTENSION_VARIANT_TYPE_ARRAY, &regions);
    if (count > 0)
        emit(terrain->object, "world_changed", &argument, 1);
    else
        api.variant_destroy(&argument);
}

void frame_tick(Terrain* terrain) {
    if (!terrain->started || terrain->lost) return;
    double delta = 0;
    engine_call(ENGINE_Node_get_physics_process_delta_time, terrain->object, NULL, &delta);
    uint64_t nanoseconds = 0;
    if (terrain->running) {
        const double due = due_nanoseconds(delta, terrain->time_scale, terrain->nanoseconds_left);
        nanoseconds = (uint64_t)due;
        terrain->nanoseconds_left = due - (double)nanoseconds;
    }
    wadi_frame frame = wadi_default_frame();
    if (nanoseconds > 0 || terrain->updates_due > 0) {
        wadi_result result = wadi_world_update(terrain->world, nanoseconds, &frame);
        if (result == WADI_OK && terrain->wait_for_device) {
            result = frame_sync(terrain); /* textures, regions, heights and answers are those of this tick's step, in every run */
        } else if (result == WADI_OK) {
            const bool shown = show(terrain, frame.total_steps);
            if (frame.steps > 0)
                terrain->updates_due = 2;
            else if (terrain->updates_due > 1 || (terrain->updates_due == 1 && shown))
                --terrain->updates_due;
        }
        if (result != WADI_OK) {
            world_failed(terrain, "physics tick", result);
            return;
        }
    }
    floats_tick(terrain);
    /* What listens may end the world, so it comes last. */
    const GDObjectInstanceID id = api.object_get_instance_id(terrain->object);
    tell_dropped(terrain, frame.dropped_nanoseconds);
    if (api.object_get_instance_from_id(id) && terrain->started) tell_changes(terrain);
}

wadi_result frame_sync(Terrain* terrain) {
    uint64_t step = 0;
    wadi_result result = wadi_world_get_time(terrain->world, NULL, &step);
    wadi_frame frame = wadi_default_frame();
    const wadi_region corner = {0, 0, 1, 1};
    float height;
    const int64_t microseconds = 200;
    const GDExtensionConstTypePtr wait[] = {&microseconds};
    for (int tries = 0; result == WADI_OK && tries < 1000; ++tries) {
        result = wadi_world_update(terrain->world, 0, &frame);
        /* reading waits for the steps; a second update then finds the copy of what this one published */
        if (result == WADI_OK) result = wadi_world_read_region(terrain->world, WADI_FIELD_TERRAIN, &corner, &height, 1);
        if (result == WADI_OK && tries > 0 && show(terrain, step)) break;
        if (tries > 1) engine_call(ENGINE_OS_delay_usec, singleton("OS"), wait, NULL);
    }
    if (result == WADI_OK) terrain->updates_due = 0;
    return result;
}

void terrain_step(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    const int64_t count = *(const int64_t*)arguments[0];
    int64_t* error = result;
    if (!world_needed(terrain, "step")) {
        *error = ERROR_UNCONFIGURED;
        return;
    }
    if (count < 0 || count > UINT32_MAX) {
        *error = world_refused(terrain, ERROR_INVALID_PARAMETER, "step: count: %lld; 0 ... 4294967295", (long long)count);
        return;
    }
    const wadi_result outcome = wadi_world_step(terrain->world, (uint32_t)count);
    terrain->updates_due = 2;
    *error = outcome == WADI_OK ? ERROR_OK : world_failed(terrain, "step", outcome);
}

void terrain_sync_textures(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "sync_textures")) return;
    const wadi_result outcome = frame_sync(terrain);
    *(int64_t*)result = outcome == WADI_OK ? ERROR_OK : world_failed(terrain, "sync_textures", outcome);
}

void terrain_get_texture(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    const int64_t output = *(const int64_t*)arguments[0];
    if (!world_needed(terrain, "get_texture")) return;
    if (output < 0 || output >= WADI_OUTPUT_COUNT) {
        world_refused(terrain, 0, "get_texture: output: %lld; 0 (OUTPUT_TERRAIN) ... %d (OUTPUT_PACKED_HALF)", (long long)output,
                      WADI_OUTPUT_COUNT - 1);
        return;
    }
    const int64_t bit = (int64_t)WADI_OUTPUT_BIT(output);
    if (!(terrain->outputs & bit) || !terrain->textures.objects[output]) {
        terrain->outputs |= bit;
        wadi_result outcome = world_set_outputs(terrain);
        if (outcome == WADI_OK) outcome = frame_sync(terrain);
        const GDObjectInstanceID id = api.object_get_instance_id(terrain->object);
        if (outcome != WADI_OK) world_failed(terrain, "get_texture", outcome);
        if (!api.object_get_instance_from_id(id)) return; /* device_lost was told to who freed the node */
    }
    value_assign(GDEXTENSION_VARIANT_TYPE_OBJECT, result, &terrain->textures.objects[output]);
}
