// Turns the host's frames into water steps: fixed dt, bounded work per frame, never waiting for a slow device.
#pragma once
#include "engine/frames/step_clock.hpp"
#include "engine/step/run/stepper.hpp"
#include <array>

namespace wadi {

struct UpdateSettings {
    std::uint32_t max_steps_per_update = 8; // 1 ... 1024
    std::uint32_t max_steps_in_flight = 8;  // water steps that the device has not finished, 0 ... 64; 0 = no limit: may wait
    bool spread = false;                    // a step is submitted in its 1 + T parts, evenly over its dt
    bool interpolate_outputs = false;       // see Outputs
};

/// What one update did.
struct Frame {
    std::uint32_t steps = 0;         // water steps that became whole in this update
    std::uint64_t total_steps = 0;   // whole water steps since creation
    double time = 0;                 // simulated [s]
    double interpolation = 0;        // [0, 1): from the last step but one to the last
    std::uint64_t dropped = 0;       // host time that became no step, in this update [ns]
    std::uint64_t dropped_total = 0; // and since creation [ns]
};

class FrameDriver {
  public:
    FrameDriver(WorldState& state, Stepper& stepper) : state_(state), stepper_(stepper), clock_(state.settings().dt) {}

    /// Errors: bad_argument (out of range); the settings stay as they were.
    Status set(const UpdateSettings& settings);
    const UpdateSettings& settings() const { return settings_; }

    /// Submits the whole steps due after `nanoseconds` more of host time. Where that fails the time was not taken.
    Status take_steps(std::uint64_t nanoseconds, Frame& frame);
    /// The update that took this time fails: repeated, it takes what steps are left of it.
    void take_back(std::uint64_t nanoseconds) { clock_.take_back(nanoseconds); }
    /// With `spread`: submits the parts of the next step that are due already. After the outputs were published.
    Status begin_parts();

    /// The step whose parts were being submitted was finished ahead of its time (someone had to see a whole step).
    void finished_early() { ahead_ = true; }
    /// The state went back to an earlier step: nothing is ahead of the clock any more.
    void went_back() { ahead_ = false; }

  private:
    static constexpr std::uint32_t most_steps_in_flight = 64;

    bool device_keeps_up();
    bool queue_has_room() const;
    Status take_due(Frame& frame);
    Status take_step(bool& taken);
    /// Whether so many steps are due at once, and the device may have them, that they go to it as one run.
    bool run_is_due(std::uint32_t taken);
    Status take_run();
    void tell_of_dropped_time(const Frame& frame);

    WorldState& state_;
    Stepper& stepper_;
    UpdateSettings settings_;
    StepClock clock_;
    bool ahead_ = false;                                // the next step of the clock is done already
    std::uint64_t dropped_total_ = 0, given_total_ = 0; // of the host's time [ns]
    double tell_at_ = 0;                                // once so much is dropped [s]; 0: never told
    // Tickets of whole steps that may be unfinished: places used in turn from oldest_ to newest_, both counting up.
    std::array<compute::Ticket, most_steps_in_flight> tickets_{};
    std::uint64_t oldest_ = 0, newest_ = 0;
};

} // namespace wadi
