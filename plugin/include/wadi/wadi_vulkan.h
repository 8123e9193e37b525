/* Wadi on a host's own VkDevice: shared buffers, no copies, no stalls. The only header that names Vulkan's types; C99.
 * A world made with wadi_device_options.vulkan_host creates buffers, pipelines and command pools on that device and destroys
 * them with the world; it never creates or destroys an instance, a device or a queue.
 *
 * Three ways to order the world's work and the host's:
 *  - one thread, one queue: the world submits to the queue given here; what the host submits later sees the results after a
 *    barrier of its own;
 *  - timeline semaphores: wadi_vulkan_wait() ahead of the next submission, wadi_vulkan_signal() behind the last;
 *  - recording: between wadi_vulkan_begin_recording() and wadi_vulkan_end_recording() the world's work goes into the host's
 *    command buffer instead of the queue.
 * With the backend "cuda" the world runs in CUDA on the same GPU, beside the device: only the outputs' buffers are made there, in
 * memory that both share, and the timeline semaphores order the two. The device must have VK_KHR_external_memory_fd and
 * VK_KHR_external_semaphore_fd, the semaphores VkExportSemaphoreCreateInfo with VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT; they
 * must outlive the world. There is no recording.
 */
#ifndef WADI_VULKAN_H
#define WADI_VULKAN_H

#include <vulkan/vulkan_core.h>
#include <wadi/wadi.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The host's device. Everything must outlive the world. Vulkan 1.1 or later. */
typedef struct wadi_vulkan_host {
    uint32_t struct_size;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    uint32_t queue_family;             /* with compute */
    VkQueue queue;                     /* of that family; the world uses it inside calls only: no other thread may meanwhile */
    const uint32_t* sharing_families;  /* other families whose commands touch the world's buffers (made CONCURRENT); may be NULL */
    uint32_t sharing_family_count;
    VkBool32 timeline_semaphore;       /* the feature timelineSemaphore is enabled (Vulkan 1.2 or VK_KHR_timeline_semaphore) */
} wadi_vulkan_host;
static inline wadi_vulkan_host wadi_default_vulkan_host(void) {
    WADI_ZERO_STRUCT(wadi_vulkan_host);
    return value;
}

/** A point on a timeline semaphore of the host. */
typedef struct wadi_vulkan_sync {
    VkSemaphore semaphore;
    uint64_t value;
} wadi_vulkan_sync;

/** The world's next submission waits on the device for these points. Does not wait itself.
 *  Errors: BAD_ARGUMENT (a null semaphore), NOT_SUPPORTED (no timeline semaphores, the world knows no Vulkan host, or CUDA cannot take
 *  the semaphore). */
WADI_API wadi_result wadi_vulkan_wait(wadi_world_id world, const wadi_vulkan_sync* points, uint32_t count);
/** Signals a point once everything the world submitted so far is done. Errors: as wadi_vulkan_wait, and NOT_READY while recorded
 *  work has not run. */
WADI_API wadi_result wadi_vulkan_signal(wadi_world_id world, const wadi_vulkan_sync* point);

/** From here on what the world's calls would submit is recorded into `commands`: in the recording state, primary, of the host's
 *  queue_family, outside a render pass. The host promises to submit it to `queue`, in the order of recording, with a signal of
 *  `promise`; until that point is reached calls that need the device at once (reading a field, statistics, saving, stepping
 *  outside a recording) answer NOT_READY, and at most 32 submissions can be recorded ahead.
 *  Errors: BAD_ARGUMENT (null handles, a recording under way), NOT_SUPPORTED. */
WADI_API wadi_result wadi_vulkan_begin_recording(wadi_world_id world, VkCommandBuffer commands, const wadi_vulkan_sync* promise);
/** Ends it with a barrier behind which the host's compute and transfer commands see the results; other stages need the host's own. */
WADI_API wadi_result wadi_vulkan_end_recording(wadi_world_id world);

#ifdef __cplusplus
}
#endif
#endif
