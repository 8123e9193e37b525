#include "backends/cuda/memory.hpp"
#include <cstring>

namespace wadi::cuda {
namespace {

std::string free_text() {
    std::size_t free = 0, total = 0;
    if (cudaMemGetInfo(&free, &total) != cudaSuccess) return "";
    return "; " + std::to_string(free >> 20) + " of " + std::to_string(total >> 20) + " MiB are free";
}

Result<Memory> allocate_borrowed(Context& c, const compute::BufferDesc& desc) {
    auto borrowed = borrow(c, desc.bytes, desc.label);
    if (!borrowed) return borrowed.status();
    ++c.counters.allocations;
    return Memory{borrowed->data, desc.bytes, desc.label, false, *borrowed};
}

} // namespace

Result<Memory> allocate(Context& c, std::uint64_t bytes, std::string label, bool host) {
    void* data = nullptr;
    const cudaError_t made = host ? cudaHostAlloc(&data, bytes, cudaHostAllocDefault) : cudaMalloc(&data, bytes);
    Status s = c.check(made, host ? "cudaHostAlloc" : "cudaMalloc", label);
    if (!s) {
        if (s.code == Code::out_of_memory) s.message += ", " + std::to_string(bytes) + " bytes asked for" + free_text();
        return s;
    }
    ++c.counters.allocations;
    return Memory{static_cast<std::byte*>(data), bytes, std::move(label), host, {}};
}

void release(Context& c, Memory& memory) {
    if (memory.borrowed.data != nullptr) {
        give_back(c, memory.borrowed);
    } else if (memory.data != nullptr && memory.host) {
        c.note(cudaFreeHost(memory.data), "cudaFreeHost", memory.label);
    } else if (memory.data != nullptr) {
        c.note(cudaFree(memory.data), "cudaFree", memory.label);
    }
    memory.data = nullptr;
}

// From memory that is not page-locked the driver may read after the call returns (on systems that share their page tables
// with the GPU), hence the wait.
Status copy_in(Context& c, const Memory& memory, std::uint64_t offset, std::span<const std::byte> bytes) {
    const cudaError_t r = cudaMemcpyAsync(memory.data + offset, bytes.data(), bytes.size(), cudaMemcpyDefault, c.stream);
    if (Status s = c.check(r, "write", memory.label); !s) return s;
    return c.check(cudaStreamSynchronize(c.stream), "write", memory.label);
}

Status copy_out(Context& c, const Memory& memory, std::uint64_t offset, std::span<std::byte> bytes) {
    const cudaError_t r = cudaMemcpyAsync(bytes.data(), memory.data + offset, bytes.size(), cudaMemcpyDefault, c.stream);
    if (Status s = c.check(r, "read", memory.label); !s) return s;
    return c.check(cudaStreamSynchronize(c.stream), "read", memory.label);
}

Buffers::~Buffers() {
    const CurrentContext current(c_);
    buffers_.for_each([&](Memory& memory) { release(c_, memory); });
}

Result<compute::Buffer> Buffers::create(const compute::BufferDesc& desc) {
    buffers_.reserve();
    auto owner = std::make_unique<Memory>();
    const bool borrowed = desc.shared && c_.options.lender != nullptr;
    auto memory =
        borrowed ? allocate_borrowed(c_, desc) : allocate(c_, desc.bytes, desc.label, desc.host != compute::HostAccess::none);
    if (!memory) return memory.status();
    *owner = std::move(*memory);
    if (owner->host) {
        std::memset(owner->data, 0, owner->bytes);
    } else if (Status s = c_.check(cudaMemsetAsync(owner->data, 0, owner->bytes, c_.stream), "cudaMemsetAsync", owner->label);
               !s) {
        release(c_, *owner);
        return s;
    }
    return compute::Buffer{buffers_.add(std::move(owner))};
}

void Buffers::destroy(compute::Buffer buffer) {
    const auto owner = buffers_.take(buffer.id);
    release(c_, *owner);
}

} // namespace wadi::cuda
