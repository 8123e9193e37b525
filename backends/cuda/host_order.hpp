// Where the world meets a host: CUDA events, device memory of the host's, and beside its Vulkan device its timeline semaphores.
#pragma once
#include "backends/cuda/submissions.hpp"
#include <map>
#include <span>

namespace wadi::cuda {

/// Semaphores are imported when first used and kept until the device closes; without a lender they are refused.
class HostOrder final : public compute::HostSync {
  public:
    HostOrder(Context& context, const Buffers& buffers, Submissions& submissions)
        : c_(context), buffers_(buffers), submissions_(submissions) {}
    ~HostOrder();
    HostOrder(const HostOrder&) = delete;
    HostOrder& operator=(const HostOrder&) = delete;
    Status wait_before(std::span<const compute::SyncPoint> points) override;
    Status signal_after(const compute::SyncPoint& point) override;
    Status wait_event(void* event) override;
    Status record_event(void* event) override;
    Result<compute::Ticket> copy_from(const compute::HostRows& from, compute::Buffer to) override;
    /// Refused: CUDA neither copies into Vulkan's images nor records into Vulkan's command buffers.
    Result<compute::Ticket> copy_to_image(const compute::BufferRows& from, const compute::HostImage& to) override;
    Status begin_recording(void* commands, const compute::SyncPoint& promise) override;
    Status end_recording() override;

  private:
    Status check_lender() const;
    Status check_event(cudaError_t result, const char* what);
    Result<cudaExternalSemaphore_t> find(std::uint64_t semaphore);

    Context& c_;
    const Buffers& buffers_;
    Submissions& submissions_;
    std::map<std::uint64_t, cudaExternalSemaphore_t> imported_; // by VkSemaphore
};

} // namespace wadi::cuda
