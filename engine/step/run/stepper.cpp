#include "engine/step/run/stepper.hpp"
#include "engine/step/plan/source_shapes.hpp"
#include "engine/step/run/plan_change.hpp"
#include "engine/step/run/step_number.hpp"

namespace wadi {

Status Stepper::record_programs(bool with_parts) {
    auto status = programs_.record(with_parts, timings_.on());
    if (status) tile_use_.restart();
    return status;
}

Status Stepper::record() {
    PlanChange changing(state_, programs_);
    auto status = record_programs(changing.had_parts());
    if (status) changing.settle();
    return status;
}

Status Stepper::change(const LiveSettings& live, Content content, const std::function<Status()>& then) {
    Settings settings = state_.settings();
    settings.set_live(live);
    auto choice = effects_required(settings, content);
    if (!choice) return choice.status();
    const bool same_mask = choice->mask == state_.effects().mask, same_places = same_source_shapes(settings, state_.settings());
    LiveSettings taken = live;
    StepInputs inputs(settings);
    inputs.carry_over(inputs_);
    if (same_mask && same_places && live.material == state_.settings().material) {
        auto status = then ? then() : ok_status();
        if (!status) return status;
        state_.set_live(std::move(taken));
        inputs_ = std::move(inputs);
        state_.set_reasons(std::move(*choice));
        state_.content = content;
        return status;
    }
    const std::string news = same_mask ? std::string() : "effects " + effect_names(choice->mask);
    if (auto status = timings_.collect(); !status) return status; // of the passes until now
    {
        PlanChange changing(state_, programs_);
        state_.set_live(std::move(taken));
        if (same_mask) state_.derive();
        auto status = same_mask ? ok_status() : state_.set_effects(*choice);
        if (status) status = record_programs(changing.had_parts());
        if (status && then) status = then();
        if (status && !same_places) status = state_.write_source_shapes();
        if (!status) return status;
        changing.settle();
    }
    inputs_ = std::move(inputs);
    state_.content = content;
    state_.set_reasons(std::move(*choice));
    timings_.forget();
    if (same_mask) return ok_status();
    state_.fields().settle();
    state_.tell(2, news);
    return ok_status();
}

Status Stepper::prepare() {
    for (const bool sand : {false, true}) {
        for (const bool water : {false, true}) {
            const Content content{sand, water};
            auto choice = check_allowed(state_.settings(), content) ? effects_required(state_.settings(), content)
                                                                    : Result<EffectChoice>(state_.effects());
            if (!choice) return choice.status();
            if (auto status = state_.prepare(choice->mask); !status) return status;
        }
    }
    return ok_status();
}

Status Stepper::submit_parts(int parts) {
    const auto turn = static_cast<std::size_t>(state_.fields().turn());
    const bool start = starts();
    for (; parts_done_ < parts; ++parts_done_) {
        auto program = programs_.part(turn, static_cast<std::size_t>(parts_done_), start);
        if (!program) return program.status();
        const int input = std::min(parts_done_, substeps() - 1); // the sand has that of the water's last substep
        auto ticket = state_.device().submit(*program, inputs_of_step_[static_cast<std::size_t>(input)]);
        if (!ticket) return ticket.status();
        ticket_ = *ticket;
        if (parts_done_ == 0) tile_use_.submitted(1, ticket_, inputs_of_step_[0].wake_count > 0);
    }
    return ok_status();
}

// Submits parts until `parts` of the step are done; the last one makes the step whole.
Status Stepper::finish(int parts) {
    if (asleep_) {
        parts_done_ = parts;
    } else if (auto status = submit_parts(parts); !status) {
        if (parts_done_ == 0) inputs_.undo();
        return status;
    }
    return parts_done_ < this->parts() ? ok_status() : complete_step();
}

Status Stepper::complete_step() {
    parts_done_ = 0;
    asleep_ = false;
    state_.fields().end_turn();
    ++state_.steps;
    return hooks_.after_step();
}

void Stepper::next_inputs(std::span<StepInput> inputs) {
    if (turns(state_.steps)) state_.tiles().wake_all();
    inputs_.next(state_.steps, inputs);
    for (const StepInput& input : inputs) state_.tiles().wake_inputs(input);
    state_.tiles().put(inputs[0]); // tiles are chosen once a step
}

HostTotals Stepper::totals() const { return {state_.steps, state_.sand_initial, state_.water_initial, inputs_.totals()}; }

Status Stepper::go_to(const HostTotals& totals) {
    parts_done_ = 0;
    asleep_ = false;
    state_.tiles().wake_all();
    tile_use_.restart();
    state_.steps = totals.steps;
    state_.sand_initial = totals.sand_initial;
    state_.water_initial = totals.water_initial;
    inputs_.set_totals(totals.inputs);
    return hooks_.jumped();
}

Status Stepper::finish_step() {
    if (parts_done_ == 0) return state_.lost();
    auto status = step();
    if (status) hooks_.finished_early();
    return status;
}

Status Stepper::begin() {
    if (!starts()) tile_use_.choose();
    if (auto status = hooks_.before_step(); !status) return status;
    const auto inputs = inputs_of_step();
    next_inputs(inputs);
    asleep_ = !timings_.on() && tile_use_.asleep() && inputs[0].wake_count == 0;
    return ok_status();
}

Status Stepper::step_part() {
    if (!state_.lost()) return state_.lost();
    if (parts_done_ == 0) {
        if (auto status = begin(); !status) return status;
    }
    return finish(parts_done_ + 1);
}

Status Stepper::step() {
    if (!state_.lost()) return state_.lost();
    if (parts_done_ > 0) return finish(parts());
    if (auto status = begin(); !status) return status;
    if (asleep_ || starts()) return finish(parts());
    const auto turn = static_cast<std::size_t>(state_.fields().turn());
    // Timed ones may be missing still, for the way that was not taken so far.
    auto program = timings_.on() ? programs_.timed(turn) : Result<compute::Program>(programs_.step(turn));
    auto ticket = program ? state_.device().submit_inputs(*program, inputs_of_step()) : Result<compute::Ticket>(program.status());
    if (!ticket) {
        inputs_.undo();
        return ticket.status();
    }
    ticket_ = *ticket;
    tile_use_.submitted(1, ticket_, inputs_of_step_[0].wake_count > 0);
    if (timings_.on()) {
        if (auto status = timings_.submitted(ticket_); !status) return status;
    }
    return complete_step();
}

bool Stepper::can_run() {
    // From turn 0 to turn 0 where the world may go the other way in between.
    if (state_.chooses_tiles() && state_.fields().turn() != 0) return false;
    if (substeps() > 1) return false; // a step alone has inputs enough for one submission
    return !timings_.on() && !starts() && hooks_.undisturbed(run_steps) == run_steps && !tile_use_.asleep();
}

Status Stepper::run(bool& taken) {
    taken = false;
    if (!starts()) tile_use_.choose();
    if (auto status = hooks_.before_step(); !status) return status;
    if (!can_run()) return ok_status(); // an edit brought a layer, whose first step starts otherwise
    const auto turn = static_cast<std::size_t>(state_.fields().turn());
    auto program = programs_.run(turn);
    // Inside a recording into the host's commands nothing new is compiled: single steps do.
    if (program.status().code == Code::not_ready) return ok_status();
    if (!program) return program.status();
    const auto before = inputs_.totals();
    const std::uint64_t first = state_.steps;
    bool woken = false;
    for (auto& input : run_inputs_) {
        next_inputs({&input, 1});
        woken |= input.wake_count > 0;
        state_.tiles().submitted();
        ++state_.steps;
    }
    auto ticket = state_.device().submit_inputs(*program, run_inputs_);
    if (!ticket) {
        state_.steps = first;
        inputs_.set_totals(before);
        state_.tiles().wake_all();
        return ticket.status();
    }
    ticket_ = *ticket;
    tile_use_.submitted(run_steps, ticket_, woken);
    taken = true;
    return hooks_.after_step();
}

Status Stepper::steps(std::uint64_t count) {
    while (count > 0) {
        if (!state_.lost()) return state_.lost();
        bool taken = false;
        if (parts_done_ == 0 && count >= run_steps && can_run()) {
            if (auto status = run(taken); !status) return status;
        }
        if (taken) {
            count -= run_steps;
            continue;
        }
        if (auto status = step(); !status) return status;
        --count;
    }
    return state_.lost();
}

Status Stepper::set_profiling(bool on) {
    if (auto status = timings_.collect(); !status) return status;
    if (on) {
        if (auto program = programs_.timed(0); !program) return program.status();
    }
    timings_.set(on);
    return ok_status();
}

} // namespace wadi
