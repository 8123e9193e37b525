#include "backends/vulkan/backend.hpp"
#include "backends/vulkan/device.hpp"
#include "backends/vulkan/instance.hpp"
#include "backends/vulkan/lender.hpp"
#include <new>

namespace wadi::vulkan {
namespace {

std::vector<backends::DeviceInfo> enumerate(std::string& why_none) {
    try {
        auto instance = Instance::create({});
        if (!instance) {
            why_none = instance.status().message;
            return {};
        }
        std::vector<backends::DeviceInfo> list;
        for (PhysicalDevice& device : (*instance)->devices(why_none)) list.push_back(std::move(device.info));
        return list;
    } catch (const std::bad_alloc&) {
        why_none = "out of memory"; // short enough to need none
        return {};
    }
}

} // namespace

const backends::Backend& vulkan_backend() {
    static const backends::Backend backend{"vulkan", enumerate, open_device, lend};
    return backend;
}

} // namespace wadi::vulkan
