// The Vulkan declarations that this backend uses, without prototypes: device calls go through volk's device table and
// instance calls through InstanceApi, never through volk's global pointers, which a host of ours may own as well.
#pragma once
#include <cstdint>
#include <string_view>
#include <volk.h>

namespace wadi::vulkan {

/// The oldest Vulkan that this backend runs on.
inline constexpr std::uint32_t required_version = VK_API_VERSION_1_1;

/// A Vulkan structure with its type set and everything else zero.
template <class T> T vk_struct(VkStructureType type) {
    T value{};
    value.sType = type;
    return value;
}

/// The name of a result as the Vulkan specification writes it.
std::string_view result_name(VkResult result);

} // namespace wadi::vulkan
