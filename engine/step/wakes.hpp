// Active tiles: what a step's or an edit's input can change by itself, and so must be awake for.
#pragma once
#include "engine/step/world_state.hpp"
#include <optional>

namespace wadi {

/// Wakes the tiles of sources with a depth in this step, all of them where it rains or water evaporates, and the rim of a side
/// whose value is another than in the last submitted step.
class InputWakes {
  public:
    explicit InputWakes(WorldState& state) : state_(state) {}
    void wake(const StepInput& input);

  private:
    void wake_sources(const StepInput& input);
    void wake_sides(const StepInput& input);

    WorldState& state_;
    std::optional<StepInput> before_;
};

/// Wakes the tiles that the edits of a submission of apply_edits reach.
void wake_edits(WorldState& state, const StepInput& input);

} // namespace wadi
