// How long the stages of timed steps take.
#pragma once
#include "engine/step/run/world_state.hpp"

namespace wadi {

/// Mean time of a stage per water step.
struct StageTime {
    std::string stage;
    double milliseconds = 0;
    int passes = 0;
};

class StepTimings {
  public:
    explicit StepTimings(WorldState& state) : state_(state) {}

    bool on() const { return on_; }
    /// Switched on, it begins anew.
    void set(bool on);
    /// A timed step was submitted.
    Status submitted(compute::Ticket ticket);
    /// Fetches what was submitted; waits for the device.
    Status collect() { return collect_to(0); }
    /// Begins anew: the plan is another one.
    void forget();
    /// Mean over the timed steps. Passes are those of the plan in force.
    Result<std::vector<StageTime>> stage_times();

  private:
    Status collect_to(std::size_t most_pending);

    WorldState& state_;
    bool on_ = false;
    std::vector<compute::Ticket> pending_;
    std::map<std::string, double> milliseconds_; // by stage
    std::uint64_t steps_ = 0;
};

} // namespace wadi
