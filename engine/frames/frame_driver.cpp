#include "engine/frames/frame_driver.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>

namespace wadi {

namespace {

constexpr std::uint32_t most_steps_per_update = 1024;
// What an update may submit behind its steps: a look at limits, published outputs, their copies for the host, the interpolated
// set.
constexpr std::uint64_t reserved_submissions = 4;

Status check(const char* name, std::uint32_t value, std::uint32_t least, std::uint32_t most) {
    if (value >= least && value <= most) return ok_status();
    return error(Code::bad_argument, std::string("update settings: ") + name + ": " + std::to_string(value) + " is outside " +
                                         std::to_string(least) + " ... " + std::to_string(most));
}

// Sums of host time end at the largest number instead of wrapping.
std::uint64_t add(std::uint64_t a, std::uint64_t b) { return a + std::min(b, ~a); }

} // namespace

Status FrameDriver::set(const UpdateSettings& settings) {
    if (auto s = check("max_steps_per_update", settings.max_steps_per_update, 1, most_steps_per_update); !s) return s;
    if (auto s = check("max_steps_in_flight", settings.max_steps_in_flight, 0, most_steps_in_flight); !s) return s;
    settings_ = settings;
    return ok_status();
}

// Tickets count up from 1 and finish in order, so the one that has to be done before another submission fits has a known number.
bool FrameDriver::queue_has_room() const {
    auto& device = *state_.device();
    const std::uint64_t newest = device.counters().submits + 1 + reserved_submissions;
    const std::uint64_t depth = device.capabilities().queue_depth;
    return newest <= depth || device.finished({newest - depth});
}

bool FrameDriver::device_keeps_up() {
    if (settings_.max_steps_in_flight == 0) return true;
    while (oldest_ < newest_ && state_.device().finished(tickets_[oldest_ % most_steps_in_flight])) ++oldest_;
    return newest_ - oldest_ < settings_.max_steps_in_flight && queue_has_room();
}

// The next whole step, or what is left of one begun in parts; not taken where the device is too far behind.
Status FrameDriver::take_step(bool& taken) {
    taken = false;
    while (stepper_.parts_done() > 0) {
        if (!device_keeps_up()) return ok_status();
        if (auto status = stepper_.step_part(); !status) return status;
        taken = stepper_.parts_done() == 0;
    }
    if (!taken) {
        if (!device_keeps_up()) return ok_status();
        if (auto status = stepper_.step(); !status) return status;
        taken = true;
    }
    if (settings_.max_steps_in_flight != 0) tickets_[newest_++ % most_steps_in_flight] = stepper_.ticket();
    return ok_status();
}

bool FrameDriver::run_is_due(std::uint32_t taken) {
    constexpr std::uint32_t steps = Stepper::run_steps;
    if (ahead_ || stepper_.parts_done() > 0 || settings_.max_steps_per_update - taken < steps) return false;
    StepClock clock = clock_;
    for (std::uint32_t n = 0; n < steps; ++n) {
        if (!clock.due()) return false;
        clock.take();
    }
    return device_keeps_up() &&
           (settings_.max_steps_in_flight == 0 || newest_ - oldest_ + steps <= settings_.max_steps_in_flight);
}

Status FrameDriver::take_run() {
    auto status = stepper_.steps(Stepper::run_steps);
    for (int n = 0; status && n < Stepper::run_steps; ++n) {
        clock_.take();
        if (settings_.max_steps_in_flight != 0) tickets_[newest_++ % most_steps_in_flight] = stepper_.ticket();
    }
    return status;
}

// From a whole step on, since less may be a rounding of the host's, and again at ten times as much: a host that does not look at
// what it drops simulates less than it thinks.
void FrameDriver::tell_of_dropped_time(const Frame& frame) {
    const double seconds = static_cast<double>(dropped_total_) * 1e-9;
    if (!state_.log || seconds < std::max(tell_at_, state_.settings().dt)) return;
    tell_at_ = 10 * seconds;
    const bool most = frame.steps >= settings_.max_steps_per_update;
    const double share = 100 * seconds / (static_cast<double>(given_total_) * 1e-9);
    state_.tell(
        1,
        "updates have dropped " + at_most(seconds) + " s of the host's time so far, " + at_most(share) +
            " % of it; now because " +
            (most ? "it was more than max_steps_per_update (" + std::to_string(settings_.max_steps_per_update) + ") water steps"
                  : "the device had max_steps_in_flight (" + std::to_string(settings_.max_steps_in_flight) +
                        ") unfinished water steps or a full queue") +
            "; " +
            (most ? "update more often or raise it"
                  : "a host without frame pacing sets max_steps_in_flight to 0, which waits for the device in place of "
                    "dropping") +
            ". This is said again at ten times as much; wadi_frame counts what is dropped");
}

Status FrameDriver::take_steps(std::uint64_t nanoseconds, Frame& frame) {
    if (!state_.lost()) return state_.lost();
    frame = {};
    frame.dropped = clock_.add(nanoseconds);
    const std::uint64_t before = given_total_;
    given_total_ = add(given_total_, nanoseconds);
    auto status = take_due(frame);
    if (!status) take_back(nanoseconds);
    if (!status) given_total_ = before;
    return status;
}

Status FrameDriver::take_due(Frame& frame) {
    while (clock_.due()) {
        if (run_is_due(frame.steps)) {
            if (auto status = take_run(); !status) return status;
            frame.steps += Stepper::run_steps;
            continue;
        }
        bool taken = ahead_;
        if (ahead_) {
            ahead_ = false;
        } else if (frame.steps < settings_.max_steps_per_update) {
            if (auto status = take_step(taken); !status) return status;
            frame.steps += taken ? 1 : 0;
        }
        if (!taken) break;
        clock_.take();
    }
    frame.dropped = add(frame.dropped, clock_.drop());
    dropped_total_ = add(dropped_total_, frame.dropped);
    if (frame.dropped > 0) tell_of_dropped_time(frame);
    frame.dropped_total = dropped_total_;
    frame.total_steps = state_.steps;
    frame.time = static_cast<double>(state_.steps) * state_.settings().dt;
    frame.interpolation = clock_.share_of_step();
    return ok_status();
}

Status FrameDriver::begin_parts() {
    if (!settings_.spread || ahead_) return ok_status();
    // The last part falls due with the step itself.
    const int due = std::min(stepper_.parts() - 1, static_cast<int>(clock_.share_of_step() * stepper_.parts()));
    while (stepper_.parts_done() < due && device_keeps_up()) {
        if (auto status = stepper_.step_part(); !status) return status;
    }
    return ok_status();
}

} // namespace wadi
