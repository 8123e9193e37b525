// Device memory: one allocation per buffer, barriers between kinds of commands, and copies to and from the host.
#pragma once
#include "backends/common/retired.hpp"
#include "backends/vulkan/context.hpp"
#include <array>
#include <cstddef>
#include <span>

namespace wadi::vulkan {

/// A buffer with memory of its own; `mapped` only where the host may touch it.
struct Memory : backends::Retirable<Memory> {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;     // as asked for; the Vulkan buffer is rounded up to whole words
    std::uint64_t allocated = 0; // of the memory
    void* mapped = nullptr;
    std::string label;
};

/// shared: on the device, exportable to another API by a descriptor.
enum class Place { device, host, shared };

/// Contents are undefined. Errors: out_of_memory with the label.
Result<Memory> allocate(Context& context, std::uint64_t bytes, VkBufferUsageFlags usage, Place place, std::string label);
void release(Context& context, Memory& memory);

/// Kinds of commands that a barrier orders.
struct Kinds {
    bool compute = false;
    bool transfer = false;
    bool indirect = false; // reading the groups of a dispatch; only ever `after`
    bool host = false;     // reading mapped memory; only ever `after`
};

/// A global memory barrier: everything of the kinds `before` ahead of it, then everything of the kinds `after`.
void record_barrier(const Context& context, VkCommandBuffer commands, Kinds before, Kinds after);

/// Commands that run once: zero fills, transfers, the self-test. Several sets may be in flight, so that many buffers can be made
/// without waiting for the queue.
class OneTimeCommands {
  public:
    explicit OneTimeCommands(Context& context) : c_(context) {}
    ~OneTimeCommands();
    OneTimeCommands(const OneTimeCommands&) = delete;
    OneTimeCommands& operator=(const OneTimeCommands&) = delete;
    Status open();
    /// Waits for the oldest set where all are in flight; what is recorded next sees everything submitted before it.
    Result<VkCommandBuffer> begin();
    Status submit();
    /// For all of them.
    Status wait();
    /// Whether a set has been submitted since the last wait().
    bool in_flight() const;

  private:
    struct Set {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        bool in_flight = false;
    };
    Status wait(Set& set);

    Context& c_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::array<Set, 64> sets_; // more than the buffers that a change of effects makes
    std::size_t now_ = 0;
};

/// Copies between host and device through one staging buffer, in chunks. Offsets and sizes are the caller's to check.
class Transfers {
  public:
    Transfers(Context& context, OneTimeCommands& once) : c_(context), once_(once) {}
    ~Transfers();
    Transfers(const Transfers&) = delete;
    Transfers& operator=(const Transfers&) = delete;
    Status open();
    Status zero(const Memory& memory);
    Status write(const Memory& to, std::uint64_t offset, std::span<const std::byte> bytes);
    Status read(const Memory& from, std::uint64_t offset, std::span<std::byte> bytes);

  private:
    Context& c_;
    OneTimeCommands& once_;
    Memory staging_;
};

} // namespace wadi::vulkan
