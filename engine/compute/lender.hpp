// What one API makes and another uses: how CUDA works beside a host's Vulkan device (CUDA has no buffers that Vulkan could use,
// so the memory is Vulkan's). The Vulkan backend lends, the CUDA backend borrows, the engine knows of neither.
#pragma once
#include "engine/compute/status.hpp"
#include <array>
#include <cstdint>
#include <string>

namespace wadi::compute {

/// A file descriptor of the operating system. Importing it hands it over; nobody closes it after that.
using Descriptor = int;

using DeviceUuid = std::array<std::uint8_t, 16>;

/// A buffer of the lender's API, and its memory for the borrower's.
struct LentBuffer {
    std::uint64_t handle = 0; // VkBuffer
    std::uint64_t bytes = 0;  // of the memory
    Descriptor descriptor = -1;
};

class Lender {
  public:
    virtual ~Lender() = default;
    /// Of the GPU that it lends from: the borrower must run on the same one.
    virtual const DeviceUuid& device_uuid() const = 0;
    virtual const std::string& device_name() const = 0;
    /// A buffer with memory of its own, contents undefined. Errors: out_of_memory, not_supported.
    virtual Result<LentBuffer> lend_buffer(std::uint64_t bytes, const std::string& label) = 0;
    virtual void take_back(const LentBuffer& buffer) = 0;
    /// A timeline semaphore that the host made exportable. Errors: not_supported, out_of_memory.
    virtual Result<Descriptor> lend_semaphore(std::uint64_t semaphore) = 0;
};

} // namespace wadi::compute
