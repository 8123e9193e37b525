// The queue of submissions in flight: tickets, their completion, the commands that bring each step's input, the host's
// semaphores and images, and recording into the host's command buffer.
#pragma once
#include "backends/vulkan/buffers.hpp"
#include <array>
#include <vector>

namespace wadi::vulkan {

class Submissions final : public compute::HostSync {
  public:
    /// Submissions in flight at most; also the number of copies of anything that one submission must own.
    static constexpr std::uint32_t most_in_flight = 32;

    Submissions(Context& context, const Buffers& buffers) : c_(context), buffers_(buffers) {}
    ~Submissions();
    Submissions(const Submissions&) = delete;
    Submissions& operator=(const Submissions&) = delete;
    Status open();

    /// The uniform buffer that holds the inputs of the submission that runs, input_stride bytes apart.
    VkBuffer input_buffer() const { return inputs_.buffer; }
    static constexpr VkDeviceSize input_stride = 2304; // a multiple of every device's minUniformBufferOffsetAlignment
    /// The slot of the next submission, once its previous occupant has finished.
    Result<std::uint32_t> acquire();
    /// The slot's own command buffer, for programs that are recorded anew.
    VkCommandBuffer own_commands(std::uint32_t slot) const { return slots_[slot].own; }
    /// Numbers that a buffer gets ahead of a submission, at most 64 KiB.
    struct Update {
        VkBuffer to = VK_NULL_HANDLE; // null: none
        std::span<const std::byte> bytes;
    };
    /// Brings the inputs and the update, then runs `commands`, after everything submitted before.
    Result<compute::Ticket> submit(std::uint32_t slot, std::span<const StepInput> inputs, const Update& update,
                                   VkCommandBuffer commands, compute::Program program);

    Status wait_before(std::span<const compute::SyncPoint> points) override;
    Status signal_after(const compute::SyncPoint& point) override;
    /// Refused: CUDA's events are none of Vulkan's.
    Status wait_event(void* event) override;
    Status record_event(void* event) override;
    Result<compute::Ticket> copy_to_image(const compute::BufferRows& from, const compute::HostImage& to) override;
    Result<compute::Ticket> copy_from(const compute::HostRows& from, compute::Buffer to) override;
    /// Until end_recording() submit() records into `commands`; its programs' command buffers must then be secondary ones.
    Status begin_recording(void* commands, const compute::SyncPoint& promise) override;
    Status end_recording() override;
    bool recording() const { return host_commands_ != VK_NULL_HANDLE; }
    /// not_ready while recorded work has not run: what goes to the queue now would overtake it.
    Status check_order();

    /// Errors: device_lost.
    Result<bool> finished(compute::Ticket ticket);
    /// The newest ticket given out.
    std::uint64_t newest() const { return last_; }
    /// The newest one known to have finished, after a look.
    std::uint64_t look_for_finished() {
        static_cast<void>(finished({last_}));
        return finished_;
    }
    /// A recorded ticket that has not finished is not_ready: only the host can bring it about.
    Status wait(compute::Ticket ticket);
    /// The program that a ticket ran; null once its slot is in use again.
    compute::Program program_of(compute::Ticket ticket) const;
    static std::uint32_t slot_of(std::uint64_t ticket) { return static_cast<std::uint32_t>(ticket % most_in_flight); }

  private:
    struct Slot {
        VkCommandBuffer input = VK_NULL_HANDLE;
        VkCommandBuffer own = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE; // only without timeline semaphores
        compute::Program program;
        std::uint64_t ticket = 0;
        compute::SyncPoint promise; // of recorded work; semaphore 0 = went to the queue
    };
    Status record_inputs(const Slot& slot, std::span<const StepInput> inputs, const Update& update);
    /// Submits, or records, commands that run once: record(commands).
    template <class Record> Result<compute::Ticket> submit_once(Record record);
    /// Submits to the queue as the next ticket.
    Status send(const Slot& slot, std::span<const VkCommandBuffer> commands);
    /// Gives out the next ticket, for what was sent or recorded with this slot.
    compute::Ticket give_out(Slot& slot, compute::Program program);
    void record_boundary(VkCommandBuffer commands, std::span<const StepInput> inputs, const Update& update);
    Status check_timeline() const;
    Result<std::uint64_t> value_of(VkSemaphore semaphore);

    Context& c_;
    const Buffers& buffers_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE; // its value is the newest finished ticket
    Memory inputs_;
    std::array<Slot, most_in_flight> slots_;
    std::vector<VkSemaphore> wait_semaphores_; // of the next submission
    std::vector<std::uint64_t> wait_values_;
    VkCommandBuffer host_commands_ = VK_NULL_HANDLE; // while recording
    compute::SyncPoint promise_;
    std::uint64_t last_recorded_ = 0; // newest ticket that was recorded
    std::uint64_t last_ = 0;          // newest ticket given out
    std::uint64_t finished_ = 0;      // newest ticket known to have finished
};

} // namespace wadi::vulkan
