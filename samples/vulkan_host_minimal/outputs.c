/* A host that reads an output of the simulation in place, on the GPU, every frame, ordered by one timeline semaphore:
 * wadi-vulkan-host-outputs vulkan: the world runs on the host's device; cuda: the world runs in CUDA beside it, in the
 * device's own memory. The picture that the host copies away must equal that of a world on the CPU. */
#include "host.h"
#include <stdio.h>
#include <string.h>
#include <time.h>

#define FRAMES 200
#define STEP_NANOSECONDS 20000000u

/* What the host draws into: here a buffer that it can read. */
typedef struct picture {
    VkBuffer buffer;
    VkDeviceMemory memory;
    const float* texels;
    VkCommandPool pool;
    VkCommandBuffer commands;
} picture;

static uint32_t readable_memory(const wadi_vulkan_host* host, uint32_t allowed) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(host->physical_device, &memory);
    const VkMemoryPropertyFlags needed = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    uint32_t type = 0;
    while (type + 1 < memory.memoryTypeCount &&
           ((allowed >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & needed) != needed))
        ++type;
    return type;
}

static picture make_picture(const wadi_vulkan_host* host) {
    picture made;
    const VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                            .size = NX * NY * sizeof(float),
                                            .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    check_vk(vkCreateBuffer(host->device, &buffer_info, NULL, &made.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, made.buffer, &needs);
    const VkMemoryAllocateInfo memory_info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                              .allocationSize = needs.size,
                                              .memoryTypeIndex = readable_memory(host, needs.memoryTypeBits)};
    check_vk(vkAllocateMemory(host->device, &memory_info, NULL, &made.memory), "vkAllocateMemory");
    check_vk(vkBindBufferMemory(host->device, made.buffer, made.memory, 0), "vkBindBufferMemory");
    void* texels;
    check_vk(vkMapMemory(host->device, made.memory, 0, VK_WHOLE_SIZE, 0, &texels), "vkMapMemory");
    made.texels = texels;
    const VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                               .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                               .queueFamilyIndex = host->queue_family};
    check_vk(vkCreateCommandPool(host->device, &pool_info, NULL, &made.pool), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = made.pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    check_vk(vkAllocateCommandBuffers(host->device, &allocate, &made.commands), "vkAllocateCommandBuffers");
    return made;
}

static void destroy_picture(const wadi_vulkan_host* host, const picture* old) {
    vkDestroyCommandPool(host->device, old->pool, NULL);
    vkDestroyBuffer(host->device, old->buffer, NULL);
    vkFreeMemory(host->device, old->memory, NULL);
}

