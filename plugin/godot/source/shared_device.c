#include "shared_device.h"

#include "engine.h"
#include "vulkan_calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 3 }; /* submissions of copies that may be under way */

typedef struct SharedImage {
    VkImage image;
    VkDeviceMemory memory;
    uint64_t rid; /* the engine's texture of it */
    bool written;
} SharedImage;

struct SharedDevice {
    Object rendering_device;
    wadi_vulkan_host host;
    VulkanCalls calls;
    VkCommandPool pool;
    VkCommandBuffer commands[SLOTS];
    VkFence fences[SLOTS];
    bool submitted[SLOTS];
    int slot;
    SharedImage images[WADI_OUTPUT_COUNT];
};

/* RenderingDevice.DriverResource */
enum { LOGICAL_DEVICE = 0, PHYSICAL_DEVICE = 1, TOPMOST_OBJECT = 2, COMMAND_QUEUE = 3, QUEUE_FAMILY = 4 };

static uint64_t resource(Object rendering_device, int64_t which) {
    const uint64_t no_rid = 0;
    const int64_t index = 0;
    uint64_t value = 0;
    const GDExtensionConstTypePtr arguments[] = {&which, &no_rid, &index};
    engine_call(ENGINE_RenderingDevice_get_driver_resource, rendering_device, arguments, &value);
    return value;
}

static void* handle(Object rendering_device, int64_t which) { return (void*)(uintptr_t)resource(rendering_device, which); }

static bool is_vulkan(void) {
    String name = string_of("");
    engine_call(ENGINE_RenderingServer_get_current_rendering_driver_name, singleton("RenderingServer"), NULL, &name);
    char* text = string_text(&name);
    const bool vulkan = text && strcmp(text, "vulkan") == 0;
    free(text);
    value_free(GDEXTENSION_VARIANT_TYPE_STRING, &name);
    return vulkan;
}

static VkResult make_commands(SharedDevice* device) {
    const VkDevice vulkan = device->host.device;
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = device->host.queue_family};
    VkResult result = device->calls.CreateCommandPool(vulkan, &pool, NULL, &device->pool);
    if (result != VK_SUCCESS) return result;
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = device->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = SLOTS};
    result = device->calls.AllocateCommandBuffers(vulkan, &commands, device->commands);
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    for (int n = 0; n < SLOTS && result == VK_SUCCESS; ++n)
        result = device->calls.CreateFence(vulkan, &fence, NULL, &device->fences[n]);
    return result;
}

SharedDevice* shared_open(char* why, size_t size) {
    const Object server = singleton("RenderingServer");
    Object rendering_device = NULL;
    uint8_t on_render_thread = 0;
    engine_call(ENGINE_RenderingServer_get_rendering_device, server, NULL, &rendering_device);
    engine_call(ENGINE_RenderingServer_is_on_render_thread, server, NULL, &on_render_thread);
    if (!rendering_device)
        snprintf(why, size, "this renderer has no RenderingDevice (headless or Compatibility)");
    else if (!is_vulkan())
        snprintf(why, size, "this renderer does not use Vulkan");
    else if (!on_render_thread)
        snprintf(why, size,
                 "rendering has a thread of its own (rendering/driver/threads/thread_model), which alone may use the queue");
    else
        *why = 0;
    if (*why) return NULL;

    SharedDevice* device = calloc(1, sizeof *device);
    if (!device) {
        snprintf(why, size, "no memory");
        return NULL;
    }
    device->rendering_device = rendering_device;
    device->host = wadi_default_vulkan_host();
    device->host.instance = handle(rendering_device, TOPMOST_OBJECT);
    device->host.physical_device = handle(rendering_device, PHYSICAL_DEVICE);
    device->host.device = handle(rendering_device, LOGICAL_DEVICE);
    device->host.queue = handle(rendering_device, COMMAND_QUEUE);
    device->host.queue_family = (uint32_t)resource(rendering_device, QUEUE_FAMILY);
    if (!vulkan_load(&device->calls, device->host.instance, device->host.device))
        snprintf(why, size, "Vulkan's loader is not found");
    else if (make_commands(device) != VK_SUCCESS)
        snprintf(why, size, "the device makes no command buffers");
    device->host.get_instance_proc_addr = device->calls.GetInstanceProcAddr;
    if (*why) {
        shared_close(device, NULL);
        return NULL;
    }
    return device;
}

