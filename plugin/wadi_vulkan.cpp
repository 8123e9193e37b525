// Worlds on a host's own Vulkan device.
#include "plugin/include/wadi/wadi_vulkan.h"
#include "plugin/abi.hpp"
#include "plugin/vulkan_host.hpp"

namespace wadi::plugin {
WADI_FIRST_BYTES(wadi_vulkan_host, timeline_semaphore)
}

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

// Calls the device of a world that runs on a Vulkan host.
template <class Call> wadi_result on_host(const char* function, wadi_world_id id, const void* argument, Call call) {
    return with_world(function, id, [&](HostedWorld& hosted) {
        if (argument == nullptr) return bad_argument(std::string(function) + ": a pointer is NULL");
        Status status = call(*hosted.world->device().host_sync()); // the registry's devices are the front end's: never null
        if (!status) status.message = std::string(function) + ": " + status.message;
        return report(status);
    });
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

} // extern "C"
