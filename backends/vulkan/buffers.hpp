// The buffers that the engine made, by handle, and the null buffer that stands in for absent ones.
#pragma once
#include "backends/common/handle_table.hpp"
#include "backends/vulkan/memory.hpp"

namespace wadi::vulkan {

class Buffers {
  public:
    Buffers(Context& context, Transfers& transfers) : c_(context), transfers_(transfers) {}
    ~Buffers();
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;
    Status open();
    /// Errors: out_of_memory.
    Result<compute::Buffer> create(const compute::BufferDesc& desc);
    /// Null for a handle that is not alive. Whoever takes a buffer releases it.
    std::unique_ptr<Memory> take(compute::Buffer buffer) { return buffers_.take(buffer.id); }
    /// Null for a handle that is not alive.
    const Memory* find(compute::Buffer buffer) const { return buffers_.find(buffer.id); }
    /// Bound where a condition is off; no stage touches it. The validation layers do not know that: what they take for a write
    /// of one set and a read of the next must not meet, so each set of a program has a slice of its own.
    VkDescriptorBufferInfo null_slice(std::uint64_t set) const {
        return {null_.buffer, (set % null_slices) * null_slice_bytes, null_slice_bytes};
    }

  private:
    static constexpr std::uint64_t null_slice_bytes = 256; // the largest minStorageBufferOffsetAlignment that is allowed
    static constexpr std::uint64_t null_slices = 256;      // more than the sets of the longest program

    Context& c_;
    Transfers& transfers_;
    Memory null_;
    backends::HandleTable<Memory> buffers_;
};

} // namespace wadi::vulkan
