// Memory under a host's Vulkan buffers that CUDA borrows.
#pragma once
#include "backends/cuda/context.hpp"

namespace wadi::cuda {

/// Vulkan memory that CUDA has mapped.
struct BorrowedMemory {
    compute::LentBuffer lent;
    cudaExternalMemory_t external = nullptr;
    std::byte* data = nullptr;
};

/// Errors: out_of_memory, not_supported.
Result<BorrowedMemory> borrow(Context& context, std::uint64_t bytes, const std::string& label);
void give_back(Context& context, BorrowedMemory& memory);

} // namespace wadi::cuda
