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
    for (const auto& b : buffers_) {
        if (b) release(c_, *b);
    }
    release(c_, null_);
}

Result<compute::Buffer> Buffers::create(const compute::BufferDesc& desc) {
    const std::uint64_t largest = c_.capabilities.largest_buffer_bytes;
    if (desc.bytes == 0 || desc.bytes > largest) {
        return error(Code::bad_argument, "size of buffer '" + desc.label + "' is " + std::to_string(desc.bytes) +
                                             " bytes; allowed on " + c_.capabilities.name + " are 1 to " +
                                             std::to_string(largest));
    }
    buffers_.reserve(buffers_.size() + 1); // so that nothing can fail once the buffer exists
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
    buffers_.push_back(std::move(owner));
    return compute::Buffer{static_cast<std::uint32_t>(buffers_.size())};
}

void Buffers::destroy(compute::Buffer buffer) {
    if (find(buffer) == nullptr) return;
    std::unique_ptr<Memory>& owner = buffers_[buffer.id - 1];
    release(c_, *owner);
    owner.reset();
}

const Memory* Buffers::find(compute::Buffer buffer) const {
    return buffer.id == 0 || buffer.id > buffers_.size() ? nullptr : buffers_[buffer.id - 1].get();
}

std::span<std::byte> Buffers::mapped(compute::Buffer buffer) const {
    const Memory* memory = find(buffer);
    if (memory == nullptr || memory->mapped == nullptr) return {};
    return {static_cast<std::byte*>(memory->mapped), memory->bytes};
}

Result<const Memory*> Buffers::find_range(compute::Buffer buffer, std::uint64_t offset, std::uint64_t bytes,
                                          const char* verb) const {
    const Memory* memory = find(buffer);
    if (memory == nullptr) {
        return error(Code::bad_argument, std::string(verb) + ": no buffer has the handle " + std::to_string(buffer.id));
    }
    if (offset > memory->bytes || bytes > memory->bytes - offset) {
        return error(Code::bad_argument, std::string(verb) + " of buffer '" + memory->label + "': bytes " +
                                             std::to_string(offset) + " to " + std::to_string(offset + bytes) +
                                             " are outside 0 to " + std::to_string(memory->bytes));
    }
    return memory;
}

Status Buffers::write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    auto memory = find_range(buffer, offset, bytes.size(), "write");
    return memory ? transfers_.write(**memory, offset, bytes) : memory.status();
}

Status Buffers::read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes) {
    auto memory = find_range(buffer, offset, bytes.size(), "read");
    return memory ? transfers_.read(**memory, offset, bytes) : memory.status();
}

} // namespace wadi::vulkan
