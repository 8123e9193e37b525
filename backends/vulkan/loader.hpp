// The system's Vulkan loader, found at run time so that a machine without Vulkan can load the plugin.
#pragma once
#include "backends/vulkan/api.hpp"
#include <string>

namespace wadi::vulkan {

/// The loader's entry point, opened on first use and never closed, because drivers do not survive unloading. It goes through
/// volk's globals: one thread at a time. Null, with the reason in `why`, when there is none.
PFN_vkGetInstanceProcAddr loader_entry(std::string& why);

} // namespace wadi::vulkan
