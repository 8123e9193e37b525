// What a change of the plan replaces, kept until the new one is settled.
#pragma once
#include "engine/step/run/step_programs.hpp"
#include <algorithm>

namespace wadi {

/// Takes the programs and notes the state. All is as it was before unless the change is settled.
class PlanChange {
  public:
    PlanChange(WorldState& state, StepPrograms& programs)
        : state_(state), programs_(programs), before_(state.now()), ways_(programs.take()) {}
    ~PlanChange() {
        if (settled_) return;
        programs_.put(std::move(ways_));
        state_.go_back(std::move(before_));
    }
    PlanChange(const PlanChange&) = delete;
    PlanChange& operator=(const PlanChange&) = delete;

    /// Whether steps ran in parts: as they will go on to, their programs are recorded with the others.
    bool had_parts() const {
        return std::any_of(ways_.begin(), ways_.end(),
                           [](const StepPrograms::Programs& way) { return !way.parts[0].empty() || !way.parts[1].empty(); });
    }
    void settle() noexcept {
        auto recorded = programs_.take();
        programs_.put(std::move(ways_));
        programs_.put(std::move(recorded)); // destroys those from before
        settled_ = true;
    }

  private:
    WorldState& state_;
    StepPrograms& programs_;
    WorldState::Replaced before_;
    StepPrograms::Ways ways_;
    bool settled_ = false;
};

} // namespace wadi
