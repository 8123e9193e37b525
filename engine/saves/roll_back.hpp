// Earlier states on the device, to go back to.
#pragma once
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"

namespace wadi {

class RollBack {
  public:
    static constexpr std::uint32_t most_kept = 256;

    RollBack(WorldState& state, Stepper& stepper) : state_(state), stepper_(stepper) {}

    /// Keeps the newest `frames` of: the state between two steps now, and every step that is a multiple of `interval`. 0 frames
    /// frees everything. What was kept is forgotten. Errors: bad_argument, out_of_memory (roll-back is then off).
    Status set(std::uint32_t frames, std::uint32_t interval);
    /// Steps that can be gone back to, oldest first.
    std::vector<std::uint64_t> steps() const;
    /// Goes to the newest kept step <= `step`, which it returns, and forgets the later ones, as it does edits and commands that
    /// wait. Parts of a step are given up. Waits only where material or sources were others then. Errors: bad_argument (nothing
    /// so old is kept), those of Stepper::change().
    Result<std::uint64_t> go_back(std::uint64_t step);
    /// Keeps the state if its step is due.
    Status after_step();
    /// `most`, or fewer steps: those to the next boundary that is kept.
    std::uint64_t undisturbed(std::uint64_t most) const;
    /// The state has another past now: forgets all that was kept and keeps the state as it is.
    Status restart();

  private:
    struct Earlier {
        explicit Earlier(WorldDevice& device) : copies(device) {}
        bool kept = false;
        std::uint32_t effects = 0;
        LiveSettings live;
        HostTotals totals;
        NamedBuffers copies; // of the kept fields
        std::unique_ptr<StateProgram> keep, restore;
    };

    Status fit();
    Status fit(Earlier& earlier, std::size_t number);
    Status keep();
    void clear();

    WorldState& state_;
    Stepper& stepper_;
    std::vector<Earlier> earlier_;
    std::uint32_t interval_ = 1;
    std::uint64_t recording_ = 0; // that the copies' buffers fit
};

} // namespace wadi
