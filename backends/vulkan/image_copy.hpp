// Copies rows of a buffer into an image of the host's.
#pragma once
#include "backends/vulkan/context.hpp"

namespace wadi::vulkan {

/// Behind all work of this device and all of the host's on the image; whatever follows on the queue sees the image, in its new
/// layout, without a barrier of its own.
void record_image_copy(const Context& context, VkCommandBuffer commands, VkBuffer buffer, const compute::BufferRows& from,
                       const compute::HostImage& to);

} // namespace wadi::vulkan
