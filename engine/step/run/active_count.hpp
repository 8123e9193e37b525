// How many active tiles a step ran over, as the host learns it: a step or more late, and without waiting. A world in which none
// is active any more is asleep: its steps submit nothing.
#pragma once
#include "engine/step/run/world_state.hpp"

namespace wadi {

/// The tiles that the newest step ran over, per list of tiles: the water's or the only one, then the sand's. Waits for the
/// device.
Result<std::vector<std::uint32_t>> read_active_counts(WorldState& state);

class ActiveCount {
  public:
    explicit ActiveCount(WorldState& state) : state_(state) {}
    /// Appends the copy of the count to the program of a turn, behind the passes that make the list.
    Status append(compute::ProgramBuilder& builder, int turn);
    /// A step was submitted, `woken` with tiles that its input wakes.
    void submitted(int turn, compute::Ticket ticket, bool woken);
    /// The newest submission whose count has arrived, 0 = none, and that count, of the longer list.
    struct Newest {
        std::uint64_t ticket;
        std::uint32_t count;
    };
    Newest newest();
    /// A submission that nothing has woken since has finished and ran over no tile.
    bool asleep();

  private:
    struct Slot {
        compute::Buffer buffer;
        compute::Ticket ticket; // of the newest submission; 0 = none
    };
    WorldState& state_;
    std::array<Slot, 2> slots_{};
    std::uint64_t woken_ = 0, seen_ = 0; // tickets: of the newest submission that woke tiles, and of the newest count
    std::uint32_t newest_ = 1;
    bool two_lists_ = false; // in the newest submission
};

} // namespace wadi
