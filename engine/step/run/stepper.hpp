// Runs the step plan: a water step is one program for each of the two buffer parities, or one water part and T sand parts. Many
// steps with nothing between them go to the device in runs of run_steps.
#pragma once
#include "engine/step/run/active_count.hpp"
#include "engine/step/run/step_inputs.hpp"
#include "engine/step/run/tile_choice.hpp"
#include "engine/step/run/world_state.hpp"
#include <functional>

namespace wadi {

/// Mean time of a stage per water step.
struct StageTime {
    std::string stage;
    double milliseconds = 0;
    int passes = 0;
};

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
    /// Steps of one submission: even, so that one program does for a turn.
    static constexpr int run_steps = compute::most_inputs;
    /// Submits the next of a water step's parts: the water passes, then each sand substep. The same bits as step().
    Status step_part();
    /// Parts of a water step: 1 + T, or 1 without sand.
    int parts() const;
    /// Parts of the present step already submitted; 0 between two steps.
    int parts_done() const { return parts_done_; }
    /// Of the newest submission; null before the first.
    compute::Ticket ticket() const { return ticket_; }

    /// Other numbers for sand and water from the next step on, and effects for what the world holds from now on; between two
    /// steps only. Where that changes the mask, buffers are allocated and freed and everything is recorded anew, the state kept
    /// to the bit; no pipeline is built where it does not. `then` runs under the new plan; nothing that it leaves undone can
    /// fail. Errors: out_of_memory, not_ready (inside a recording), those of `then`. An error or an exception leaves all as it
    /// was.
    Status change(const Material& material, Content content, const std::function<Status()>& then = {});
    Status set_content(Content content) { return change(state_.settings().material, content); }
    Status set_material(const Material& material) { return change(material, state_.content); }

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
    Result<std::vector<StageTime>> stage_times();

  private:
    /// By turn.
    struct Programs {
        std::array<compute::Program, 2> steps{}, timed{}, runs{};
        std::array<std::vector<compute::Program>, 2> parts;
        std::array<compute::Program, 2> starts{}; // the water part of step 0
    };

    class Change;

    Status append_step(compute::ProgramBuilder& builder, int turn, Parity& parity, bool timestamps);
    Result<compute::Program> record_step(int turn, Parity& parity, bool timestamps);
    Result<compute::Program> record_run(int turn);
    /// The timed programs of the plan in force.
    Status record_timed();
    Result<compute::Program> record_part(int part, bool start, int turn, Parity& parity);
    Status record_parts(std::size_t turn);
    Status record_start(std::size_t turn);
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
    Status collect_timings(bool all);
    void drop_programs() noexcept;
    /// Of the plan in force.
    Programs& programs() { return programs_[state_.plan().active_tiles ? 1 : 0]; }
    Status record_way(bool with_parts);
    Status record_ways(bool with_parts);
    /// In a world that chooses whether steps run over active tiles: goes to the better way where that is possible.
    void choose_tiles();
    /// The input of the step that comes, with the tiles that it wakes.
    StepInput next_input();
    bool may_sleep(const StepInput& input);
    void note_submitted(bool woken, int steps);

    WorldState& state_;
    StepInputs inputs_;
    ActiveCount active_{state_};
    bool asleep_ = false;              // the present step submits nothing
    std::array<Programs, 2> programs_; // of the plan without active tiles and of the one with them
    std::array<StepInput, run_steps> run_inputs_{};
    TileChoice choice_;
    int parts_done_ = 0;
    compute::Ticket ticket_;
    StepInput input_{}; // of the present step
    Hooks hooks_;
    bool profiling_ = false;
    std::vector<compute::Ticket> pending_timings_;
    std::map<std::string, double> stage_milliseconds_;
    std::uint64_t timed_steps_ = 0;
};

} // namespace wadi
