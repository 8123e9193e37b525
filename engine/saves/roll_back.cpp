#include "engine/saves/roll_back.hpp"
#include <algorithm>

namespace wadi {

Status RollBack::set(std::uint32_t frames, std::uint32_t interval) {
    if (auto status = stepper_.finish_step(); !status) return status;
    if (frames > most_kept) {
        return error(Code::bad_argument,
                     "set_rollback: frames is " + std::to_string(frames) + ", allowed are 0 ... " + std::to_string(most_kept));
    }
    if (frames > 0 && interval == 0) return error(Code::bad_argument, "set_rollback: interval_steps is 0, allowed are 1 or more");
    clear();
    earlier_.reserve(frames); // programs refer to their place
    for (std::uint32_t n = 0; n < frames; ++n) earlier_.emplace_back(state_.device());
    interval_ = interval;
    recording_ = state_.fields().recording();
    auto status = ok_status();
    for (std::size_t n = 0; n < earlier_.size() && status; ++n) status = fit(earlier_[n], n);
    if (status) return restart();
    clear();
    return status;
}

void RollBack::clear() {
    for (auto& earlier : earlier_) {
        earlier.keep.reset();
        earlier.restore.reset();
        earlier.copies.keep_only({});
    }
    earlier_.clear();
}

// Gives an earlier state the buffers of the plan. A new one is zero, as the field was when the plan lacked it.
Status RollBack::fit(Earlier& earlier, std::size_t number) {
    const auto label = [number](const std::string& field) { return "roll-back " + std::to_string(number) + " " + field; };
    std::vector<compute::BufferDesc> wanted;
    for (const auto& field : state_.fields().kept()) wanted.push_back({field.bytes, label(field.name)});
    earlier.copies.keep_only(wanted);
    if (auto status = earlier.copies.keep_also(wanted); !status) return status;
    const auto program = [&](bool back) {
        const auto build = [this, &earlier, back, label](compute::ProgramBuilder& builder, const Parity& parity) {
            for (const auto& field : state_.fields().kept()) {
                const auto now = state_.fields().buffer(field.name, parity), copy = earlier.copies[label(field.name)];
                builder.copy({back ? copy : now, back ? now : copy, 0, 0, field.bytes});
            }
            return ok_status();
        };
        return std::make_unique<StateProgram>(state_, back ? "roll back" : "keep for roll-back", build);
    };
    earlier.keep = program(false);
    earlier.restore = program(true);
    return ok_status();
}

// After a promotion earlier states go on with the new plan; what a smaller plan cannot hold is forgotten.
Status RollBack::fit() {
    if (recording_ == state_.fields().recording()) return ok_status();
    for (std::size_t n = 0; n < earlier_.size(); ++n) {
        if ((earlier_[n].effects & ~state_.plan().effects) != 0) earlier_[n].kept = false;
        if (auto status = fit(earlier_[n], n); !status) {
            clear();
            return status;
        }
    }
    recording_ = state_.fields().recording();
    return ok_status();
}

std::vector<std::uint64_t> RollBack::steps() const {
    std::vector<std::uint64_t> steps;
    for (const auto& earlier : earlier_) {
        if (earlier.kept && (earlier.effects & ~state_.plan().effects) == 0) steps.push_back(earlier.totals.steps);
    }
    std::sort(steps.begin(), steps.end());
    return steps;
}

Result<std::uint64_t> RollBack::go_back(std::uint64_t step) {
    if (auto status = fit(); !status) return status;
    Earlier* newest = nullptr;
    for (auto& earlier : earlier_) {
        if (!earlier.kept || earlier.totals.steps > step) continue;
        if (newest == nullptr || earlier.totals.steps > newest->totals.steps) newest = &earlier;
    }
    if (newest == nullptr) {
        const auto kept = steps();
        return error(Code::bad_argument, "roll_back: no step up to " + std::to_string(step) + " is kept" +
                                             (kept.empty() ? "" : "; the oldest is " + std::to_string(kept.front())));
    }
    if (newest->live != state_.settings().live()) {
        if (auto status = stepper_.change(newest->live, state_.content); !status) return status;
        if (auto status = fit(); !status) return status; // effects may have changed with it
    }
    if (auto ticket = newest->restore->submit(); !ticket) return ticket.status();
    for (auto& earlier : earlier_) earlier.kept &= earlier.totals.steps <= newest->totals.steps;
    if (auto status = stepper_.go_to(newest->totals); !status) return status;
    return newest->totals.steps;
}

Status RollBack::keep() {
    if (earlier_.empty()) return ok_status();
    if (auto status = fit(); !status) return status;
    const auto age = [](const Earlier& earlier) { return earlier.kept ? earlier.totals.steps + 1 : 0; }; // free ones first
    auto& earlier =
        *std::min_element(earlier_.begin(), earlier_.end(), [&](const Earlier& a, const Earlier& b) { return age(a) < age(b); });
    earlier.kept = false;
    if (auto ticket = earlier.keep->submit(); !ticket) return ticket.status();
    earlier.totals = stepper_.totals();
    earlier.effects = state_.plan().effects;
    earlier.live = state_.settings().live();
    earlier.kept = true;
    return ok_status();
}

Status RollBack::after_step() { return earlier_.empty() || state_.steps % interval_ != 0 ? ok_status() : keep(); }

std::uint64_t RollBack::undisturbed(std::uint64_t most) const {
    return earlier_.empty() ? most : std::min<std::uint64_t>(most, interval_ - state_.steps % interval_);
}

Status RollBack::restart() {
    for (auto& earlier : earlier_) earlier.kept = false;
    return keep();
}

} // namespace wadi
