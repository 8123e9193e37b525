// The ring of submissions in flight: tickets, their completion, and the commands that bring each step's input.
#pragma once
#include "backends/vulkan/vulkan_memory.hpp"
#include <array>

namespace wadi::vulkan {

class Submissions {
  public:
    /// Submissions in flight at most; also the number of copies of anything that one submission must own.
    static constexpr std::uint32_t ring = 32;

    explicit Submissions(Context& context) : c_(context) {}
    ~Submissions();
    Submissions(const Submissions&) = delete;
    Submissions& operator=(const Submissions&) = delete;
    Status open();

    /// The uniform buffer that holds the input of the step that runs.
    VkBuffer input_buffer() const { return input_.buffer; }
    /// The ring slot of the next submission, once its previous occupant has finished.
    Result<std::uint32_t> acquire();
    /// The slot's own command buffer, for programs that are recorded anew.
    VkCommandBuffer own_commands(std::uint32_t slot) const { return slots_[slot].own; }
    /// Brings the input, then runs `commands`, after everything submitted before.
    Result<compute::Ticket> submit(std::uint32_t slot, const StepInput& input, VkCommandBuffer commands,
                                   compute::Program program);

    /// Errors: bad_argument (a ticket that was never given out), device_lost.
    Result<bool> finished(compute::Ticket ticket);
    Status wait(compute::Ticket ticket);
    /// The program that a ticket ran; null once its slot is in use again.
    compute::Program program_of(compute::Ticket ticket) const;
    static std::uint32_t slot_of(std::uint64_t ticket) { return static_cast<std::uint32_t>(ticket % ring); }

  private:
    struct Slot {
        VkCommandBuffer input = VK_NULL_HANDLE;
        VkCommandBuffer own = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE; // only without timeline semaphores
        compute::Program program;
        std::uint64_t ticket = 0;
    };
    Status record_input(const Slot& slot, const StepInput& input);

    Context& c_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE; // its value is the newest finished ticket
    Memory input_;
    std::array<Slot, ring> slots_;
    std::uint64_t last_ = 0;     // newest ticket given out
    std::uint64_t finished_ = 0; // newest ticket known to have finished
};

} // namespace wadi::vulkan
