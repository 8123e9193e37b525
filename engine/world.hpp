// A world: its state on a device, and the components that step it and answer for it. Each has a file of its own, and brings the
// world to a boundary between two steps where it needs one (Stepper::finish_step).
#pragma once
#include "engine/edits/command_log.hpp"
#include "engine/frames/frame_driver.hpp"
#include "engine/frames/outputs.hpp"
#include "engine/reads/checking.hpp"
#include "engine/reads/queries.hpp"
#include "engine/reads/state_reader.hpp"
#include "engine/saves/roll_back.hpp"
#include "engine/saves/snapshots.hpp"
#include "engine/step/run/stepper.hpp"

namespace wadi {

class World {
  public:
    /// Checks settings and fields, derives the effects, allocates and records. Errors: bad_argument, out_of_memory, and
    /// not_supported for a grid larger than the device's buffers.
    /// `group`: threads per group on GPU backends, 0 = the backend's choice; it changes no bit.
    static Result<std::unique_ptr<World>> create(const Settings& settings, const InitialFields& fields,
                                                 std::unique_ptr<compute::Device> device, compute::GroupSize group = {});

    /// Where the world tells what happens to it (WorldState::log), limits at work among it, for which it looks from now on.
    /// Errors: those of Limits::watch().
    Status set_log(compute::Log log);

    /// Submits water steps beside the clock of update(); returns before the device has finished them. A step that an update began
    /// in parts is finished first and counts as that update's.
    Status step(std::uint32_t count);
    /// Submits the water steps that fall due after `nanoseconds` more of host time, and what outputs() publishes; returns at
    /// once.
    Status update(std::uint64_t nanoseconds, Frame& frame);
    Status set_update_settings(const UpdateSettings& settings);

    /// What the world is: effects, buffers, whether its device is lost.
    const WorldState& state() const { return state_; }
    const Settings& settings() const { return state_.settings(); }
    const StepPlan& plan() const { return state_.plan(); }
    compute::Device& device() const { return *state_.device(); }
    std::uint64_t steps() const { return state_.steps; }
    /// Simulated [s].
    double time() const { return static_cast<double>(state_.steps) * settings().dt; }

    /// Compiling ahead, profiling, a step in parts.
    Stepper& stepper() { return stepper_; }
    Outputs& outputs() { return outputs_; }
    const Limits& limits() const { return limits_; }
    /// Fields, statistics, hash.
    StateReader& reader() { return reader_; }
    /// Whether the state keeps what the solver promises.
    Checking& checking() { return checking_; }
    Snapshots& snapshots() { return snapshots_; }
    RollBack& roll_back() { return roll_back_; }
    Queries& queries() { return queries_; }
    /// Images to stamp.
    Edits& edits() { return edits_; }
    /// Everything that a host does to the running world.
    CommandLog& commands() { return commands_; }

  private:
    World(const Settings& settings, std::unique_ptr<compute::Device> device, compute::GroupSize group);
    /// Stepper::Hooks.
    Status before_step();
    Status after_step();
    std::uint64_t undisturbed(std::uint64_t most) const;
    Status jumped();
    /// What waited for a boundary between two steps.
    Status at_boundary();

    WorldState state_; // first: the components refer to it
    Stepper stepper_{state_};
    FrameDriver frames_{state_, stepper_};
    Outputs outputs_{state_};
    Limits limits_{state_};
    StateReader reader_{state_, stepper_, limits_};
    Checking checking_{state_, stepper_, reader_};
    RollBack roll_back_{state_, stepper_};
    Snapshots snapshots_{state_, stepper_, roll_back_};
    Edits edits_{state_, stepper_};
    Queries queries_{state_, stepper_};
    ValueWrites values_{state_, stepper_};
    SourceChanges sources_{state_, stepper_};
    CommandLog commands_{state_, stepper_, edits_, values_, sources_};
};

/// The plan as text: effects and reasons, passes, buffers, bytes per cell.
std::string describe_plan(const WorldState& world);

} // namespace wadi
