#include "engine/collections.h"
#include "pose.h"
#include "results.h"
#include "terrain.h"

#include <math.h>
#include <stdlib.h>

void terrain_query(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    *(int64_t*)result = 0;
    if (!world_needed(terrain, "query")) return;
    const size_t count = points_size(arguments[0]);
    if (count < 1 || count > 65536) {
        world_refused(terrain, 0, "query: points: %zu; 1 ... 65536", count);
        return;
    }
    float* xy = malloc(count * 2 * sizeof *xy);
    if (!xy) {
        world_refused(terrain, 0, "query: no memory for %zu points", count);
        return;
    }
    for (size_t n = 0; n < count; ++n) {
        const Vector2* point = api.packed_vector2_array_operator_index_const(arguments[0], (GDExtensionInt)n);
        xy[2 * n] = (float)world_x(terrain, point->x);
        xy[2 * n + 1] = (float)world_y(terrain, point->y);
    }
    uint64_t ticket = 0;
    const wadi_result outcome = wadi_world_query(terrain->world, xy, (uint32_t)count, &ticket);
    free(xy);
    if (outcome == WADI_OK)
        *(int64_t*)result = (int64_t)ticket;
    else if (outcome != WADI_NOT_READY)
        world_failed(terrain, "query", outcome);
}

static void put_answer(Dictionary* to, const wadi_query_result* from) {
    const Vector3 velocity = {from->velocity[0], 0, -from->velocity[1]};
    const Vector3 normal = {from->normal[0], from->normal[2], -from->normal[1]};
    const uint8_t inside = from->inside != 0;
    dictionary_set_float(to, "ground", from->terrain);
    dictionary_set_float(to, "surface", from->surface);
    dictionary_set_float(to, "water_depth", from->water_depth);
    dictionary_set_float(to, "sand_depth", from->sand_depth);
    dictionary_set_float(to, "saturation", from->saturation);
    dictionary_set(to, "velocity", GDEXTENSION_VARIANT_TYPE_VECTOR3, &velocity);
    dictionary_set(to, "normal", GDEXTENSION_VARIANT_TYPE_VECTOR3, &normal);
    dictionary_set(to, "inside", GDEXTENSION_VARIANT_TYPE_BOOL, &inside);
}

void terrain_get_query(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    Array answers = array_new(GDEXTENSION_VARIANT_TYPE_DICTIONARY, 0);
    value_move(GDEXTENSION_VARIANT_TYPE_ARRAY, result, &answers);
    if (!world_needed(terrain, "get_query")) return;
    const uint64_t ticket = (uint64_t) * (const int64_t*)arguments[0];
    uint32_t count = 0;
    wadi_result outcome = wadi_world_get_query(terrain->world, ticket, NULL, 0, &count, NULL);
    wadi_query_result* results = outcome == WADI_OK ? malloc(count * sizeof *results) : NULL;
    if (results) outcome = wadi_world_get_query(terrain->world, ticket, results, count, &count, NULL);
    if (outcome != WADI_OK && outcome != WADI_NOT_READY) world_failed(terrain, "get_query", outcome);
    if (results && outcome == WADI_OK) {
        answers = array_new(GDEXTENSION_VARIANT_TYPE_DICTIONARY, count);
        for (uint32_t n = 0; n < count; ++n) {
            Dictionary answer = dictionary_new();
            put_answer(&answer, &results[n]);
            array_set(&answers, n, GDEXTENSION_VARIANT_TYPE_DICTIONARY, &answer);
            value_free(GDEXTENSION_VARIANT_TYPE_DICTIONARY, &answer);
        }
        value_move(GDEXTENSION_VARIANT_TYPE_ARRAY, result, &answers);
    }
    free(results);
}

/* Rows from north to south of the solid surface, from the copy that updates bring. */
static bool heights_of_copy(const Terrain* terrain, const wadi_region* region, float* heights) {
    const float* data;
    uint64_t row_pitch;
    if (wadi_world_get_host_output(terrain->world, WADI_OUTPUT_SAND_SURFACE, &data, &row_pitch, NULL) != WADI_OK) return false;
    for (int32_t row = 0; row < region->ny; ++row) {
        const int32_t j = region->j0 + region->ny - 1 - row;
        const float* from = (const float*)(const void*)((const char*)data + (uint64_t)j * row_pitch) + region->i0;
        for (int32_t i = 0; i < region->nx; ++i) heights[(size_t)row * (size_t)region->nx + (size_t)i] = from[i];
    }
    return true;
}

/* The same, read from the device, which waits. */
static wadi_result heights_of_device(const Terrain* terrain, const wadi_region* region, float* heights) {
    const size_t nx = (size_t)region->nx, count = nx * (size_t)region->ny;
    float* both = malloc(2 * count * sizeof *both);
    if (!both) return WADI_ERROR_OUT_OF_MEMORY;
    wadi_result result = wadi_world_read_region(terrain->world, WADI_FIELD_TERRAIN, region, both, count);
    if (result == WADI_OK) result = wadi_world_read_region(terrain->world, WADI_FIELD_SAND_DEPTH, region, both + count, count);
    for (size_t n = 0; result == WADI_OK && n < count; ++n) {
        const size_t row = (size_t)region->ny - 1 - n / nx;
        heights[row * nx + n % nx] = both[n] + both[count + n];
    }
    free(both);
    return result;
}

