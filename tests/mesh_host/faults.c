/* Stands between wadi-mesh-host and Vulkan's loader (LD_PRELOAD) and does harm, so that the host's tests are seen to fail. WADI_FAULT:
 * leak  64 KiB of every submission are lost;      lost  the third submission loses the device;
 * layouts  no image is brought into its layout. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan_core.h>

static int is(const char* fault) {
    const char* chosen = getenv("WADI_FAULT");
    return chosen != NULL && strcmp(chosen, fault) == 0;
}

VkResult vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
    static char* volatile lost;
    static int calls = 0;
    static PFN_vkQueueSubmit real = NULL;
    if (real == NULL) *(void**)&real = dlsym(RTLD_NEXT, "vkQueueSubmit");
    ++calls;
    if (is("leak") && (lost = malloc(65536)) != NULL) memset(lost, calls, 65536);
    return is("lost") && calls == 3 ? VK_ERROR_DEVICE_LOST : real(queue, count, infos, fence);
}

void vkCmdPipelineBarrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkPipelineStageFlags to, VkDependencyFlags flags,
                          uint32_t memory_count, const VkMemoryBarrier* memory, uint32_t buffer_count, const VkBufferMemoryBarrier* buffers,
                          uint32_t image_count, const VkImageMemoryBarrier* images) {
    static PFN_vkCmdPipelineBarrier real = NULL;
    if (real == NULL) *(void**)&real = dlsym(RTLD_NEXT, "vkCmdPipelineBarrier");
    real(commands, from, to, flags, memory_count, memory, buffer_count, buffers, is("layouts") ? 0 : image_count, images);
}
