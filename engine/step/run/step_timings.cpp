#include "engine/step/run/step_timings.hpp"
#include <algorithm>

namespace wadi {

void StepTimings::set(bool on) {
    if (on && !on_) forget();
    on_ = on;
}

void StepTimings::forget() {
    milliseconds_.clear();
    steps_ = 0;
}

// The device keeps the timings of a few submissions only: fetch them as they finish.
Status StepTimings::submitted(compute::Ticket ticket) {
    constexpr std::size_t most_pending = 4;
    pending_.push_back(ticket);
    return collect_to(most_pending);
}

Status StepTimings::collect_to(std::size_t most_pending) {
    while (pending_.size() > most_pending) {
        const auto ticket = pending_.front();
        pending_.erase(pending_.begin());
        if (auto status = state_.device().wait(ticket); !status) return status;
        auto timings = state_.device().timings(ticket);
        if (!timings) return timings.status();
        for (const auto& timing : *timings) milliseconds_[timing.label] += timing.milliseconds;
        ++steps_;
    }
    return ok_status();
}

Result<std::vector<StageTime>> StepTimings::stage_times() {
    if (auto status = collect(); !status) return status;
    std::vector<StageTime> times;
    const auto add = [&](const PlanPass& pass, int repeats) {
        const std::string name(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name);
        auto found = std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == name; });
        if (found == times.end()) {
            const double total = milliseconds_.contains(name) ? milliseconds_[name] : 0;
            found = times.insert(times.end(), {name, steps_ > 0 ? total / static_cast<double>(steps_) : 0, 0});
        }
        found->passes += repeats;
    };
    for (std::size_t n = 0; n < state_.plan().water_passes.size(); ++n)
        add(state_.plan().water_passes[n], state_.plan().times(n));
    for (const auto& pass : state_.plan().substep_passes) add(pass, state_.plan().substeps);
    if (const auto& other = state_.other_plan()) {
        for (const auto* passes : {&other->water_passes, &other->substep_passes})
            for (const auto& pass : *passes) add(pass, 0);
    }
    return times;
}

} // namespace wadi
