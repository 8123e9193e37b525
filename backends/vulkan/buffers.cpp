#include "backends/vulkan/buffers.hpp"
#include <cstring>

namespace wadi::vulkan {

Status Buffers::open() {
    auto memory = allocate(c_, null_slices * null_slice_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Place::device, "null");
    if (!memory) return memory.status();
    null_ = std::move(*memory);
    return transfers_.zero(null_);
}

Buffers::~Buffers() {
    buffers_.for_each([&](Memory& memory) { release(c_, memory); });
    release(c_, null_);
}

Result<compute::Buffer> Buffers::create(const compute::BufferDesc& desc) {
    buffers_.reserve();
    auto owner = std::make_unique<Memory>();
    const bool host = desc.host != compute::HostAccess::none;
    auto memory = allocate(c_, desc.bytes, host ? 0u : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                           host ? Place::host : Place::device, desc.label);
    if (!memory) return memory.status();
    *owner = std::move(*memory);
    if (host) {
        std::memset(owner->mapped, 0, owner->bytes);
    } else if (Status s = transfers_.zero(*owner); !s) {
        release(c_, *owner);
        return s;
    }
    return compute::Buffer{buffers_.add(std::move(owner))};
}

} // namespace wadi::vulkan
