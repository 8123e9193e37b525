// Worlds on a host's own Vulkan device.
#include "plugin/include/wadi/wadi_vulkan.h"
#include "plugin/src/host_sync.hpp"
#include "plugin/src/output_arguments.hpp"
#include "plugin/src/vulkan_host.hpp"

namespace wadi::plugin {
WADI_FIRST_BYTES(wadi_vulkan_host, timeline_semaphore)
WADI_FIRST_BYTES(wadi_vulkan_image, cells)
} // namespace wadi::plugin

using namespace wadi;
using namespace wadi::plugin;

Result<compute::HostDevice> wadi::plugin::to_host_device(const wadi_vulkan_host* given) {
    if (auto status = understood("vulkan_host", given); !status) return status;
    const auto own = taken(given, wadi_default_vulkan_host());
    if (own.sharing_family_count > 0 && own.sharing_families == nullptr)
        return error(Code::bad_argument, "vulkan_host: sharing_families is NULL, but sharing_family_count is " +
                                             std::to_string(own.sharing_family_count));
    compute::HostDevice device;
    device.instance = own.instance;
    device.physical_device = own.physical_device;
    device.device = own.device;
    device.queue = own.queue;
    device.get_instance_proc_addr = reinterpret_cast<void*>(own.get_instance_proc_addr);
    device.queue_family = own.queue_family;
    device.sharing_families.assign(own.sharing_families, own.sharing_families + own.sharing_family_count);
    device.timeline_semaphore = own.timeline_semaphore == VK_TRUE;
    return device;
}

namespace {

compute::SyncPoint to_point(const wadi_vulkan_sync& point) {
    return {reinterpret_cast<std::uintptr_t>(point.semaphore), point.value};
}

template <class Call> wadi_result on_host(const char* function, wadi_world_id id, const void* argument, Call call) {
    return on_host_sync(function, id, [&](compute::HostSync& sync) {
        return argument != nullptr ? call(sync) : error(Code::bad_argument, "a pointer is NULL");
    });
}

struct Named {
    std::int32_t value;
    const char* name;
};
#define WADI_NAMED(VALUE)                                                                                                        \
    Named { VALUE, #VALUE }

constexpr Named layouts[] = {WADI_NAMED(VK_IMAGE_LAYOUT_UNDEFINED), // first: only ahead of a copy
                             WADI_NAMED(VK_IMAGE_LAYOUT_GENERAL), WADI_NAMED(VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
                             WADI_NAMED(VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL), WADI_NAMED(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL)};

// `allowed` as "A (1), B (2)".
Status check_one_of(const char* field, std::int32_t given, std::span<const Named> allowed) {
    std::string list;
    for (const Named& one : allowed) {
        if (one.value == given) return ok_status();
        list += (list.empty() ? "" : ", ") + std::string(one.name) + " (" + std::to_string(one.value) + ")";
    }
    return error(Code::bad_argument, std::string("image.") + field + " is " + std::to_string(given) + "; allowed: " + list);
}

Named format_of(const OutputFormat& format) {
    if (format.component_bytes == 2) return WADI_NAMED(VK_FORMAT_R16G16B16A16_SFLOAT);
    if (format.components == 1) return WADI_NAMED(VK_FORMAT_R32_SFLOAT);
    return format.components == 2 ? WADI_NAMED(VK_FORMAT_R32G32_SFLOAT) : WADI_NAMED(VK_FORMAT_R32G32B32A32_SFLOAT);
}

// Whether `count` texels from `first` on lie within a mip level whose image has `size` of them.
Status check_room(const char* axis, const char* size_name, std::uint32_t first, int count, std::uint32_t size,
                  std::uint32_t mip_level) {
    const std::uint64_t room = std::max(mip_level < 32 ? size >> mip_level : 0u, std::min(size, 1u));
    if (std::uint64_t{first} + static_cast<std::uint64_t>(count) <= room) return ok_status();
    return error(Code::bad_argument, std::string("image.") + axis + ": " + std::to_string(count) + " cells from texel " +
                                         std::to_string(first) + " on do not fit into " + std::to_string(room) +
                                         " texels of mip level " + std::to_string(mip_level) + " (image." + size_name + " is " +
                                         std::to_string(size) + ")");
}

Status check_image(const wadi_vulkan_image& image, const OutputView& view, const Region& cells) {
    if (image.image == VK_NULL_HANDLE) return error(Code::bad_argument, "image.image is null");
    const Named format = format_of(view.format);
    if (auto status = check_one_of("format", image.format, {&format, 1}); !status) return status;
    if (auto status = check_one_of("old_layout", image.old_layout, layouts); !status) return status;
    if (auto status = check_one_of("new_layout", image.new_layout, std::span(layouts).subspan(1)); !status) return status;
    if (auto status = check_room("x", "width", image.x, cells.nx, image.width, image.mip_level); !status) return status;
    return check_room("y", "height", image.y, cells.ny, image.height, image.mip_level);
}

} // namespace

extern "C" {

wadi_result wadi_vulkan_wait(wadi_world_id id, const wadi_vulkan_sync* points, uint32_t count) {
    return on_host(__func__, id, points, [&](compute::HostSync& sync) {
        std::vector<compute::SyncPoint> all;
        for (uint32_t n = 0; n < count; ++n) all.push_back(to_point(points[n]));
        return sync.wait_before(all);
    });
}

wadi_result wadi_vulkan_signal(wadi_world_id id, const wadi_vulkan_sync* point) {
    return on_host(__func__, id, point, [&](compute::HostSync& sync) { return sync.signal_after(to_point(*point)); });
}

wadi_result wadi_vulkan_begin_recording(wadi_world_id id, VkCommandBuffer commands, const wadi_vulkan_sync* promise) {
    return on_host(__func__, id, promise,
                   [&](compute::HostSync& sync) { return sync.begin_recording(commands, to_point(*promise)); });
}

wadi_result wadi_vulkan_end_recording(wadi_world_id id) {
    return on_host(__func__, id, &id, [&](compute::HostSync& sync) { return sync.end_recording(); });
}

wadi_result wadi_vulkan_copy_output(wadi_world_id id, wadi_output output, wadi_output_set set, const wadi_vulkan_image* image) {
    constexpr const char* function = "wadi_vulkan_copy_output";
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (auto status = understood(std::string(function) + ": image", image); !status) return report(status);
        const auto own = taken(image, wadi_default_vulkan_image());
        const auto view = view_of(function, hosted, output, set);
        if (!view) return report(view.status());
        Region cells{own.cells.i0, own.cells.j0, own.cells.nx, own.cells.ny};
        if (cells.nx == 0 && cells.ny == 0) cells = {0, 0, view->nx, view->ny};
        const auto& grid = hosted.world->settings().grid;
        if (auto status = check_region(function, cells, grid, cells.cells()); !status) return report(status);
        if (auto status = named(function, check_image(own, *view, cells)); !status) return report(status);
        const compute::HostImage to{.image = reinterpret_cast<std::uintptr_t>(own.image),
                                    .old_layout = own.old_layout,
                                    .new_layout = own.new_layout,
                                    .mip_level = own.mip_level,
                                    .array_layer = own.array_layer,
                                    .x = static_cast<std::int32_t>(own.x),
                                    .y = static_cast<std::int32_t>(own.y)};
        return report(named(function, hosted.world->outputs().copy_to_image(static_cast<Output>(output),
                                                                            static_cast<OutputSet>(set), cells, to)));
    });
}

} // extern "C"
