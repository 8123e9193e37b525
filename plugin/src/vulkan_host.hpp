// The host's Vulkan device as the engine takes it. Defined by wadi_vulkan.cpp, where the build has Vulkan.
#pragma once
#include "engine/compute/device.hpp"

struct wadi_vulkan_host;

namespace wadi::plugin {

/// Errors: bad_argument (struct_size, a null list).
Result<compute::HostDevice> to_host_device(const wadi_vulkan_host* host);

} // namespace wadi::plugin
