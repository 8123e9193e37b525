// Device memory: the engine's buffers by handle, zeroed when made, and copies to and from the host.
#pragma once
#include "backends/common/handle_table.hpp"
#include "backends/cuda/borrowed.hpp"
#include <cstddef>
#include <span>

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
    /// Errors: out_of_memory.
    Result<compute::Buffer> create(const compute::BufferDesc& desc);
    /// Nothing may use the buffer any more.
    void destroy(compute::Buffer buffer);
    /// Null for a handle that is not alive.
    const Memory* find(compute::Buffer buffer) const { return buffers_.find(buffer.id); }

  private:
    Context& c_;
    backends::HandleTable<Memory> buffers_;
};

} // namespace wadi::cuda
