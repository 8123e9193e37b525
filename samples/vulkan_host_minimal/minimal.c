/* A host with a Vulkan device of its own: it hands the device to Wadi, orders both by a timeline semaphore, then has the
 * simulation recorded into its own command buffers. It draws nothing. The state must equal that of a world on the CPU. */
#include "host.h"
#include <stdio.h>

#define FRAMES 24 /* of each kind */
#define IN_FLIGHT 3

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
        if (value >= first + IN_FLIGHT) wait_for(host, semaphore, value - IN_FLIGHT + 1);
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
    wait_for(host, semaphore, value);
    vkDestroyCommandPool(host->device, pool, NULL);
    return value;
}

int main(void) {
    const wadi_vulkan_host host = make_device(0);
    const VkSemaphore semaphore = make_timeline(&host, 0);

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
    destroy_device(&host);
    return hash == expected || !info.exact_float ? 0 : 1;
}