void terrain_get_heights(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    if (!world_needed(terrain, "get_heights")) return;
    const Rect2i* asked = arguments[0];
    const wadi_region region = {asked->x, asked->y, asked->width, asked->height};
    const wadi_world_info* info = &terrain->info;
    if (region.i0 < 0 || region.j0 < 0 || region.nx < 1 || region.ny < 1 || region.i0 > info->nx - region.nx ||
        region.j0 > info->ny - region.ny) {
        world_refused(terrain, 0, "get_heights: region: position (%d, %d), size (%d, %d); within the grid of %d x %d cells",
                      region.i0, region.j0, region.nx, region.ny, info->nx, info->ny);
        return;
    }
    if (!terrain->heights_asked) {
        terrain->heights_asked = true;
        const wadi_result outcome = world_set_outputs(terrain);
        const GDObjectInstanceID id = api.object_get_instance_id(terrain->object);
        if (outcome != WADI_OK) world_failed(terrain, "get_heights", outcome);
        if (!api.object_get_instance_from_id(id)) return; /* device_lost was told to who freed the node */
    }
    PackedFloat32Array heights;
    float* room = floats_new(&heights, (size_t)region.nx * (size_t)region.ny);
    if (room && !heights_of_copy(terrain, &region, room)) {
        const wadi_result outcome = heights_of_device(terrain, &region, room);
        if (outcome != WADI_OK) world_failed(terrain, "get_heights", outcome);
    }
    value_move(GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY, result, &heights);
}

wadi_result surface_dirty_regions(Terrain* terrain, int64_t since, Array* regions, size_t* count, uint64_t* step) {
    uint32_t room = 0;
    *count = 0;
    wadi_result result = wadi_world_get_dirty_regions(terrain->world, since, NULL, &room, step);
    if (result != WADI_OK) return result;
    wadi_region* found = malloc((room + 1) * sizeof *found);
    if (!found) return WADI_ERROR_OUT_OF_MEMORY;
    result = wadi_world_get_dirty_regions(terrain->world, since, found, &room, step);
    if (result == WADI_OK) {
        *count = room;
        *regions = array_new(GDEXTENSION_VARIANT_TYPE_RECT2I, room);
        for (uint32_t n = 0; n < room; ++n) {
            const Rect2i rectangle = {found[n].i0, found[n].j0, found[n].nx, found[n].ny};
            array_set(regions, n, GDEXTENSION_VARIANT_TYPE_RECT2I, &rectangle);
        }
    }
    free(found);
    return result;
}

void terrain_get_dirty_regions(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    Array regions = array_new(GDEXTENSION_VARIANT_TYPE_RECT2I, 0);
    value_move(GDEXTENSION_VARIANT_TYPE_ARRAY, result, &regions);
    if (!world_needed(terrain, "get_dirty_regions")) return;
    size_t count;
    const wadi_result outcome =
        surface_dirty_regions(terrain, *(const int64_t*)arguments[0], &regions, &count, &terrain->dirty_step);
    if (outcome == WADI_OK)
        value_move(GDEXTENSION_VARIANT_TYPE_ARRAY, result, &regions);
    else if (outcome != WADI_NOT_READY)
        world_failed(terrain, "get_dirty_regions", outcome);
}

static bool touches(const wadi_tile* tile, const Rect2i* region) {
    return tile->i < (int64_t)region->x + region->width && tile->i + tile->nx > region->x &&
           tile->j < (int64_t)region->y + region->height && tile->j + tile->ny > region->y;
}

void terrain_get_bounds(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    Vector2* bounds = result;
    *bounds = (Vector2){0, 0};
    if (!world_needed(terrain, "get_bounds")) return;
    uint32_t count = 0;
    wadi_result outcome = wadi_world_get_tiles(terrain->world, NULL, &count, NULL);
    wadi_tile* tiles = outcome == WADI_OK ? malloc(count * sizeof *tiles) : NULL;
    if (tiles) outcome = wadi_world_get_tiles(terrain->world, tiles, &count, NULL);
    if (outcome != WADI_OK && outcome != WADI_NOT_READY) world_failed(terrain, "get_bounds", outcome);
    bool any = false;
    for (uint32_t n = 0; tiles && outcome == WADI_OK && n < count; ++n) {
        if (!touches(&tiles[n], arguments[0])) continue;
        bounds->x = any ? fminf(bounds->x, tiles[n].solid_min) : tiles[n].solid_min;
        bounds->y = any ? fmaxf(bounds->y, tiles[n].free_max) : tiles[n].free_max;
        any = true;
    }
    free(tiles);
}

void terrain_get_dirty_step(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    *(int64_t*)result = (int64_t)((const Terrain*)self)->dirty_step;
}
