/* Sources that the scene opens. The library counts them behind those of the level and takes none out, so a closed one's number is
 * given to the next. */
#include "pose.h"
#include "results.h"
#include "terrain.h"

#include <math.h>
#include <string.h>

/* Where a disc holds no middle of a cell, the cell that its own middle is in takes all; beyond the grid none does. */
static void place(const Terrain* terrain, wadi_source* source, double* discharge) {
    const double dx = terrain->info.dx;
    const int cells[2] = {terrain->info.nx, terrain->info.ny};
    double middle[2], far = 0;
    bool inside = true;
    for (int axis = 0; axis < 2; ++axis) {
        const double cell = floor(source->center[axis] / dx);
        inside = inside && cell >= 0 && cell < cells[axis];
        middle[axis] = (fmin(fmax(cell, 0), cells[axis] - 1) + 0.5) * dx; /* the nearest */
        far += (middle[axis] - source->center[axis]) * (middle[axis] - source->center[axis]);
    }
    if (far < source->radius * source->radius * (1 - 1e-6)) return; /* the device compares in floats */
    source->shape = WADI_SOURCE_POINT;
    if (inside) return;
    memcpy(source->center, middle, sizeof middle);
    *discharge = 0;
}

static int64_t say(Terrain* terrain, const char* call, int64_t index, const OpenSource* open) {
    wadi_sample discharge = {0, open->discharge};
    wadi_source source = wadi_default_source();
    source.sand = open->sand;
    source.center[0] = open->x;
    source.center[1] = open->y;
    source.radius = open->radius;
    source.discharge = &discharge;
    source.discharge_count = 1;
    const bool good = isfinite(open->x) && isfinite(open->y) && open->radius > 0; /* the library says what is not */
    if (good && isfinite(open->discharge)) place(terrain, &source, &discharge.value);
    const wadi_result result = wadi_world_set_source(terrain->world, (uint32_t)index, &source);
    return result == WADI_OK ? ERROR_OK : world_failed(terrain, call, result);
}

static int64_t change(Terrain* terrain, const char* call, int64_t index, const GDExtensionConstTypePtr* rest) {
    const int64_t layer = *(const int64_t*)rest[0];
    const Vector3* position = rest[1];
    if (layer != WADI_LAYER_SAND && layer != WADI_LAYER_WATER)
        return world_refused(terrain, ERROR_INVALID_PARAMETER, "%s: layer: %lld; 1 (LAYER_SAND) or 2 (LAYER_WATER)", call,
                             (long long)layer);
    const OpenSource open = {.open = true,
                             .sand = layer == WADI_LAYER_SAND,
                             .x = world_x(terrain, position->x),
                             .y = world_y(terrain, position->z),
                             .radius = *(const double*)rest[2],
                             .discharge = *(const double*)rest[3]};
    const int64_t error = say(terrain, call, index, &open);
    if (error == ERROR_OK && index >= (int64_t)terrain->info.source_count) terrain->sources[index] = open;
    return error;
}

void terrain_open_source(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    int64_t* index = result;
    *index = -1;
    if (!world_needed(terrain, "open_source")) return;
    int64_t next = (int64_t)terrain->info.source_count;
    while (next < MOST_SOURCES && terrain->sources[next].open) ++next;
    if (next == MOST_SOURCES)
        world_refused(terrain, 0, "open_source: a world has %d sources at most, and all are open", MOST_SOURCES);
    else if (change(terrain, "open_source", next, arguments) == ERROR_OK)
        *index = next;
}

void terrain_set_source(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    const int64_t index = *(const int64_t*)arguments[0];
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "set_source")) return;
    if (index < 0 || index >= MOST_SOURCES)
        *(int64_t*)result = world_refused(terrain, ERROR_INVALID_PARAMETER, "set_source: index: %lld; 0 ... %d", (long long)index,
                                          MOST_SOURCES - 1);
    else
        *(int64_t*)result = change(terrain, "set_source", index, arguments + 1);
}

void terrain_close_source(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    const int64_t index = *(const int64_t*)arguments[0];
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "close_source")) return;
    if (index < 0 || index >= MOST_SOURCES || !terrain->sources[index].open) {
        *(int64_t*)result =
            world_refused(terrain, ERROR_INVALID_PARAMETER, "close_source: index: %lld; none that is open", (long long)index);
        return;
    }
    terrain->sources[index].open = false; /* ahead of the call, which may tell of a lost device to who frees the node */
    OpenSource closed = terrain->sources[index];
    closed.discharge = 0; /* where it was: another place costs more */
    *(int64_t*)result = say(terrain, "close_source", index, &closed);
}
