#include "backends/vulkan/memory.hpp"
#include <algorithm>
#include <optional>

namespace wadi::vulkan {
namespace {

// The first type with all of `needed`; types with `liked` as well come first.
std::optional<std::uint32_t> memory_type(const Context& c, std::uint32_t allowed, VkMemoryPropertyFlags needed,
                                         VkMemoryPropertyFlags liked) {
    for (const VkMemoryPropertyFlags flags : {needed | liked, needed}) {
        for (std::uint32_t type = 0; type < c.memory.memoryTypeCount; ++type) {
            const bool fits = (c.memory.memoryTypes[type].propertyFlags & flags) == flags;
            if (fits && (allowed >> type & 1u) != 0) return type;
        }
    }
    return std::nullopt;
}

Status bind_memory(Context& c, Memory& m, Place place) {
    VkMemoryRequirements needs{};
    c.vk.vkGetBufferMemoryRequirements(c.device, m.buffer, &needs);
    // The specification promises both kinds; cached host memory makes reading back fast.
    const auto type =
        place == Place::host
            ? memory_type(c, needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                          VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
            : memory_type(c, needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
    if (!type) return error(Code::not_supported, "no memory type suits the buffer '" + m.label + "'");
    auto info = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = needs.size;
    info.memoryTypeIndex = *type;
    auto dedicated = vk_struct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
    dedicated.buffer = m.buffer;
    auto exported = vk_struct<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    exported.pNext = &dedicated;
    exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    if (place == Place::shared) info.pNext = &exported;
    m.allocated = needs.size;
    const std::string what = "vkAllocateMemory (" + std::to_string(needs.size) + " bytes)";
    if (Status s = c.check(c.vk.vkAllocateMemory(c.device, &info, nullptr, &m.memory), what, m.label); !s) return s;
    if (Status s = c.check(c.vk.vkBindBufferMemory(c.device, m.buffer, m.memory, 0), "vkBindBufferMemory", m.label); !s) return s;
    if (place != Place::host) return ok_status();
    return c.check(c.vk.vkMapMemory(c.device, m.memory, 0, VK_WHOLE_SIZE, 0, &m.mapped), "vkMapMemory", m.label);
}

VkPipelineStageFlags stages(Kinds kinds) {
    VkPipelineStageFlags flags = 0;
    if (kinds.compute) flags |= VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    if (kinds.transfer) flags |= VK_PIPELINE_STAGE_TRANSFER_BIT;
    if (kinds.indirect) flags |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
    if (kinds.host) flags |= VK_PIPELINE_STAGE_HOST_BIT;
    return flags;
}

constexpr Kinds everything{.compute = true, .transfer = true};

// Of one copy through the staging buffer.
constexpr std::uint64_t chunk_bytes = 8u << 20;

} // namespace

Result<Memory> allocate(Context& c, std::uint64_t bytes, VkBufferUsageFlags usage, Place place, std::string label) {
    Memory m;
    m.bytes = bytes;
    m.label = std::move(label);
    auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = (bytes + 3) / 4 * 4;
    info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    auto external = vk_struct<VkExternalMemoryBufferCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    if (place == Place::shared) info.pNext = &external;
    if (!c.sharing_families.empty()) {
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
        info.queueFamilyIndexCount = static_cast<std::uint32_t>(c.sharing_families.size());
        info.pQueueFamilyIndices = c.sharing_families.data();
    }
    if (Status s = c.check(c.vk.vkCreateBuffer(c.device, &info, nullptr, &m.buffer), "vkCreateBuffer", m.label); !s) return s;
    if (Status s = bind_memory(c, m, place); !s) {
        release(c, m);
        return s;
    }
    ++c.counters.allocations;
    return m;
}

void release(Context& c, Memory& m) {
    if (m.buffer != VK_NULL_HANDLE) c.vk.vkDestroyBuffer(c.device, m.buffer, nullptr);
    if (m.memory != VK_NULL_HANDLE) c.vk.vkFreeMemory(c.device, m.memory, nullptr);
    m = {};
}

void record_barrier(const Context& c, VkCommandBuffer commands, Kinds before, Kinds after) {
    auto barrier = vk_struct<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    if (before.compute) barrier.srcAccessMask |= VK_ACCESS_SHADER_WRITE_BIT;
    if (before.transfer) barrier.srcAccessMask |= VK_ACCESS_TRANSFER_WRITE_BIT;
    if (after.compute)
        barrier.dstAccessMask |= VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    if (after.transfer) barrier.dstAccessMask |= VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    if (after.indirect) barrier.dstAccessMask |= VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
    if (after.host) barrier.dstAccessMask |= VK_ACCESS_HOST_READ_BIT;
    c.vk.vkCmdPipelineBarrier(commands, stages(before), stages(after), 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

Status OneTimeCommands::open() {
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = c_.queue_family;
    if (Status s = c_.check(c_.vk.vkCreateCommandPool(c_.device, &pool, nullptr, &pool_), "vkCreateCommandPool"); !s) return s;
    auto info = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    const auto fence = vk_struct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    for (Set& set : sets_) {
        if (Status s = c_.check(c_.vk.vkAllocateCommandBuffers(c_.device, &info, &set.commands), "vkAllocateCommandBuffers"); !s)
            return s;
        if (Status s = c_.check(c_.vk.vkCreateFence(c_.device, &fence, nullptr, &set.fence), "vkCreateFence"); !s) return s;
    }
    return ok_status();
}

OneTimeCommands::~OneTimeCommands() {
    for (const Set& set : sets_)
        if (set.fence != VK_NULL_HANDLE) c_.vk.vkDestroyFence(c_.device, set.fence, nullptr);
    if (pool_ != VK_NULL_HANDLE) c_.vk.vkDestroyCommandPool(c_.device, pool_, nullptr);
}

Result<VkCommandBuffer> OneTimeCommands::begin() {
    now_ = (now_ + 1) % sets_.size();
    Set& set = sets_[now_];
    if (Status s = wait(set); !s) return s;
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (Status s = c_.check(c_.vk.vkBeginCommandBuffer(set.commands, &info), "vkBeginCommandBuffer"); !s) return s;
    record_barrier(c_, set.commands, everything, everything);
    return set.commands;
}

Status OneTimeCommands::submit() {
    Set& set = sets_[now_];
    if (Status s = c_.check(c_.vk.vkEndCommandBuffer(set.commands), "vkEndCommandBuffer"); !s) return s;
    if (Status s = c_.check(c_.vk.vkResetFences(c_.device, 1, &set.fence), "vkResetFences"); !s) return s;
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &set.commands;
    Status s = c_.check(c_.vk.vkQueueSubmit(c_.queue, 1, &info, set.fence), "vkQueueSubmit");
    set.in_flight = s.code == Code::ok;
    return s;
}

Status OneTimeCommands::wait(Set& set) {
    if (!set.in_flight) return ok_status();
    Status s = c_.check(c_.vk.vkWaitForFences(c_.device, 1, &set.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    if (s) set.in_flight = false;
    return s;
}

Status OneTimeCommands::wait() {
    for (Set& set : sets_) {
        if (Status s = wait(set); !s) return s;
    }
    return ok_status();
}

bool OneTimeCommands::in_flight() const {
    return std::any_of(sets_.begin(), sets_.end(), [](const Set& set) { return set.in_flight; });
}

Status Transfers::open() {
    auto staging = allocate(c_, chunk_bytes, 0, Place::host, "staging");
    if (!staging) return staging.status();
    staging_ = std::move(*staging);
    return ok_status();
}

Transfers::~Transfers() { release(c_, staging_); }

Status Transfers::zero(const Memory& memory) {
    auto commands = once_.begin();
    if (!commands) return commands.status();
    c_.vk.vkCmdFillBuffer(*commands, memory.buffer, 0, VK_WHOLE_SIZE, 0);
    return once_.submit();
}

Status Transfers::write(const Memory& to, std::uint64_t offset, std::span<const std::byte> bytes) {
    for (std::uint64_t done = 0; done < bytes.size(); done += chunk_bytes) {
        const auto part = bytes.subspan(done, std::min<std::uint64_t>(chunk_bytes, bytes.size() - done));
        // Until the previous chunk has left the staging buffer.
        if (Status s = once_.wait(); !s) return s;
        auto commands = once_.begin();
        if (!commands) return commands.status();
        std::copy(part.begin(), part.end(), static_cast<std::byte*>(staging_.mapped));
        const VkBufferCopy region{0, offset + done, part.size()};
        c_.vk.vkCmdCopyBuffer(*commands, staging_.buffer, to.buffer, 1, &region);
        if (Status s = once_.submit(); !s) return s;
    }
    return ok_status();
}

Status Transfers::read(const Memory& from, std::uint64_t offset, std::span<std::byte> bytes) {
    for (std::uint64_t done = 0; done < bytes.size(); done += chunk_bytes) {
        const auto part = bytes.subspan(done, std::min<std::uint64_t>(chunk_bytes, bytes.size() - done));
        auto commands = once_.begin();
        if (!commands) return commands.status();
        const VkBufferCopy region{offset + done, 0, part.size()};
        c_.vk.vkCmdCopyBuffer(*commands, from.buffer, staging_.buffer, 1, &region);
        record_barrier(c_, *commands, {.transfer = true}, {.host = true});
        if (Status s = once_.submit(); !s) return s;
        if (Status s = once_.wait(); !s) return s;
        const std::byte* staged = static_cast<const std::byte*>(staging_.mapped);
        std::copy(staged, staged + part.size(), part.begin());
    }
    return ok_status();
}

} // namespace wadi::vulkan
