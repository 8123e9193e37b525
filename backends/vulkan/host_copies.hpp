// Copies from our buffers into images of the host's, and from the host's buffers into ours.
#pragma once
#include "backends/vulkan/context.hpp"

namespace wadi::vulkan {

/// Behind all work of this device and all of the host's on the image; whatever follows on the queue sees the image, in its new
/// layout, without a barrier of its own.
void record_image_copy(const Context& context, VkCommandBuffer commands, VkBuffer buffer, const compute::BufferRows& from,
                       const compute::HostImage& to);

/// Behind all work on the queue, the host's too, and ahead of what the host puts behind it.
void record_rows_copy(const Context& context, VkCommandBuffer commands, const compute::HostRows& from, VkBuffer to);

} // namespace wadi::vulkan
