// The Vulkan backend: any GPU, integrated or discrete, and the software GPU lavapipe.
#pragma once
#include "backends/common/backend.hpp"

namespace wadi::vulkan {

const backends::Backend& vulkan_backend();

} // namespace wadi::vulkan
