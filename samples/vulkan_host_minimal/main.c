/* A host with a Vulkan device of its own: it hands the device to Wadi, orders both by a timeline semaphore, then has the
 * simulation recorded into its own command buffers. It draws nothing. The state must equal that of a world on the CPU. */
#include <stdio.h>
#include <stdlib.h>
#include <wadi/wadi_vulkan.h>

#define NX 64
#define NY 32
#define FRAMES 24 /* of each kind */
#define IN_FLIGHT 3

static const char* const settings = "{ \"format_version\": 1, \"name\": \"dam_break\","
                                    "  \"grid\": { \"nx\": 64, \"ny\": 32, \"dx\": 0.15625 }, \"dt\": 0.02 }";
static float water[NX * NY]; /* depth [m] */

static void check(wadi_result result, const char* what) {
    if (result == WADI_OK) return;
    fprintf(stderr, "vulkan host: %s: %s\n", what, wadi_get_last_error());
    exit(1);
}

static void check_vk(VkResult result, const char* what) {
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

/* What an engine has long made when it loads the plugin. */
static wadi_vulkan_host make_device(void) {
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
                                            .pQueueCreateInfos = &queue};
    check_vk(vkCreateDevice(host.physical_device, &device_info, NULL, &host.device), "vkCreateDevice");
    vkGetDeviceQueue(host.device, host.queue_family, 0, &host.queue);
    host.get_instance_proc_addr = vkGetInstanceProcAddr;
    host.timeline_semaphore = VK_TRUE;
    return host;
}

static wadi_world_id make_world(const char* backend, const wadi_vulkan_host* host) {
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

static uint64_t hash_of(wadi_world_id world) {
    uint64_t hash = 0;
    check(wadi_world_get_hash(world, &hash), "the state's hash");
    return hash;
}

static void wait_for(VkDevice device, VkSemaphore semaphore, uint64_t value) {
    const VkSemaphoreWaitInfo wait = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, .semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value};
    check_vk(vkWaitSemaphores(device, &wait, UINT64_MAX), "vkWaitSemaphores");
}

/* Wadi submits to the host's queue, after one point of the host's semaphore and ahead of the next. */
static uint64_t run_with_semaphores(wadi_world_id world, VkSemaphore semaphore) {
    uint64_t value = 0;
    for (int frame = 0; frame < FRAMES; ++frame) {
        const wadi_vulkan_sync before = {semaphore, value}, after = {semaphore, value + 1};
        check(wadi_vulkan_wait(world, &before, 1), "waiting for the host");
        check(wadi_world_step(world, 1), "stepping");
        check(wadi_vulkan_signal(world, &after), "signalling the host");
        ++value;
    }
    return value;
}

/* Wadi's step becomes part of the host's own command buffer. */
static uint64_t run_recorded(wadi_world_id world, const wadi_vulkan_host* host, VkSemaphore semaphore, uint64_t value) {
    VkCommandPool pool;
    const VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                               .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                               .queueFamilyIndex = host->queue_family};
    check_vk(vkCreateCommandPool(host->device, &pool_info, NULL, &pool), "vkCreateCommandPool");
    VkCommandBuffer commands[IN_FLIGHT];
    const VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = IN_FLIGHT};
    check_vk(vkAllocateCommandBuffers(host->device, &allocate, commands), "vkAllocateCommandBuffers");
    const uint64_t first = value;
    for (int frame = 0; frame < FRAMES; ++frame) {
        VkCommandBuffer mine = commands[frame % IN_FLIGHT];
        if (value >= first + IN_FLIGHT) wait_for(host->device, semaphore, value - IN_FLIGHT + 1);
        const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                                .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        check_vk(vkBeginCommandBuffer(mine, &begin), "vkBeginCommandBuffer");
        const wadi_vulkan_sync promise = {semaphore, ++value};
        check(wadi_vulkan_begin_recording(world, mine, &promise), "beginning to record");
        check(wadi_world_step(world, 1), "recording a step");
        check(wadi_vulkan_end_recording(world), "ending the record");
        /* Here an engine would draw. */
        check_vk(vkEndCommandBuffer(mine), "vkEndCommandBuffer");
        const VkTimelineSemaphoreSubmitInfo values = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                                      .signalSemaphoreValueCount = 1,
                                                      .pSignalSemaphoreValues = &value};
        const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                     .pNext = &values,
                                     .commandBufferCount = 1,
                                     .pCommandBuffers = &mine,
                                     .signalSemaphoreCount = 1,
                                     .pSignalSemaphores = &semaphore};
        check_vk(vkQueueSubmit(host->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    }
    wait_for(host->device, semaphore, value);
    vkDestroyCommandPool(host->device, pool, NULL);
    return value;
}

int main(void) {
    for (int j = 0; j < NY; ++j) {
        for (int i = 0; i < NX / 2; ++i) water[j * NX + i] = 1.0f;
    }
    const wadi_vulkan_host host = make_device();
    VkSemaphore semaphore;
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo semaphore_info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    check_vk(vkCreateSemaphore(host.device, &semaphore_info, NULL, &semaphore), "vkCreateSemaphore");

    const wadi_world_id world = make_world("vulkan", &host);
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info), "describing the world");
    printf("%s on the host's own device: %s\n", info.name, info.device_name);
    uint64_t value = run_with_semaphores(world, semaphore);
    value = run_recorded(world, &host, semaphore, value);
    const uint64_t hash = hash_of(world);
    check(wadi_destroy_world(world), "destroying the world");

    const wadi_world_id twin = make_world("cpu", NULL);
    check(wadi_world_step(twin, 2 * FRAMES), "stepping on the CPU");
    const uint64_t expected = hash_of(twin);
    check(wadi_destroy_world(twin), "destroying the world on the CPU");
    printf("%d steps between semaphores, %d in the host's command buffers: hash %016llx, on the CPU %016llx\n", FRAMES, FRAMES,
           (unsigned long long)hash, (unsigned long long)expected);

    vkDestroySemaphore(host.device, semaphore, NULL);
    vkDestroyDevice(host.device, NULL);
    vkDestroyInstance(host.instance, NULL);
    return hash == expected || !info.exact_float ? 0 : 1;
}
