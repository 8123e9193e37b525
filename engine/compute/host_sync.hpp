// Where a device and a host's own graphics API meet: the host's semaphores and command buffers.
#pragma once
#include "engine/compute/status.hpp"
#include <cstdint>
#include <span>
#include <string>

namespace wadi::compute {

/// A point on a host's timeline semaphore (VkSemaphore as a number).
struct SyncPoint {
    std::uint64_t semaphore = 0;
    std::uint64_t value = 0;
};

/// What Device::host_sync() gives; lives as long as the device.
class HostSync {
  public:
    /// The next submission waits for the host's semaphores; signal_after() sets one once everything submitted so far is done.
    /// Neither waits. Errors: not_supported (no timeline semaphores, or another API's device), bad_argument (null semaphore).
    virtual Status wait_before(std::span<const SyncPoint> points) = 0;
    virtual Status signal_after(const SyncPoint& point) = 0;
    /// From here to end_recording() every submit() goes into the host's command buffer (VkCommandBuffer, recording, of the
    /// device's queue family, outside a render pass) instead of the queue. The host promises to submit it, in the order of
    /// recording, with a signal of `promise`; tickets finish when that is reached. Until then calls that would reach the queue
    /// ahead of it (read, write, submit outside a recording) are refused with not_ready. Errors: not_supported, bad_argument.
    virtual Status begin_recording(void* commands, const SyncPoint& promise) = 0;
    virtual Status end_recording() = 0;

  protected:
    ~HostSync() = default;
};

/// What a backend answers that has none of it, or not what is asked for: not_supported.
Status no_host_sync(const std::string& backend);

} // namespace wadi::compute
