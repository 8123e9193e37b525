// The queue of submissions in flight: tickets, their completion, and the input of each step.
#pragma once
#include "backends/cuda/memory.hpp"
#include "engine/compute/program.hpp"
#include <array>
#include <span>

namespace wadi::cuda {

class Submissions {
  public:
    /// Submissions in flight at most; also the number of copies of anything that one submission must own.
    static constexpr std::size_t most_in_flight = 32;

    explicit Submissions(Context& context) : c_(context) {}
    ~Submissions();
    Submissions(const Submissions&) = delete;
    Submissions& operator=(const Submissions&) = delete;
    Status open();

    /// Device address of the inputs of the submission that runs.
    const StepInput* inputs() const { return reinterpret_cast<const StepInput*>(inputs_.data); }
    /// The slot of the next submission, once its previous occupant has finished.
    Result<std::size_t> acquire();
    /// Brings the inputs to the device, after everything submitted before. The slot's work follows on the stream, then finish().
    Status begin(std::size_t slot, std::span<const StepInput> inputs);
    Result<compute::Ticket> finish(std::size_t slot, compute::Program program);

    /// Errors: device_lost.
    Result<bool> finished(compute::Ticket ticket);
    Status wait(compute::Ticket ticket);
    /// The program that a ticket ran; null once its slot is in use again.
    compute::Program program_of(compute::Ticket ticket) const;
    static std::size_t slot_of(std::uint64_t ticket) { return static_cast<std::size_t>(ticket % most_in_flight); }

  private:
    struct Slot {
        cudaEvent_t done = nullptr;
        compute::Program program;
        std::uint64_t ticket = 0;
    };

    Context& c_;
    Memory inputs_;
    StepInput* staging_ = nullptr; // page-locked, most_inputs per slot
    std::array<Slot, most_in_flight> slots_;
    std::uint64_t last_ = 0;     // newest ticket given out
    std::uint64_t finished_ = 0; // newest ticket known to have finished
};

} // namespace wadi::cuda
