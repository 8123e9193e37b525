#include "shared_device.h"

#include "engine/engine.h"
#include "vulkan_calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct SharedImage {
    VkImage image;
    VkDeviceMemory memory;
    uint64_t rid; /* the engine's texture of it */
    bool shown;   /* the engine looks at it, since it has a content */
} SharedImage;

struct SharedDevice {
    Object rendering_device;
    wadi_vulkan_host host;
    VulkanCalls calls;
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
    if (device->calls.QueueWaitIdle) device->calls.QueueWaitIdle(device->host.queue);
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        SharedImage* image = &device->images[output];
        if (textures && textures->objects[output]) set_rid(textures->objects[output], 0);
        const GDExtensionConstTypePtr arguments[] = {&image->rid};
        if (image->rid) engine_call(ENGINE_RenderingDevice_free_rid, device->rendering_device, arguments, NULL);
        if (image->image) device->calls.DestroyImage(vulkan, image->image, NULL);
        if (image->memory) device->calls.FreeMemory(vulkan, image->memory, NULL);
    }
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
    const GDExtensionConstTypePtr arguments[] = {&type_2d, &format, &one_sample, &sampling, &image, &width, &height, &one, &one};
    engine_call(ENGINE_RenderingDevice_texture_create_from_extension, rendering_device, arguments, &rid);
    return rid;
}

static void make_image(SharedDevice* device, SharedImage* image, const wadi_output_view* view, Object* texture) {
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
    if (device->calls.CreateImage(device->host.device, &info, NULL, &image->image) != VK_SUCCESS) return;
    if (!allocate(device, image)) return;
    image->rid = import(device->rendering_device, image->image, info.format, view);
    if (!image->rid) return;
    const Object object = construct("Texture2DRD");
    api.ref_set_object(texture, object);
}

/* Behind what reads the image so far, ahead of what reads it from now on: both on the renderer's queue. */
static bool copy(wadi_world_id world, wadi_output output, const SharedImage* image, const wadi_output_view* view) {
    wadi_vulkan_image to = wadi_default_vulkan_image();
    to.image = image->image;
    to.format = format_of(view->format);
    to.width = (uint32_t)view->nx;
    to.height = (uint32_t)view->ny;
    return wadi_vulkan_copy_output(world, output, WADI_OUTPUT_CURRENT, &to) == WADI_OK;
}

bool textures_update_shared(Textures* textures, wadi_world_id world, wadi_output_mask mask, uint64_t step) {
    SharedDevice* device = textures->shared;
    bool all = true;
    for (int output = 0; output < WADI_OUTPUT_COUNT; ++output) {
        if (!(mask & WADI_OUTPUT_BIT(output))) continue;
        SharedImage* image = &device->images[output];
        wadi_output_view view = wadi_default_output_view();
        const bool there = wadi_world_get_view(world, (wadi_output)output, WADI_OUTPUT_CURRENT, &view) == WADI_OK;
        if (there && !image->image) make_image(device, image, &view, &textures->objects[output]);
        if (!there || !image->rid || !copy(world, (wadi_output)output, image, &view)) {
            all = false;
            continue;
        }
        if (!image->shown) set_rid(textures->objects[output], image->rid);
        image->shown = true;
        textures->steps[output] = view.step;
        all = all && view.step == step;
    }
    return all;
}
