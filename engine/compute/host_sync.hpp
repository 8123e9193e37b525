// Where a device and a host's own graphics API meet: the host's semaphores, events, images and command buffers.
#pragma once
#include "engine/compute/program.hpp"
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

/// Texels in rows of a buffer; offset and row_pitch [bytes] are whole texels.
struct BufferRows {
    Buffer buffer;
    std::uint64_t offset = 0, row_pitch = 0;
    std::uint32_t texel_bytes = 0; // 4, 8 or 16
    std::uint32_t width = 0, height = 0;
};

/// A place in an image of the host's (VkImage and VkImageLayout as numbers).
struct HostImage {
    std::uint64_t image = 0;
    std::int32_t old_layout = 0, new_layout = 0; // ahead of the copy and behind it
    std::uint32_t mip_level = 0, array_layer = 0;
    std::int32_t x = 0, y = 0; // of the first texel
};

/// Rows of 4-byte numbers in memory that the host has of the device's API: a VkBuffer, or a device address; offset and row_pitch
/// [bytes] are whole numbers.
struct HostRows {
    std::uint64_t handle = 0, offset = 0, row_pitch = 0;
    std::uint32_t width = 0, height = 0;
};

/// What Device::host_sync() gives; lives as long as the device. Errors of all: not_supported (another API's device, or the host's
/// device cannot), bad_argument (a null handle).
class HostSync {
  public:
    /// The next submission waits for the host's semaphores; signal_after() sets one once everything submitted so far is done.
    /// Neither waits.
    virtual Status wait_before(std::span<const SyncPoint> points) = 0;
    virtual Status signal_after(const SyncPoint& point) = 0;
    /// The same for the host's CUDA events (cudaEvent_t).
    virtual Status wait_event(void* event) = 0;
    virtual Status record_event(void* event) = 0;
    /// Fills a part of one mip level and array layer of a colour image that matches the texels, as a submission: after everything
    /// submitted before, seen by everything that the host submits behind it. Recording, it goes into the host's command buffer.
    virtual Result<Ticket> copy_to_image(const BufferRows& from, const HostImage& to) = 0;
    /// Brings rows to the begin of a buffer, one behind the other, as a submission: after everything that was submitted before,
    /// by the host too. The host may write them anew in what it submits behind it.
    virtual Result<Ticket> copy_from(const HostRows& from, Buffer to) = 0;
    /// From here to end_recording() every submit() goes into the host's command buffer (VkCommandBuffer, recording, of the
    /// device's queue family, outside a render pass) instead of the queue. The host promises to submit it, in the order of
    /// recording, with a signal of `promise`; tickets finish when that is reached. Until then calls that would reach the queue
    /// ahead of it (read, write, submit outside a recording) are refused with not_ready.
    virtual Status begin_recording(void* commands, const SyncPoint& promise) = 0;
    virtual Status end_recording() = 0;

  protected:
    ~HostSync() = default;
};

/// What a backend answers that has none of it, or not `what` is asked for: not_supported.
Status no_host_sync(const std::string& backend, const char* what);

} // namespace wadi::compute
