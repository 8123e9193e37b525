#include "tests/latency/images.hpp"
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace paths {

namespace {
template <class T> T vk_struct(VkStructureType type) {
    T value{};
    value.sType = type;
    return value;
}
} // namespace

Images::Images(const wadi_vulkan_host& host, int nx, int ny)
    : host_(host), width_(static_cast<std::uint32_t>(nx)), height_(static_cast<std::uint32_t>(ny)) {
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        auto info = vk_struct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = drawn[n].format;
        info.extent = {width_, height_, 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        check_vk(vkCreateImage(host.device, &info, nullptr, &images_[n]), "vkCreateImage");
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(host.device, images_[n], &needs);
        memory_[n] = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        check_vk(vkBindImageMemory(host.device, images_[n], memory_[n], 0), "vkBindImageMemory");
    }
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = host.queue_family;
    check_vk(vkCreateCommandPool(host.device, &pool, nullptr, &pool_), "vkCreateCommandPool");
    for (Slot& slot : slots_) {
        slot.staging = make_buffer();
        auto commands = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        commands.commandPool = pool_;
        commands.commandBufferCount = 1;
        check_vk(vkAllocateCommandBuffers(host.device, &commands, &slot.commands), "vkAllocateCommandBuffers");
        auto fence = vk_struct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        check_vk(vkCreateFence(host.device, &fence, nullptr, &slot.fence), "vkCreateFence");
    }
}

Images::~Images() {
    wait();
    for (const Slot& slot : slots_) {
        vkDestroyFence(host_.device, slot.fence, nullptr);
        destroy(slot.staging);
    }
    vkDestroyCommandPool(host_.device, pool_, nullptr);
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        vkDestroyImage(host_.device, images_[n], nullptr);
        vkFreeMemory(host_.device, memory_[n], nullptr);
    }
}

VkDeviceMemory Images::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(host_.physical_device, &memory);
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
        if ((needs.memoryTypeBits >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
        auto info = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        info.allocationSize = needs.size;
        info.memoryTypeIndex = type;
        VkDeviceMemory made{};
        check_vk(vkAllocateMemory(host_.device, &info, nullptr, &made), "vkAllocateMemory");
        return made;
    }
    std::fprintf(stderr, "wadi-paths: the Vulkan device has no memory with properties %#x\n", wanted);
    std::exit(1);
}

Images::Buffer Images::make_buffer() const {
    Buffer made;
    auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    for (std::size_t n = 0; n < drawn.size(); ++n) info.size += size(n);
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check_vk(vkCreateBuffer(host_.device, &info, nullptr, &made.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(host_.device, made.buffer, &needs);
    made.memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check_vk(vkBindBufferMemory(host_.device, made.buffer, made.memory, 0), "vkBindBufferMemory");
    void* mapped = nullptr;
    check_vk(vkMapMemory(host_.device, made.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    made.mapped = static_cast<std::byte*>(mapped);
    return made;
}

void Images::destroy(const Buffer& buffer) const {
    vkDestroyBuffer(host_.device, buffer.buffer, nullptr);
    vkFreeMemory(host_.device, buffer.memory, nullptr);
}

void Images::begin(VkCommandBuffer commands) const {
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vk(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

void Images::submit(VkCommandBuffer commands, VkFence fence) const {
    check_vk(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    check_vk(vkQueueSubmit(host_.queue, 1, &info, fence), "vkQueueSubmit");
}

void Images::change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) const {
    auto change = vk_struct<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    change.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    change.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(commands, all, all, 0, 0, nullptr, 0, nullptr, 1, &change);
}

VkBufferImageCopy Images::region(std::size_t which) const {
    VkBufferImageCopy copy{};
    for (std::size_t n = 0; n < which; ++n) copy.bufferOffset += size(n);
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {width_, height_, 1};
    return copy;
}

void Images::copy_from(wadi_world_id world) {
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        auto to = wadi_default_vulkan_image();
        to.image = images_[n];
        to.format = drawn[n].format;
        to.width = width_;
        to.height = height_;
        check(wadi_vulkan_copy_output(world, drawn[n].output, WADI_OUTPUT_CURRENT, &to), "wadi_vulkan_copy_output");
    }
}

void Images::upload(const Texels& texels) {
    Slot& slot = slots_[slot_ = (slot_ + 1) % slots];
    check_vk(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    check_vk(vkResetFences(host_.device, 1, &slot.fence), "vkResetFences");
    begin(slot.commands);
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        const auto copy = region(n);
        std::memcpy(slot.staging.mapped + copy.bufferOffset, texels[n].data(), size(n));
        change_layout(slot.commands, images_[n], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(slot.commands, slot.staging.buffer, images_[n], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        change_layout(slot.commands, images_[n], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    submit(slot.commands, slot.fence);
}

void Images::wait() const { check_vk(vkQueueWaitIdle(host_.queue), "vkQueueWaitIdle"); }

Texels Images::contents() const {
    wait();
    const VkCommandBuffer commands = slots_[0].commands; // of no upload under way
    const Buffer& buffer = slots_[0].staging;
    begin(commands);
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        const auto copy = region(n);
        change_layout(commands, images_[n], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        vkCmdCopyImageToBuffer(commands, images_[n], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.buffer, 1, &copy);
        change_layout(commands, images_[n], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    auto seen = vk_struct<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    seen.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    seen.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &seen, 0, nullptr, 0,
                         nullptr);
    submit(commands, VK_NULL_HANDLE);
    wait();
    Texels texels;
    for (std::size_t n = 0; n < drawn.size(); ++n) {
        const std::byte* from = buffer.mapped + region(n).bufferOffset;
        texels[n].assign(from, from + size(n));
    }
    return texels;
}

} // namespace paths
