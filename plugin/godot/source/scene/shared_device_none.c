/* In place of shared_device.c and vulkan_calls.c where libwadi was built without Vulkan: textures go through host memory. */
#include "shared_device.h"

#include <stdio.h>

SharedDevice* shared_open(char* why, size_t size) {
    snprintf(why, size, "libwadi was built without Vulkan");
    return NULL;
}

/* There is no device that these could be called with. */
const wadi_vulkan_host* shared_host(const SharedDevice* device) {
    (void)device;
    return NULL;
}
void shared_close(SharedDevice* device, Textures* textures) {
    (void)device;
    (void)textures;
}
bool textures_update_shared(Textures* textures, wadi_world_id world, wadi_output_mask mask, uint64_t step) {
    (void)textures;
    (void)world;
    (void)mask;
    (void)step;
    return false;
}
