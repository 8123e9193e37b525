// A world: state on a device, the programs that step it, and what can be asked of it.
#pragma once
#include "engine/compute/device.hpp"
#include "engine/effects.hpp"
#include "engine/include/wadi/settings.hpp"
#include "engine/step_inputs.hpp"
#include "engine/step_plan.hpp"
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace wadi {

/// Signed count of ledger quanta moved since creation.
struct Ledger {
    std::int64_t water_in = 0, water_out = 0, sand_in = 0, sand_out = 0, refused = 0;
};

/// The state now; see wadi_world_stats in the plugin's header for meaning and units.
struct WorldStats {
    std::int64_t sand_quanta = 0, water_quanta = 0, sand_initial = 0, water_initial = 0;
    Ledger ledger;
    double quantum = 0;
    double largest_sand = 0, largest_water = 0, largest_water_speed = 0, largest_sand_speed = 0, smallest_height = 0;
    std::uint64_t not_finite = 0, clamped_faces = 0, capped_faces = 0, limited_cells = 0, hash = 0;
};

/// Mean time of a stage per water step.
struct StageTime {
    std::string stage;
    double milliseconds = 0;
    int passes = 0;
};

/// The state of a world between two steps: current buffers of all state fields with their ghosts, ledgers, running totals.
struct Snapshot {
    std::uint64_t steps = 0;
    std::uint32_t effects = 0;
    std::map<std::string, std::vector<std::uint32_t>> fields; // words as they lie on the device
    StepInputs::Totals totals;
};

class World {
  public:
    /// Checks settings and fields, derives the effects, allocates and records. Errors: bad_argument, out_of_memory, and
    /// not_supported for a grid larger than the device's buffers.
    /// `group`: threads per group on GPU backends, 0 = the backend's choice; it changes no bit.
    static Result<std::unique_ptr<World>> create(const Settings& settings, const InitialFields& fields,
                                                 std::unique_ptr<compute::Device> device, compute::GroupSize group = {});
    ~World();

    /// Submits water steps; returns before the device has finished them.
    Status step(std::uint32_t count);
    std::uint64_t steps() const { return steps_; }
    double time() const { return static_cast<double>(steps_) * settings_.dt; }

    /// nx * ny floats of a field by its plan name ("water_height", ...), at cell centres for velocities, or of a published
    /// field ("water_depth", "free_surface", "surface_saturation"). A field the mask lacks is zero. Waits for the device.
    Status read(const std::string& name, std::span<float> values);
    Result<WorldStats> stats();

    /// Everything that the next step depends on, to the bit. Survives the loss of the device.
    Result<Snapshot> snapshot();
    /// Goes back (or on) to a snapshot of a world with the same settings and fields. Errors: bad_argument where it does not fit.
    Status restore(const Snapshot& snapshot);

    Status set_profiling(bool on);
    /// Mean over the steps since profiling was switched on.
    Result<std::vector<StageTime>> stage_times();

    const Settings& settings() const { return settings_; }
    const StepPlan& plan() const { return plan_; }
    const EffectChoice& effects() const { return effects_; }
    const compute::Device& device() const { return *device_; }
    compute::Device& device() { return *device_; }
    std::uint64_t device_bytes() const { return device_bytes_; }
    /// The plan as text: effects and reasons, passes, buffers, bytes per cell.
    std::string describe_plan() const;

    /// For tests: the raw field with ghosts at its current parity.
    Result<std::vector<float>> read_raw(const std::string& field);

  private:
    using Parity = std::set<std::string>; // ping-pong fields whose second buffer is the current one

    World(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group);
    Status allocate();
    std::uint64_t field_bytes(const PlanField& field) const;
    Status upload(const InitialFields& fields);
    Status record_steps();
    Result<compute::Buffer> make_buffer(const std::string& label, std::uint64_t bytes);
    compute::Buffer buffer(const std::string& name, const Parity& parity) const;
    Status append(compute::ProgramBuilder& builder, const PlanPass& pass, Parity& parity);
    /// Appends one stage outside the plan, its slots by name.
    Status append_stage(compute::ProgramBuilder& builder, const char* stage, const std::map<std::string, std::string>& names);
    Result<compute::Program> record_step(Parity& parity, bool timestamps);
    Status publish(const char* stage, const std::map<std::string, std::string>& names);
    Status read_cells(compute::Buffer from, std::span<float> values);
    Result<std::vector<float>> read_buffer(compute::Buffer from);
    Result<Ledger> read_ledger();
    Status collect_timings(bool all);
    Status note(Status status);

    Settings settings_;
    FieldLayout layout_;
    WorldParams params_{};
    EffectChoice effects_;
    StepPlan plan_;
    std::unique_ptr<compute::Device> device_;
    compute::GroupSize group_;
    StepInputs inputs_;
    std::map<std::string, std::array<compute::Buffer, 2>> buffers_; // state, ledger, shapes
    std::vector<compute::Buffer> scratch_;
    std::array<compute::Buffer, 3> output_{}; // published fields, made when first asked for
    std::array<compute::Program, 2> step_programs_{}, timed_programs_{};
    std::array<Parity, 2> start_parity_{}; // the state each program starts from
    int parity_ = 0;
    std::uint64_t steps_ = 0, device_bytes_ = 0;
    std::int64_t sand_initial_ = 0, water_initial_ = 0;
    bool profiling_ = false;
    std::vector<compute::Ticket> pending_timings_;
    std::map<std::string, double> stage_milliseconds_;
    std::uint64_t timed_steps_ = 0;
    Status lost_; // sticky once the device is lost
};

} // namespace wadi
