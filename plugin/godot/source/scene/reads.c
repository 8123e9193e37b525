#include "engine/collections.h"
#include "results.h"
#include "terrain.h"

#include <inttypes.h>
#include <stdio.h>

void terrain_is_started(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    *(uint8_t*)result = ((const Terrain*)self)->started;
}

void terrain_get_hash(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    if (!world_needed(terrain, "get_hash")) return;
    uint64_t hash;
    const wadi_result outcome = wadi_world_get_hash(terrain->world, &hash);
    if (outcome != WADI_OK) {
        world_failed(terrain, "get_hash", outcome);
        return;
    }
    char text[20];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    const String string = string_of(text);
    value_move(GDEXTENSION_VARIANT_TYPE_STRING, result, &string);
}

static uint64_t time_of(Terrain* terrain, double* seconds) {
    uint64_t steps = 0;
    *seconds = 0;
    if (terrain->started) wadi_world_get_time(terrain->world, seconds, &steps);
    return steps;
}

void terrain_get_time(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    time_of(self, result);
}

void terrain_get_step(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    double seconds;
    *(int64_t*)result = (int64_t)time_of(self, &seconds);
}

void terrain_get_cells(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    const Terrain* terrain = self;
    if (terrain->started) *(Vector2i*)result = (Vector2i){terrain->info.nx, terrain->info.ny};
}

void terrain_get_cell_size(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    const Terrain* terrain = self;
    *(double*)result = terrain->started ? terrain->info.dx : 0;
}

void terrain_get_extent(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    const Terrain* terrain = self;
    const double dx = terrain->info.dx;
    if (terrain->started) *(Vector2*)result = (Vector2){(float)(terrain->info.nx * dx), (float)(terrain->info.ny * dx)};
}

void terrain_get_last_message(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    const String string = string_of(((const Terrain*)self)->message);
    value_move(GDEXTENSION_VARIANT_TYPE_STRING, result, &string);
}

void terrain_get_stats(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    if (!world_needed(terrain, "get_stats")) return;
    wadi_world_stats stats = wadi_default_world_stats();
    const wadi_result outcome = wadi_world_get_stats(terrain->world, &stats);
    if (outcome != WADI_OK) {
        world_failed(terrain, "get_stats", outcome);
        return;
    }
    dictionary_set_text(result, "name", terrain->info.name);
    dictionary_set_text(result, "backend", terrain->info.backend);
    dictionary_set_text(result, "device_name", terrain->info.device_name);
    dictionary_set_int(result, "device_bytes", (int64_t)terrain->info.device_bytes);
    dictionary_set_float(result, "dt", terrain->info.dt);
    dictionary_set_float(result, "time", stats.time);
    dictionary_set_int(result, "steps", (int64_t)stats.steps);
    dictionary_set_float(result, "sand_volume", stats.sand_volume);
    dictionary_set_float(result, "water_volume", stats.water_volume);
    dictionary_set_float(result, "sand_initial", stats.sand_initial);
    dictionary_set_float(result, "water_initial", stats.water_initial);
    dictionary_set_float(result, "sand_in", stats.sand_in);
    dictionary_set_float(result, "sand_out", stats.sand_out);
    dictionary_set_float(result, "water_in", stats.water_in);
    dictionary_set_float(result, "water_out", stats.water_out);
    dictionary_set_float(result, "refused", stats.refused);
    dictionary_set_int(result, "sand_drift_quanta", stats.sand_drift_quanta);
    dictionary_set_int(result, "water_drift_quanta", stats.water_drift_quanta);
    dictionary_set_float(result, "largest_water_speed", stats.largest_water_speed);
    dictionary_set_float(result, "largest_sand_speed", stats.largest_sand_speed);
    dictionary_set_int(result, "not_finite", (int64_t)stats.not_finite);
}
