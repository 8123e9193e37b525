#include "backends/vulkan/image_copy.hpp"
#include "backends/vulkan/memory.hpp"

namespace wadi::vulkan {

void record_image_copy(const Context& c, VkCommandBuffer commands, VkBuffer buffer, const compute::BufferRows& from,
                       const compute::HostImage& to) {
    constexpr VkImageAspectFlags colour = VK_IMAGE_ASPECT_COLOR_BIT;
    constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, copies = VK_PIPELINE_STAGE_TRANSFER_BIT;
    auto barrier = vk_struct<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = reinterpret_cast<VkImage>(to.image);
    barrier.subresourceRange = {colour, to.mip_level, 1, to.array_layer, 1};

    record_barrier(c, commands, {.compute = true, .transfer = true}, {.transfer = true});
    barrier.oldLayout = static_cast<VkImageLayout>(to.old_layout);
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    c.vk.vkCmdPipelineBarrier(commands, all, copies, 0, 0, nullptr, 0, nullptr, 1, &barrier);

    VkBufferImageCopy region{};
    region.bufferOffset = from.offset;
    region.bufferRowLength = static_cast<std::uint32_t>(from.row_pitch / from.texel_bytes);
    region.imageSubresource = {colour, to.mip_level, to.array_layer, 1};
    region.imageOffset = {to.x, to.y, 0};
    region.imageExtent = {from.width, from.height, 1};
    c.vk.vkCmdCopyBufferToImage(commands, buffer, barrier.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);

    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = static_cast<VkImageLayout>(to.new_layout);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    c.vk.vkCmdPipelineBarrier(commands, copies, all, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

} // namespace wadi::vulkan
