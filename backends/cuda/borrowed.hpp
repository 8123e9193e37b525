// What CUDA borrows from a host's Vulkan device: memory under its buffers, and timeline semaphores.
#pragma once
#include "backends/cuda/context.hpp"
#include <map>
#include <span>

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

/// The host's timeline semaphores, imported when first used and kept until the device closes.
class Semaphores final : public compute::HostSync {
  public:
    explicit Semaphores(Context& context) : c_(context) {}
    ~Semaphores();
    Semaphores(const Semaphores&) = delete;
    Semaphores& operator=(const Semaphores&) = delete;
    Status wait_before(std::span<const compute::SyncPoint> points) override;
    Status signal_after(const compute::SyncPoint& point) override;
    /// Refused: CUDA cannot record into Vulkan's command buffers.
    Status begin_recording(void* commands, const compute::SyncPoint& promise) override;
    Status end_recording() override;

  private:
    Result<cudaExternalSemaphore_t> find(std::uint64_t semaphore);

    Context& c_;
    std::map<std::uint64_t, cudaExternalSemaphore_t> imported_; // by VkSemaphore
};

} // namespace wadi::cuda