const wadi_vulkan_host* shared_host(const SharedDevice* device) { return &device->host; }

static void set_rid(Object texture, uint64_t rid) {
    const GDExtensionConstTypePtr arguments[] = {&rid};
    engine_call(ENGINE_Texture2DRD_set_texture_rd_rid, texture, arguments, NULL);
}

void shared_close(SharedDevice* device, Textures* textures) {
    const VkDevice vulkan = device->host.device;
    if (device->pool) device->calls.QueueWaitIdle(device->host.queue);
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        SharedImage* image = &device->images[output];
        if (textures && textures->objects[output]) set_rid(textures->objects[output], 0);
        const GDExtensionConstTypePtr arguments[] = {&image->rid};
        if (image->rid) engine_call(ENGINE_RenderingDevice_free_rid, device->rendering_device, arguments, NULL);
        if (image->image) device->calls.DestroyImage(vulkan, image->image, NULL);
        if (image->memory) device->calls.FreeMemory(vulkan, image->memory, NULL);
    }
    for (int n = 0; n < SLOTS; ++n) {
        if (device->fences[n]) device->calls.DestroyFence(vulkan, device->fences[n], NULL);
    }
    if (device->pool) device->calls.DestroyCommandPool(vulkan, device->pool, NULL);
    free(device);
}

static VkFormat format_of(wadi_format format) {
    switch (format) {
    case WADI_FORMAT_R32_FLOAT:
        return VK_FORMAT_R32_SFLOAT;
    case WADI_FORMAT_R32G32_FLOAT:
        return VK_FORMAT_R32G32_SFLOAT;
    case WADI_FORMAT_R32G32B32A32_FLOAT:
        return VK_FORMAT_R32G32B32A32_SFLOAT;
    case WADI_FORMAT_R16G16B16A16_FLOAT:
        return VK_FORMAT_R16G16B16A16_SFLOAT;
    }
    return VK_FORMAT_UNDEFINED;
}

static bool allocate(SharedDevice* device, SharedImage* image) {
    VkMemoryRequirements needs;
    VkPhysicalDeviceMemoryProperties memory;
    device->calls.GetImageMemoryRequirements(device->host.device, image->image, &needs);
    device->calls.GetPhysicalDeviceMemoryProperties(device->host.physical_device, &memory);
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
        if (!(needs.memoryTypeBits & (1u << type))) continue;
        if (!(memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)) continue;
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
        if (device->calls.AllocateMemory(device->host.device, &info, NULL, &image->memory) != VK_SUCCESS) return false;
        return device->calls.BindImageMemory(device->host.device, image->image, image->memory, 0) == VK_SUCCESS;
    }
    return false;
}

/* The engine's texture of an image, sampled only: it then neither writes it nor changes its layout. */
static uint64_t import(Object rendering_device, VkImage vulkan_image, VkFormat vulkan_format, const wadi_output_view* view) {
    const int64_t type_2d = 1, one_sample = 0, sampling = 1, one = 1;
    const int64_t format = (int64_t)vulkan_format - 1; /* DataFormat has no UNDEFINED ahead, else Vulkan's order */
    const int64_t width = view->nx, height = view->ny;
    const uint64_t image = (uint64_t)(uintptr_t)vulkan_image;
    uint64_t rid = 0;
    const GDExtensionConstTypePtr arguments[] = {&type_2d, &format, &one_sample, &sampling, &image,
                                                 &width,   &height, &one,        &one,      &one};
    engine_call(ENGINE_RenderingDevice_texture_create_from_extension, rendering_device, arguments, &rid);
    return rid;
}

