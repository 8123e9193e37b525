#include "engine/collections.h"
#include "pose.h"
#include "results.h"
#include "terrain.h"

#include <stdlib.h>
#include <string.h>

/* The shape of a brush or push from `from` to `to`, in the world's axes. */
static wadi_edit edit_between(const Terrain* terrain, wadi_edit_kind kind, const Vector3* from, const Vector3* to,
                              double radius) {
    wadi_edit edit = wadi_default_edit();
    edit.kind = kind;
    edit.capsule = to != NULL;
    edit.x0 = world_x(terrain, from->x);
    edit.y0 = world_y(terrain, from->z);
    if (to) {
        edit.x1 = world_x(terrain, to->x);
        edit.y1 = world_y(terrain, to->z);
    }
    edit.radius = radius;
    return edit;
}

static int64_t queue(Terrain* terrain, const char* call, const wadi_edit* edit) {
    const wadi_result result = wadi_world_edit(terrain->world, edit, 1);
    return result == WADI_OK ? ERROR_OK : world_failed(terrain, call, result);
}

static bool layer_good(Terrain* terrain, const char* call, int64_t layer) {
    if (layer >= WADI_LAYER_TERRAIN && layer <= WADI_LAYER_WATER) return true;
    world_refused(terrain, 0, "%s: layer: %lld; 0 (LAYER_TERRAIN), 1 (LAYER_SAND) or 2 (LAYER_WATER)", call, (long long)layer);
    return false;
}

static int64_t brush(Terrain* terrain, const char* call, int64_t layer, const Vector3* from, const Vector3* to,
                     const GDExtensionConstTypePtr* rest) {
    if (!world_needed(terrain, call)) return ERROR_UNCONFIGURED;
    if (!layer_good(terrain, call, layer)) return ERROR_INVALID_PARAMETER;
    wadi_edit edit = edit_between(terrain, WADI_EDIT_BRUSH, from, to, *(const double*)rest[0]);
    edit.layer = (wadi_layer)layer;
    edit.amount = *(const double*)rest[1];
    edit.softness = *(const double*)rest[2];
    return queue(terrain, call, &edit);
}

void terrain_brush(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    *(int64_t*)result = brush(self, "brush", *(const int64_t*)arguments[0], arguments[1], NULL, arguments + 2);
}

void terrain_brush_line(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    *(int64_t*)result = brush(self, "brush_line", *(const int64_t*)arguments[0], arguments[1], arguments[2], arguments + 3);
}

void terrain_push(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    const Vector3* velocity = arguments[2];
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "push")) return;
    wadi_edit edit = edit_between(terrain, WADI_EDIT_PUSH, arguments[0], NULL, *(const double*)arguments[1]);
    edit.velocity_x = velocity->x;
    edit.velocity_y = -velocity->z;
    edit.strength = *(const double*)arguments[3];
    *(int64_t*)result = queue(terrain, "push", &edit);
}

void terrain_set_material(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    Terrain* terrain = self;
    *(int64_t*)result = ERROR_UNCONFIGURED;
    if (!world_needed(terrain, "set_material")) return;
    char* name = string_text(arguments[0]);
    const wadi_result outcome = wadi_world_set_material(terrain->world, name ? name : "", *(const double*)arguments[1]);
    free(name);
    *(int64_t*)result = outcome == WADI_OK ? ERROR_OK : world_failed(terrain, "set_material", outcome);
}

void terrain_get_material(void* self, const GDExtensionConstTypePtr* arguments, void* result) {
    (void)arguments;
    Terrain* terrain = self;
    if (!world_needed(terrain, "get_material")) return;
    wadi_material_info infos[64];
    uint32_t count = sizeof infos / sizeof *infos;
    const wadi_result outcome = wadi_world_get_material(terrain->world, infos, &count);
    if (outcome != WADI_OK) {
        world_failed(terrain, "get_material", outcome);
        return;
    }
    for (uint32_t n = 0; n < count; ++n) dictionary_set_float(result, infos[n].name, infos[n].value);
}
