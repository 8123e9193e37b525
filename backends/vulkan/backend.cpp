#include "backends/vulkan/backend.hpp"
#include "backends/vulkan/device.hpp"
#include "backends/vulkan/instance.hpp"
#include "backends/vulkan/lender.hpp"

namespace wadi::vulkan {
namespace {

std::vector<backends::DeviceInfo> enumerate(std::string& why_none) {
    auto instance = Instance::create({});
    if (!instance) {
        why_none = instance.status().message;
        return {};
    }
    std::vector<backends::DeviceInfo> list;
    for (PhysicalDevice& device : (*instance)->devices(why_none)) list.push_back(std::move(device.info));
    return list;
}

} // namespace

const backends::Backend& vulkan_backend() {
    static const backends::Backend backend{"vulkan", enumerate, open_device, lend};
    return backend;
}

} // namespace wadi::vulkan
