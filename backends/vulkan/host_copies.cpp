#include "backends/vulkan/host_copies.hpp"
#include "backends/vulkan/memory.hpp"
#include <vector>

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

void record_rows_copy(const Context& c, VkCommandBuffer commands, const compute::HostRows& from, VkBuffer to) {
    constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, copies = VK_PIPELINE_STAGE_TRANSFER_BIT;
    auto barrier = vk_struct<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    c.vk.vkCmdPipelineBarrier(commands, all, copies, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    const VkDeviceSize row = VkDeviceSize{from.width} * 4;
    std::vector<VkBufferCopy> rows;
    if (row == from.row_pitch) {
        rows.push_back({from.offset, 0, row * from.height});
    } else {
        for (std::uint32_t n = 0; n < from.height; ++n) rows.push_back({from.offset + n * from.row_pitch, n * row, row});
    }
    c.vk.vkCmdCopyBuffer(commands, reinterpret_cast<VkBuffer>(static_cast<std::uintptr_t>(from.handle)), to,
                         static_cast<std::uint32_t>(rows.size()), rows.data());
    c.vk.vkCmdPipelineBarrier(commands, copies, all, 0, 0, nullptr, 0, nullptr, 0, nullptr);
}

} // namespace wadi::vulkan
