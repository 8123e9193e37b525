/* WadiLevel: which level a terrain runs, as a resource. */
#ifndef WADI_GODOT_LEVEL_H
#define WADI_GODOT_LEVEL_H

#include "engine/classes.h"

#include <wadi/wadi.h>

typedef struct Level {
    Object object;
    String file, variant, method, accuracy, settings;
    Vector2i cells;
    uint8_t drifting_foam;
    PackedFloat32Array terrain, sand, water;
} Level;

extern const Class level_class;

/** Makes a world of the level; `message` (room for `size` bytes) says why not. */
wadi_result level_create_world(const Level* level, const wadi_device_options* options, wadi_world_id* world, char* message,
                               size_t size);

#endif
