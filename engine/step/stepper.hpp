// Runs the step plan: a water step is one program for each of the two buffer parities, or one water part and T sand parts.
#pragma once
#include "engine/step/active_count.hpp"
#include "engine/step/step_inputs.hpp"
#include "engine/step/world_state.hpp"
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
    std::int64_t sand_initial = 0, water_initial = 0; // quanta the books began with
    StepInputs::Totals inputs;
};

class Stepper {
  public:
    explicit Stepper(WorldState& state) : state_(state), inputs_(state.settings()) {}

    /// Records the step programs for the state's plan, and which buffers are current before each. After a change of the plan too.
    Status record();
    /// Submits one whole water step, or what is left of one that was begun in parts. Nothing, where the world is asleep.
    Status step();
    /// Submits the next of a water step's parts: the water passes, then each sand substep. The same bits as step().
    Status step_part();
    /// Parts of a water step: 1 + T, or 1 without sand.
    int parts() const;
    /// Parts of the present step already submitted; 0 between two steps.
    int parts_done() const { return parts_done_; }
    /// Of the newest submission; null before the first.
    compute::Ticket ticket() const { return ticket_; }

    /// Chooses the effects for what the world holds from now on; between two steps only. Where that changes the mask, buffers are
    /// allocated and freed and everything is recorded anew, the state kept to the bit. Errors: out_of_memory, nothing changed.
    Status hold(Content content);

    /// Other numbers for sand and water from the next step on; between two steps only. Effects follow as in hold(); waits for the
    /// device, but builds no pipeline where they stay. Errors: out_of_memory, not_ready (inside a recording), nothing changed.
    Status set_material(const Material& material);

    /// For tests: with fewer rings of active tiles than the plan's reach calls for, bits must turn out wrong.
    Status set_tile_rings(int rings) {
        state_.set_tile_rings(rings);
        return record();
    }

    /// Compiles what any hold() that the level allows would need.
    Status prepare();

    /// Called ahead of the first pass of every step: edits.
    void set_before_step(std::function<Status()> call) { before_step_ = std::move(call); }
    /// Called whenever a step has become whole: work that was asked for in the middle of a step, or that is due every so many.
    void set_after_step(std::function<Status()> call) { after_step_ = std::move(call); }

    HostTotals totals() const;
    /// Goes to another step boundary. Parts already submitted are given up: the caller overwrites every kept field.
    void set_totals(const HostTotals& totals);

    Status set_profiling(bool on);
    /// Mean over the steps since profiling was switched on; steps in parts are not timed.
    Result<std::vector<StageTime>> stage_times();

    StepInputs& inputs() { return inputs_; }
    const StepInputs& inputs() const { return inputs_; }

  private:
    Result<compute::Program> record_step(int turn, Parity& parity, bool timestamps);
    Status record_parts(std::size_t turn);
    Status finish(int parts);
    Status begin_step();
    Status complete_step();
    Status collect_timings(bool all);
    void drop_programs();
    /// The input of the step that comes, with the tiles that it wakes.
    StepInput next_input();
    bool may_sleep(const StepInput& input);
    void note_submitted(const StepInput& input);

    WorldState& state_;
    StepInputs inputs_;
    ActiveCount active_{state_};
    bool asleep_ = false; // the present step submits nothing
    std::array<compute::Program, 2> programs_{}, timed_programs_{};
    std::array<std::vector<compute::Program>, 2> part_programs_;
    int parts_done_ = 0;
    compute::Ticket ticket_;
    StepInput input_{}; // of the step whose parts are being submitted
    std::function<Status()> before_step_, after_step_;
    bool profiling_ = false;
    std::vector<compute::Ticket> pending_timings_;
    std::map<std::string, double> stage_milliseconds_;
    std::uint64_t timed_steps_ = 0;
};

} // namespace wadi
