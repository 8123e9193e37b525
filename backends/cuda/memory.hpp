// Device memory: the engine's buffers by handle, zeroed when made, and copies to and from the host.
#pragma once
#include "backends/cuda/borrowed.hpp"
#include <cstddef>
#include <span>
#include <vector>

namespace wadi::cuda {

struct Memory {
    std::byte* data = nullptr; // device address; of page-locked host memory the one address that both use
    std::uint64_t bytes = 0;
    std::string label;
    bool host = false;       // page-locked host memory
    BorrowedMemory borrowed; // the lender's, or empty
};

/// Contents are undefined. Errors: out_of_memory with the label and what is free.
Result<Memory> allocate(Context& context, std::uint64_t bytes, std::string label, bool host = false);
void release(Context& context, Memory& memory);
/// Ordered after everything submitted before; they wait until the copy is done.
Status copy_in(Context& context, const Memory& memory, std::uint64_t offset, std::span<const std::byte> bytes);
Status copy_out(Context& context, const Memory& memory, std::uint64_t offset, std::span<std::byte> bytes);

class Buffers {
  public:
    explicit Buffers(Context& context) : c_(context) {}
    ~Buffers();
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;
    /// Errors: bad_argument (size), out_of_memory.
    Result<compute::Buffer> create(const compute::BufferDesc& desc);
    /// Nothing may use the buffer any more.
    void destroy(compute::Buffer buffer);
    /// Null for a handle that is not alive.
    const Memory* find(compute::Buffer buffer) const;

    /// Empty unless made for the host.
    std::span<std::byte> mapped(compute::Buffer buffer) const;

    Status write(compute::Buffer buffer, std::uint64_t offset, std::span<const std::byte> bytes);
    Status read(compute::Buffer buffer, std::uint64_t offset, std::span<std::byte> bytes);

  private:
    Result<const Memory*> find_range(compute::Buffer buffer, std::uint64_t offset, std::uint64_t bytes, const char* verb) const;

    Context& c_;
    std::vector<std::unique_ptr<Memory>> buffers_; // handle id - 1 is the place; ids are never used again
};

} // namespace wadi::cuda
