/* The renderer's own Vulkan device: Wadi runs on it, and outputs become textures without a copy through host memory. */
#ifndef WADI_GODOT_SHARED_DEVICE_H
#define WADI_GODOT_SHARED_DEVICE_H

#include "textures.h"

#include <wadi/wadi_vulkan.h>

/** The renderer's device, or NULL and a reason in `why`: no RenderingDevice (headless, Compatibility), not Vulkan, or a rendering
 * thread of its own, from which alone its queue may be used. shared_close it. */
SharedDevice* shared_open(char* why, size_t size);
/** For wadi_device_options. */
const wadi_vulkan_host* shared_host(const SharedDevice* device);
/** Waits until nothing uses the images, and frees them and the device's own objects. Ahead of wadi_destroy_world. */
void shared_close(SharedDevice* device, Textures* textures);
/** Queues copies of the newest publish into the images of `mask`; makes those that are missing. true: all show step `step`. */
bool textures_update_shared(Textures* textures, wadi_world_id world, wadi_output_mask mask, uint64_t step);

#endif
