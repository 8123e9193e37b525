/* Outputs of a world as textures: images that go through host memory, or images of the renderer's own device. */
#ifndef WADI_GODOT_TEXTURES_H
#define WADI_GODOT_TEXTURES_H

#include "engine/values.h"

#include <wadi/wadi.h>

typedef struct SharedDevice SharedDevice; /* shared_device.c */

typedef struct Textures {
    SharedDevice* shared;              /* NULL: through host memory */
    Object objects[WADI_OUTPUT_COUNT]; /* references to Texture2D, or NULL */
    uint64_t steps[WADI_OUTPUT_COUNT]; /* that each one shows; UINT64_MAX = nothing yet */
} Textures;

void textures_clear(Textures* textures);
/** Brings what was published into the textures of `mask`; makes those that are missing. true: all of them show step `step`. */
bool textures_update_host(Textures* textures, wadi_world_id world, const wadi_world_info* info, wadi_output_mask mask,
                          uint64_t step);

#endif
