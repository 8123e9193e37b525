// The buffers that the engine made, by handle, and the null buffer that stands in for absent ones.
#pragma once
#include "backends/vulkan/vulkan_memory.hpp"
#include <memory>
#include <vector>

namespace wadi::vulkan {

class Buffers {
  public:
    Buffers(Context& context, Transfers& transfers) : c_(context), transfers_(transfers) {}
    ~Buffers();
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;
    Status open();
    /// Errors: bad_argument (size), out_of_memory.
    Result<compute::Buffer> create(const compute::BufferDesc& desc);
    /// Nothing may use the buffer any more.
    void destroy(compute::Buffer buffer);
    /// Null for a handle that is not alive.
    const Memory* find(compute::Buffer buffer) const;
    /// Bound where a condition is off; 4 KiB that no stage touches.
    const Memory& null_buffer() const { return null_; }

    /// Empty unless made for the host.
    std::span<std::byte> mapped(compute::Buffer buffer) const;

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes);
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes);

  private:
    Result<const Memory*> find_range(compute::Buffer buffer, std::uint64_t offset, std::uint64_t bytes, const char* verb) const;

    Context& c_;
    Transfers& transfers_;
    Memory null_;
    std::vector<std::unique_ptr<Memory>> buffers_; // handle id - 1 is the place; ids are never used again
};

} // namespace wadi::vulkan
