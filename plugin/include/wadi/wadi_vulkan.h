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

/** Where an output goes in an image of the host's: 2D or an array of them, colour, one sample, made with
 *  VK_IMAGE_USAGE_TRANSFER_DST_BIT, CONCURRENT or owned by queue_family. It must be there until the copy is done. */
typedef struct wadi_vulkan_image {
    uint32_t struct_size;
    VkImage image;
    VkFormat format;           /* of the image, which must be the output's: VK_FORMAT_R32_SFLOAT, _R32G32_SFLOAT, _R32G32B32A32_SFLOAT or
                                  _R16G16B16A16_SFLOAT, as wadi_output_view.format has it */
    uint32_t width, height;    /* of mip level 0 [texels] */
    uint32_t mip_level, array_layer; /* the one that is written; the others keep layout and contents */
    VkImageLayout old_layout;  /* its layout ahead of the copy: UNDEFINED (default; texels that are not written are lost), GENERAL,
                                  SHADER_READ_ONLY_OPTIMAL, TRANSFER_SRC_OPTIMAL or TRANSFER_DST_OPTIMAL */
    VkImageLayout new_layout;  /* and behind it: one of the same but UNDEFINED; default SHADER_READ_ONLY_OPTIMAL */
    uint32_t x, y;             /* texel of the first cell; the next row north has the next y */
    wadi_region cells;         /* those that are copied; nx = ny = 0: all */
} wadi_vulkan_image;
static inline wadi_vulkan_image wadi_default_vulkan_image(void) {
    WADI_ZERO_STRUCT(wadi_vulkan_image);
    value.new_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return value;
}
/** Copies an output (what wadi_world_get_view gives) into an image, a cell to a texel, in a submission of its own: behind all that the
 *  world and the host gave to `queue` so far and points of wadi_vulkan_wait, ahead of wadi_vulkan_signal, or into the host's command
 *  buffer between wadi_vulkan_begin_recording and _end_recording. What comes behind it on the queue, or in that command buffer, sees the
 *  texels in new_layout without a barrier of its own.
 *  Waits: while the device's queue is full (32 submissions).
 *  Errors, nothing copied: BAD_ARGUMENT (a field of the image, cells outside the grid: the message says what is allowed; no such output
 *  or set, not asked for), NOT_READY (not published yet; 32 recorded submissions are ahead, or recorded work would be overtaken),
 *  NOT_SUPPORTED (the world runs on no Vulkan device of a host; with CUDA beside it, copy from the view's buffer behind
 *  wadi_vulkan_signal). */
WADI_API wadi_result wadi_vulkan_copy_output(wadi_world_id world, wadi_output output, wadi_output_set set,
                                             const wadi_vulkan_image* image);

#ifdef __cplusplus
}
#endif
#endif
