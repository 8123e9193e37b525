// The recorded programs of a world's steps: whole ones, timed ones, runs of many and parts of one, for each turn.
#pragma once
#include "engine/step/run/active_count.hpp"
#include "engine/step/run/world_state.hpp"

namespace wadi {

class StepPrograms {
  public:
    StepPrograms(WorldState& state, ActiveCount& active) : state_(state), active_(active) {}

    /// Steps of one run: even, so that one program does for a turn.
    static constexpr int run_steps = compute::most_inputs;
    static_assert(WATER_SUBSTEPS_MOST <= compute::most_inputs);
    /// Parts of a step: N of the water and T of the sand, or N without sand.
    int parts() const {
        const auto& plan = state_.plan();
        return plan.water_substeps + (plan.substep_passes.empty() ? 0 : plan.substeps);
    }

    /// Records the whole steps of the state's plan, and of the other one where it has two, and which buffers are current before
    /// each; parts and timed steps of the plan in force, too, where they are asked for.
    Status record(bool with_parts, bool timed);

    /// By turn, of the plan in force. Those that record() did not make are recorded when they are first asked for.
    compute::Program step(std::size_t turn) { return now().steps[turn]; }
    Result<compute::Program> timed(std::size_t turn);
    Result<compute::Program> run(std::size_t turn);
    /// Water substeps, the first with the plan's start passes at a world's beginning, then sand substeps.
    Result<compute::Program> part(std::size_t turn, std::size_t part, bool start);

    /// All programs of all plans.
    struct Programs {
        std::array<compute::Program, 2> steps{}, timed{}, runs{};
        std::array<std::vector<compute::Program>, 2> parts;
        std::array<compute::Program, 2> starts{}; // the first water part of step 0
    };
    using Ways = std::array<Programs, 2>; // of the plan without active tiles and of the one with them
    /// Hands them out and has none from then on.
    Ways take() noexcept { return std::exchange(ways_, {}); }
    /// Has these in place of its own, which are destroyed.
    void put(Ways ways) noexcept;

  private:
    Programs& now() { return ways_[state_.plan().active_tiles ? 1 : 0]; }
    void drop() noexcept;
    Status append_step(compute::ProgramBuilder& builder, int turn, Parity& parity, bool timestamps);
    Result<compute::Program> record_step(int turn, Parity& parity, bool timestamps);
    Result<compute::Program> record_run(int turn);
    Result<compute::Program> record_part(int part, bool start, int turn, Parity& parity);
    Status record_parts(std::size_t turn);
    Status record_timed();
    Status record_way(bool with_parts);

    WorldState& state_;
    ActiveCount& active_;
    Ways ways_;
};

} // namespace wadi