static bool make_image(SharedDevice* device, SharedImage* image, const wadi_output_view* view, Object* texture) {
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = format_of(view->format),
        .extent = {(uint32_t)view->nx, (uint32_t)view->ny, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    if (device->calls.CreateImage(device->host.device, &info, NULL, &image->image) != VK_SUCCESS) return false;
    if (!allocate(device, image)) return false;
    image->rid = import(device->rendering_device, image->image, info.format, view);
    if (!image->rid) return false;
    const Object object = construct("Texture2DRD");
    api.ref_set_object(texture, object);
    return true;
}

/* Ahead of a copy: what read the image and what wrote the buffer is done; after it: shaders see the image, and the buffer may be
 * written again. */
static void barrier(SharedDevice* device, VkCommandBuffer commands, SharedImage* image, bool ahead) {
    const VkImageMemoryBarrier images = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = ahead ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = ahead ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = ahead ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .newLayout = ahead ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    device->calls.CmdPipelineBarrier(commands, ahead ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
                                     ahead ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                                     ahead ? 1 : 0, &memory, 0, NULL, 1, &images);
}

static void copy(SharedDevice* device, VkCommandBuffer commands, SharedImage* image, const wadi_output_view* view, size_t texel) {
    const VkBufferImageCopy region = {.bufferOffset = view->offset,
                                      .bufferRowLength = (uint32_t)(view->row_pitch / texel),
                                      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {(uint32_t)view->nx, (uint32_t)view->ny, 1}};
    barrier(device, commands, image, true);
    device->calls.CmdCopyBufferToImage(commands, (VkBuffer)(uintptr_t)view->handle, image->image,
                                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    barrier(device, commands, image, false);
    image->written = true;
}

/* The next command buffer, begun; waits for the copies that were recorded into it three updates ago. */
static VkCommandBuffer begin(SharedDevice* device) {
    device->slot = (device->slot + 1) % SLOTS;
    const int slot = device->slot;
    if (device->submitted[slot]) {
        device->calls.WaitForFences(device->host.device, 1, &device->fences[slot], VK_TRUE, UINT64_MAX);
        device->calls.ResetFences(device->host.device, 1, &device->fences[slot]);
        device->submitted[slot] = false;
    }
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    device->calls.BeginCommandBuffer(device->commands[slot], &info);
    return device->commands[slot];
}

static bool submit(SharedDevice* device) {
    const int slot = device->slot;
    device->calls.EndCommandBuffer(device->commands[slot]);
    const VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &device->commands[slot]};
    device->submitted[slot] = device->calls.QueueSubmit(device->host.queue, 1, &info, device->fences[slot]) == VK_SUCCESS;
    return device->submitted[slot];
}

bool textures_update_shared(Textures* textures, wadi_world_id world, wadi_output_mask mask, uint64_t step) {
    SharedDevice* device = textures->shared;
    if (!mask) return true;
    const VkCommandBuffer commands = begin(device);
    bool all = true, fresh[WADI_OUTPUT_COUNT] = {false};
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        if (!(mask & WADI_OUTPUT_BIT(output))) continue;
        SharedImage* image = &device->images[output];
        wadi_output_view view = wadi_default_output_view();
        const bool there = wadi_world_get_view(world, (wadi_output)output, WADI_OUTPUT_CURRENT, &view) == WADI_OK &&
                           view.handle_kind == WADI_HANDLE_VULKAN_BUFFER;
        if (there && !image->image) fresh[output] = make_image(device, image, &view, &textures->objects[output]);
        if (!there || !image->rid) {
            all = false;
            continue;
        }
        copy(device, commands, image, &view, texel_format((wadi_output)output).bytes);
        textures->steps[output] = view.step;
        all = all && view.step == step;
    }
    if (!submit(device)) return false;
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) { /* the engine looks at an image that has a content */
        if (fresh[output]) set_rid(textures->objects[output], device->images[output].rid);
    }
    return all;
}
