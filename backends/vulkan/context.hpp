// What every component of the backend shares: the logical device, its queue and limits, and how results become Status.
#pragma once
#include "backends/vulkan/instance.hpp"
#include "engine/compute/device.hpp"
#include <memory>
#include <string_view>

namespace wadi::vulkan {

/// Numbers of the physical device that the backend respects.
struct Limits {
    std::uint32_t api_version = 0;
    std::uint32_t group_count[2] = {};
    std::uint32_t storage_buffers = 0; // of one stage
    double timestamp_nanoseconds = 0;  // of one tick
    std::uint64_t timestamp_mask = 0;  // valid bits; 0 = no timestamps
};

struct Context {
    /// Errors: not_found (no such device), not_supported, out_of_memory, internal.
    static Result<std::unique_ptr<Context>> open(int index, const compute::DeviceOptions& options);
    Context() = default;
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Turns a result into a Status: "what of 'label': VK_ERROR_...". A lost device is remembered for ever.
    Status check(VkResult result, std::string_view what, std::string_view label = {});
    Status lost_status() const;
    /// Waits until the queue has nothing left to do; a lost device counts as done. Where that fails for want of memory nothing of
    /// this device is destroyed from here on.
    void wait_idle();
    void leave_all();

    std::unique_ptr<Instance> instance;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    std::vector<std::uint32_t> sharing_families; // of buffers; empty = only queue_family
    VolkDeviceTable vk{};
    VkPhysicalDeviceMemoryProperties memory{};
    Limits limits;
    bool timeline = false;           // VK_KHR_timeline_semaphore is there and on
    bool float_modes = false;        // modules may ask for SignedZeroInfNanPreserve
    bool corrected_division = false; // chosen by the self-test
    bool lost = false;
    bool left = false; // by leave_all()
    compute::DeviceOptions options;
    compute::Capabilities capabilities;
    compute::Tuning tuning;
    compute::DeviceCounters counters;
};

} // namespace wadi::vulkan