/* The host's frame: after the world's point of the semaphore, ahead of the next. Where an engine would draw, this copies. */
static void draw(const wadi_vulkan_host* host, const picture* to, const wadi_output_view* view, int from_cuda,
                 VkSemaphore semaphore, uint64_t value) {
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check_vk(vkBeginCommandBuffer(to->commands, &begin), "vkBeginCommandBuffer");
    const VkBuffer from = (VkBuffer)(uintptr_t)view->handle;
    if (from_cuda) { /* what another API wrote is acquired */
        const VkBufferMemoryBarrier acquire = {.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                               .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
                                               .srcQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL,
                                               .dstQueueFamilyIndex = host->queue_family,
                                               .buffer = from,
                                               .size = VK_WHOLE_SIZE};
        vkCmdPipelineBarrier(to->commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 1,
                             &acquire, 0, NULL);
    }
    VkBufferCopy rows[NY];
    for (uint32_t j = 0; j < NY; ++j) {
        const VkBufferCopy row = {view->offset + j * view->row_pitch, j * NX * sizeof(float), NX * sizeof(float)};
        rows[j] = row;
    }
    vkCmdCopyBuffer(to->commands, from, to->buffer, NY, rows);
    check_vk(vkEndCommandBuffer(to->commands), "vkEndCommandBuffer");
    const uint64_t done = value + 1;
    const VkTimelineSemaphoreSubmitInfo values = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                                  .waitSemaphoreValueCount = 1,
                                                  .pWaitSemaphoreValues = &value,
                                                  .signalSemaphoreValueCount = 1,
                                                  .pSignalSemaphoreValues = &done};
    const VkPipelineStageFlags at = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .pNext = &values,
                                 .waitSemaphoreCount = 1,
                                 .pWaitSemaphores = &semaphore,
                                 .pWaitDstStageMask = &at,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &to->commands,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &semaphore};
    check_vk(vkQueueSubmit(host->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
}

static double now(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec * 1e6 + (double)time.tv_nsec * 1e-3;
}

/* Microseconds a frame, each of which waits for the one before: a hand-over to the world and one back. */
static double run(wadi_world_id world, const wadi_vulkan_host* host, const picture* to, int from_cuda, VkSemaphore semaphore) {
    uint64_t value = 0;
    const double start = now();
    for (int frame = 0; frame < FRAMES; ++frame, value += 2) {
        const wadi_vulkan_sync before = {semaphore, value}, after = {semaphore, value + 1};
        wadi_frame told = wadi_default_frame();
        check(wadi_vulkan_wait(world, &before, 1), "waiting for the host");
        check(wadi_world_update(world, STEP_NANOSECONDS, &told), "updating");
        check(wadi_vulkan_signal(world, &after), "signalling the host");
        wadi_output_view view = wadi_default_output_view();
        check(wadi_world_get_view(world, WADI_OUTPUT_WATER_DEPTH, WADI_OUTPUT_CURRENT, &view), "viewing the water");
        wait_for(host, semaphore, value); /* the command buffer is free again */
        draw(host, to, &view, from_cuda, semaphore, value + 1);
    }
    wait_for(host, semaphore, value);
    return (now() - start) / FRAMES;
}

int main(int argc, char** argv) {
    if (argc != 2 || (strcmp(argv[1], "vulkan") != 0 && strcmp(argv[1], "cuda") != 0)) {
        fprintf(stderr, "usage: wadi-vulkan-host-outputs vulkan|cuda\n");
        return 2;
    }
    const int cuda = strcmp(argv[1], "cuda") == 0;
    const wadi_vulkan_host host = make_device(cuda);
    const VkSemaphore semaphore = make_timeline(&host, cuda);
    const picture shown = make_picture(&host);
    const wadi_world_id world = make_world(argv[1], &host);
    wadi_world_info info = wadi_default_world_info();
    check(wadi_world_get_info(world, &info), "describing the world");
    check(wadi_world_set_outputs(world, 1u << WADI_OUTPUT_WATER_DEPTH), "asking for the water's depth");
    const double microseconds = run(world, &host, &shown, cuda, semaphore);
    const uint64_t hash = hash_of(world);
    check(wadi_destroy_world(world), "destroying the world");

    static float expected[NX * NY];
    const wadi_world_id twin = make_world("cpu", NULL);
    check(wadi_world_step(twin, FRAMES), "stepping on the CPU");
    check(wadi_world_read_field(twin, WADI_FIELD_WATER_DEPTH, expected, NX * NY), "reading the water on the CPU");
    const uint64_t expected_hash = hash_of(twin);
    check(wadi_destroy_world(twin), "destroying the world on the CPU");
    int different = 0;
    for (int n = 0; n < NX * NY; ++n) different += shown.texels[n] != expected[n];
    printf("%s beside the host on %s: %d frames, %.1f us each; %d of %d texels differ from the CPU's, hash %016llx and %016llx\n",
           argv[1], info.device_name, FRAMES, microseconds, different, NX * NY, (unsigned long long)hash,
           (unsigned long long)expected_hash);

    destroy_picture(&host, &shown);
    vkDestroySemaphore(host.device, semaphore, NULL);
    destroy_device(&host);
    return (different == 0 && hash == expected_hash) || !info.exact_float ? 0 : 1;
}
