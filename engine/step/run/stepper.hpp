// Runs the step plan: a step is one program for each of the two buffer parities, or N water parts and T sand parts. Many steps
// with nothing between them go to the device in runs of run_steps.
#pragma once
#include "engine/step/run/step_inputs.hpp"
#include "engine/step/run/step_programs.hpp"
#include "engine/step/run/step_timings.hpp"
#include "engine/step/run/tile_use.hpp"
#include <functional>

namespace wadi {

/// What a step boundary is besides the fields on the device.
struct HostTotals {
    std::uint64_t steps = 0;
    std::int64_t sand_initial = 0, water_initial = 0; // quanta the ledger began with
    StepInputs::Totals inputs;
};

class Stepper {
  public:
    explicit Stepper(WorldState& state) : state_(state), inputs_(state.settings()) {}

    /// Records the step programs for the state's plan, and which buffers are current before each. After a change of the plan too.
    Status record();
    /// Brings the world to a boundary between two steps: submits what is left of a step that was begun in parts. Every part that
    /// must see or change the state between two steps asks for it first. Errors: device_lost, and those of step().
    Status finish_step();
    /// Submits one whole water step, or what is left of one that was begun in parts. Nothing, where the world is asleep.
    Status step();
    /// Submits `count` whole water steps, in runs where the hooks allow it: the same bits as so many calls of step().
    Status steps(std::uint64_t count);
    /// Steps of one submission.
    static constexpr int run_steps = StepPrograms::run_steps;
    /// Submits the next of a step's parts: each water substep, then each sand substep. The same bits as step().
    Status step_part();
    /// Parts of a step: N + T, or N without sand.
    int parts() const { return programs_.parts(); }
    /// Parts of the present step already submitted; 0 between two steps.
    int parts_done() const { return parts_done_; }
    /// Of the newest submission; null before the first.
    compute::Ticket ticket() const { return ticket_; }

    /// Other numbers for sand, water and sources from the next step on, and effects for what the world holds from now on; between
    /// two steps only. Where that changes the mask, buffers are allocated and freed and everything is recorded anew, the state
    /// kept to the bit; no pipeline is built where it does not; where only what sources bring changes, nothing is recorded. A
    /// source in another place waits for the device. `then` runs under the new plan; nothing that it leaves undone can fail.
    /// Errors: out_of_memory, not_ready (inside a recording), those of `then`. An error or an exception leaves all as it was.
    Status change(const LiveSettings& live, Content content, const std::function<Status()>& then = {});
    Status set_content(Content content) { return change(state_.settings().live(), content); }
    Status set_material(const Material& material) { return change({material, state_.settings().sources}, state_.content); }

    /// For tests: with fewer rings of active tiles than the plan's reach calls for, bits must turn out wrong.
    Status set_tile_rings(int rings) {
        state_.set_tile_rings(rings);
        return record();
    }

    /// Compiles what any set_content() that the level allows would need.
    Status prepare();

    /// Who must hear of a step; all are set before the first one.
    struct Hooks {
        /// Ahead of the first pass of every step: edits.
        std::function<Status()> before_step;
        /// A step has become whole: work that was asked for in the middle of a step, or that is due every so many.
        std::function<Status()> after_step;
        /// Of the next `most` steps, how many none of the above would be heard between.
        std::function<std::uint64_t(std::uint64_t most)> undisturbed;
        /// finish_step() has submitted what was left of a step: the clock of frames is behind it.
        std::function<void()> finished_early;
        /// The world went to another step: what waits belongs to another past.
        std::function<Status()> jumped;
    };
    void set_hooks(Hooks hooks) { hooks_ = std::move(hooks); }

    HostTotals totals() const;
    /// Goes to another step boundary, whose kept fields the caller has written or submitted. Parts of a step are given up.
    Status go_to(const HostTotals& totals);

    Status set_profiling(bool on);
    /// Mean over the steps since profiling was switched on; steps in parts are not timed. Passes are those of the plan in force.
    Result<std::vector<StageTime>> stage_times() { return timings_.stage_times(); }

  private:
    Status record_programs(bool with_parts);
    /// Makes the step that comes the present one.
    Status begin();
    /// Whether the present step has the plan's start passes.
    bool starts() const { return state_.steps == 0 && !state_.plan().start_passes.empty(); }
    /// Whether the next steps can be a run: nothing is between them, none is timed, and the world is awake.
    bool can_run();
    /// Submits a run. Takes none, and is ok, where its program cannot be recorded now.
    Status run(bool& taken);
    Status submit_parts(int parts);
    Status finish(int parts);
    Status complete_step();
    int substeps() const { return state_.settings().method.water_substeps; }
    std::span<StepInput> inputs_of_step() { return {inputs_of_step_.data(), static_cast<std::size_t>(substeps())}; }
    /// The inputs of the step that comes, one for each of the water's substeps; the first has the tiles that they wake.
    void next_inputs(std::span<StepInput> inputs);

    WorldState& state_;
    StepInputs inputs_;
    TileUse tile_use_{state_};
    StepPrograms programs_{state_, tile_use_.count()};
    StepTimings timings_{state_};
    bool asleep_ = false; // the present step submits nothing
    std::array<StepInput, run_steps> run_inputs_{};
    int parts_done_ = 0;
    compute::Ticket ticket_;
    std::array<StepInput, WATER_SUBSTEPS_MOST> inputs_of_step_{}; // of the present step
    Hooks hooks_;
};

} // namespace wadi
