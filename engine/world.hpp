// A world: its state on a device, and the parts that step it and answer for it. Each part has a file of its own.
#pragma once
#include "engine/edits/command_log.hpp"
#include "engine/frames/frame_driver.hpp"
#include "engine/frames/outputs.hpp"
#include "engine/reads/queries.hpp"
#include "engine/reads/state_reader.hpp"
#include "engine/saves/roll_back.hpp"
#include "engine/saves/snapshots.hpp"
#include "engine/step/stepper.hpp"

namespace wadi {

class World {
  public:
    /// Checks settings and fields, derives the effects, allocates and records. Errors: bad_argument, out_of_memory, and
    /// not_supported for a grid larger than the device's buffers.
    /// `group`: threads per group on GPU backends, 0 = the backend's choice; it changes no bit.
    static Result<std::unique_ptr<World>> create(const Settings& settings, const InitialFields& fields,
                                                 std::unique_ptr<compute::Device> device, compute::GroupSize group = {});

    /// Where the world tells what happens to it; WorldState::log.
    void set_log(compute::Log log) { state_.log = std::move(log); }

    /// Submits water steps beside the clock of update(); returns before the device has finished them. A step that an update began
    /// in parts is finished first and counts as that update's.
    Status step(std::uint32_t count);
    /// Submits the water steps that fall due after `nanoseconds` more of host time, and what outputs() publishes; returns at
    /// once.
    Status update(std::uint64_t nanoseconds, Frame& frame);
    Status set_update_settings(const UpdateSettings& settings);
    Outputs& outputs() { return outputs_; }
    std::uint64_t steps() const { return state_.steps; }
    double time() const { return static_cast<double>(state_.steps) * settings().dt; }

    /// Fields, statistics and hash of the state between two steps: what is left of a step begun in parts is done first.
    Status read(const std::string& name, std::span<float> values);
    Status read(const std::string& name, const Region& region, std::span<float> values);
    Result<WorldStats> stats();
    Result<std::vector<float>> read_raw(const std::string& field);

    /// The hash of the statistics alone.
    Result<std::uint64_t> hash();

    /// Everything that the next step depends on, to the bit (snapshot_format.hpp). `to` has snapshots().bytes() bytes.
    Status save(std::span<std::byte> to);
    /// Goes back (or on) to a snapshot of a world of the same level; errors: Snapshots::load. Edits that wait and frames kept for
    /// roll-back belong to another past: they are forgotten.
    Status load(std::span<const std::byte> from);
    Snapshots& snapshots() { return snapshots_; }

    const RollBack& roll_back() const { return roll_back_; }
    /// Goes to the newest kept step <= `step`; errors: RollBack::go_back. Edits that wait are forgotten.
    Result<std::uint64_t> roll_back_to(std::uint64_t step);
    /// RollBack::set for the state between two steps.
    Status set_rollback(std::uint32_t frames, std::uint32_t interval);
    Queries& queries() { return queries_; }

    /// Edits queued for their steps; heights written and effects dropped between two steps; the log of all that
    /// (command_log.hpp).
    Status edit(std::span<const Edit> edits) { return commands_.edit(edits); }
    Status write_region(EditLayer layer, const Region& region, std::span<const float> values);
    Status trim();
    /// A number of the material, by its index in material_keys(), from the next step on.
    Status set_material(int key, double value);
    /// Compiles now what edits of new materials would need later.
    Status prepare() { return stepper_.prepare(); }
    Edits& edits() { return edits_; }
    CommandLog& commands() { return commands_; }

    Status set_profiling(bool on) { return stepper_.set_profiling(on); }
    /// Mean over the steps since profiling was switched on.
    Result<std::vector<StageTime>> stage_times() { return stepper_.stage_times(); }

    Stepper& stepper() { return stepper_; }
    const Settings& settings() const { return state_.settings(); }
    const StepPlan& plan() const { return state_.plan(); }
    const EffectChoice& effects() const { return state_.effects(); }
    /// device_lost with its text once the device is lost.
    const Status& lost() const { return state_.lost(); }
    compute::Device& device() const { return *state_.device(); }
    std::uint64_t device_bytes() const { return state_.device().bytes(); }
    const std::vector<MemoryItem>& memory() const { return state_.device().memory(); }
    /// The plan as text: effects and reasons, passes, buffers, bytes per cell.
    std::string describe_plan() const;

  private:
    World(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group)
        : state_(settings, std::move(device), group) {
        stepper_.set_before_step([this] { return edits_.before_step(); });
        stepper_.set_after_step([this] {
            auto status = roll_back_.after_step();
            return status ? at_boundary() : status;
        });
    }
    /// Brings the world to a boundary between two steps.
    Status finish_step();
    /// What waits for such a boundary.
    Status at_boundary();

    WorldState state_; // first: the parts refer to it
    Stepper stepper_{state_};
    FrameDriver frames_{state_, stepper_};
    Outputs outputs_{state_};
    StateReader reader_{state_};
    Snapshots snapshots_{state_, stepper_};
    Edits edits_{state_, stepper_};
    RollBack roll_back_{state_, stepper_};
    Queries queries_{state_, stepper_};
    CommandLog commands_{state_, stepper_, edits_};
};

} // namespace wadi
