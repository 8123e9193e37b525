#include "host.h"
#include <stdio.h>
#include <stdlib.h>

const char* const settings = "{ \"format_version\": 1, \"name\": \"dam_break\","
                             "  \"grid\": { \"nx\": 64, \"ny\": 32, \"dx\": 0.15625 }, \"dt\": 0.02 }";

void check(wadi_result result, const char* what) {
    if (result == WADI_OK) return;
    fprintf(stderr, "vulkan host: %s: %s\n", what, wadi_get_last_error());
    exit(1);
}

void check_vk(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "vulkan host: %s: VkResult %d\n", what, (int)result);
    exit(1);
}

static uint32_t compute_family(VkPhysicalDevice physical) {
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t n = 0; n < count; ++n) {
        if ((families[n].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) return n;
    }
    fprintf(stderr, "vulkan host: no queue family with compute\n");
    exit(1);
}

static const char* const for_cuda_extensions[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME,
                                                  VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};

wadi_vulkan_host make_device(int for_cuda) {
    wadi_vulkan_host host = wadi_default_vulkan_host();
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo instance_info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                                .pApplicationInfo = &application};
    check_vk(vkCreateInstance(&instance_info, NULL, &host.instance), "vkCreateInstance");
    uint32_t count = 1;
    const VkResult listed = vkEnumeratePhysicalDevices(host.instance, &count, &host.physical_device);
    if (count == 0 || listed < VK_SUCCESS) {
        printf("no Vulkan device here: nothing to show\n");
        exit(77);
    }
    host.queue_family = compute_family(host.physical_device);
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = host.queue_family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkPhysicalDeviceTimelineSemaphoreFeatures timeline = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, .timelineSemaphore = VK_TRUE};
    const VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                            .pNext = &timeline,
                                            .queueCreateInfoCount = 1,
                                            .pQueueCreateInfos = &queue,
                                            .enabledExtensionCount = for_cuda ? 2 : 0,
                                            .ppEnabledExtensionNames = for_cuda_extensions};
    const VkResult made = vkCreateDevice(host.physical_device, &device_info, NULL, &host.device);
    if (made == VK_ERROR_EXTENSION_NOT_PRESENT) {
        printf("the Vulkan device shares nothing with CUDA: nothing to show\n");
        exit(77);
    }
    check_vk(made, "vkCreateDevice");
    vkGetDeviceQueue(host.device, host.queue_family, 0, &host.queue);
    host.get_instance_proc_addr = vkGetInstanceProcAddr;
    host.timeline_semaphore = VK_TRUE;
    return host;
}

void destroy_device(const wadi_vulkan_host* host) {
    vkDestroyDevice(host->device, NULL);
    vkDestroyInstance(host->instance, NULL);
}

VkSemaphore make_timeline(const wadi_vulkan_host* host, int for_cuda) {
    const VkExportSemaphoreCreateInfo exported = {.sType = VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO,
                                                  .handleTypes = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .pNext = for_cuda ? &exported : NULL,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    VkSemaphore semaphore;
    check_vk(vkCreateSemaphore(host->device, &info, NULL, &semaphore), "vkCreateSemaphore");
    return semaphore;
}

wadi_world_id make_world(const char* backend, const wadi_vulkan_host* host) {
    static float water[NX * NY]; /* depth [m] */
    for (int j = 0; j < NY; ++j) {
        for (int i = 0; i < NX / 2; ++i) water[j * NX + i] = 1.0f;
    }
    wadi_world_arrays arrays = wadi_default_world_arrays();
    arrays.settings_json = settings;
    arrays.nx = NX;
    arrays.ny = NY;
    arrays.water = water;
    wadi_device_options options = wadi_default_device_options();
    options.backend = backend;
    options.vulkan_host = host;
    wadi_world_id world;
    check(wadi_create_world_from_arrays(&arrays, &options, &world), "creating the world");
    return world;
}

uint64_t hash_of(wadi_world_id world) {
    uint64_t hash = 0;
    check(wadi_world_get_hash(world, &hash), "the state's hash");
    return hash;
}

void wait_for(const wadi_vulkan_host* host, VkSemaphore semaphore, uint64_t value) {
    const VkSemaphoreWaitInfo wait = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, .semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value};
    check_vk(vkWaitSemaphores(host->device, &wait, UINT64_MAX), "vkWaitSemaphores");
}
