#include "engine/frames/step_clock.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {

constexpr std::uint64_t most_held = std::uint64_t{1} << 62;

} // namespace

StepClock::StepClock(double dt) {
    double whole = 0;
    const double rest = std::modf(dt * 1e9, &whole);
    period_ = static_cast<std::uint64_t>(whole);
    period_fraction_ = static_cast<std::uint64_t>(std::ldexp(rest, 64));
}

std::uint64_t StepClock::add(std::uint64_t nanoseconds) {
    const std::uint64_t paid = std::min(nanoseconds, owed_);
    owed_ -= paid;
    nanoseconds -= paid;
    const std::uint64_t fits = std::min(nanoseconds, most_held - since_);
    since_ += fits;
    return nanoseconds - fits;
}

void StepClock::take_back(std::uint64_t nanoseconds) {
    const std::uint64_t held = std::min(nanoseconds, since_);
    since_ -= held;
    owed_ += nanoseconds - held;
}

std::uint64_t StepClock::to_next() const {
    const std::uint64_t fraction = fraction_ + period_fraction_; // wraps: a carry
    return period_ + (fraction < fraction_ ? 1 : 0) + (fraction != 0 ? 1 : 0);
}

void StepClock::take() {
    const std::uint64_t fraction = fraction_ + period_fraction_;
    since_ -= period_ + (fraction < fraction_ ? 1 : 0);
    fraction_ = fraction;
}

std::uint64_t StepClock::drop() {
    if (!due()) return 0;
    const std::uint64_t dropped = since_ - (to_next() - 1);
    since_ -= dropped;
    return dropped;
}

double StepClock::share_of_step() const {
    const double period = static_cast<double>(period_) + std::ldexp(static_cast<double>(period_fraction_), -64);
    const double since = static_cast<double>(since_) - std::ldexp(static_cast<double>(fraction_), -64);
    return std::clamp(since / period, 0.0, std::nextafter(1.0, 0.0));
}

} // namespace wadi
