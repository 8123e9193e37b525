// The Vulkan backend: any GPU, integrated or discrete, and the software GPU lavapipe.
#pragma once
#include "engine/compute/device.hpp"

namespace wadi::vulkan {

const compute::Backend& vulkan_backend();

} // namespace wadi::vulkan
