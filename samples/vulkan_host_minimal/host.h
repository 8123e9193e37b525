/* What an engine has long made when it loads the plugin: an instance, a device, a queue, a timeline semaphore. */
#ifndef HOST_H
#define HOST_H
#include <wadi/wadi_vulkan.h>

#define NX 64
#define NY 32
/* A world's dam-break level on this grid. */
extern const char* const settings;

/* Print what failed and exit. */
void check(wadi_result result, const char* what);
void check_vk(VkResult result, const char* what);

/* With what CUDA needs to work beside the device, or without. Exits with 77 where there is no such device. */
wadi_vulkan_host make_device(int for_cuda);
void destroy_device(const wadi_vulkan_host* host);
VkSemaphore make_timeline(const wadi_vulkan_host* host, int for_cuda);
void wait_for(const wadi_vulkan_host* host, VkSemaphore semaphore, uint64_t value);

/* A dam of 1 m of water in the west half; `host` may be NULL. */
wadi_world_id make_world(const char* backend, const wadi_vulkan_host* host);
uint64_t hash_of(wadi_world_id world);
#endif
