#include "engine/step/run/stepper.hpp"
#include "engine/step/run/step_number.hpp"
#include <algorithm>
#include <utility>

namespace wadi {

int Stepper::parts() const { return state_.plan().substep_passes.empty() ? 1 : 1 + state_.plan().substeps; }

/// Keeps what a change replaces. All is as it was before unless the change is settled.
class Stepper::Change {
  public:
    explicit Change(Stepper& stepper)
        : stepper_(stepper), state_(stepper.state_.now()), programs_(std::exchange(stepper.programs_, {})) {}
    ~Change() {
        if (settled_) return;
        stepper_.drop_programs();
        stepper_.programs_ = std::move(programs_);
        stepper_.state_.go_back(std::move(state_));
    }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

    /// Whether steps ran in parts: as they will go on to, their programs are recorded with the others.
    bool had_parts() const {
        return std::any_of(programs_.begin(), programs_.end(),
                           [](const Programs& way) { return !way.parts[0].empty() || !way.parts[1].empty(); });
    }
    void settle() noexcept {
        std::swap(stepper_.programs_, programs_);
        stepper_.drop_programs();
        stepper_.programs_ = std::exchange(programs_, {});
        settled_ = true;
    }

  private:
    Stepper& stepper_;
    WorldState::Replaced state_;
    std::array<Programs, 2> programs_;
    bool settled_ = false;
};

void Stepper::drop_programs() noexcept {
    const auto drop = [&](auto& programs) {
        for (auto& program : programs) state_.device().destroy_program(program);
    };
    for (Programs& programs : programs_) {
        drop(programs.steps);
        drop(programs.timed);
        drop(programs.runs);
        drop(programs.starts);
        for (auto& parts : programs.parts) {
            drop(parts);
            parts.clear();
        }
    }
}

Status Stepper::append_step(compute::ProgramBuilder& builder, int turn, Parity& parity, bool timestamps) {
    const auto add = [&](const PlanPass& pass) {
        auto status = state_.append(builder, pass, parity);
        if (status && timestamps)
            builder.timestamp(std::string(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name));
        return status;
    };
    for (const auto& pass : state_.plan().water_passes) {
        if (auto status = add(pass); !status) return status;
    }
    if (state_.plan().active_tiles) {
        if (auto status = active_.append(builder, turn); !status) return status;
    }
    for (int t = 0; t < state_.plan().substeps; ++t) {
        for (const auto& pass : state_.plan().substep_passes) {
            if (auto status = add(pass); !status) return status;
        }
    }
    return ok_status();
}

Result<compute::Program> Stepper::record_step(int turn, Parity& parity, bool timestamps) {
    compute::ProgramBuilder builder(timestamps ? "timed step" : "step");
    if (timestamps) builder.timestamp("start");
    if (auto status = append_step(builder, turn, parity, timestamps); !status) return status;
    return state_.device().compile(builder, state_.params());
}

Result<compute::Program> Stepper::record_run(int turn) {
    compute::ProgramBuilder builder("run of steps");
    Parity parity = state_.fields().parity(turn);
    for (int n = 0; n < run_steps; ++n) {
        if (n > 0) builder.next_input();
        if (auto status = append_step(builder, (turn + n) % 2, parity, false); !status) return status;
    }
    return state_.device().compile(builder, state_.params());
}

// A step flips each ping-pong field a fixed number of times, so two steps bring every field back: two programs suffice.
Status Stepper::record_way(bool with_parts) {
    Parity parity;
    for (int turn = 0; turn < 2; ++turn) {
        state_.fields().set_parity(turn, parity);
        auto program = record_step(turn, parity, false);
        if (!program) return program.status();
        programs().steps[static_cast<std::size_t>(turn)] = *program;
        if (!with_parts) continue;
        if (auto status = record_parts(static_cast<std::size_t>(turn)); !status) return status;
    }
    return ok_status();
}

Status Stepper::record_ways(bool with_parts) {
    auto status = record_way(with_parts);
    if (status && profiling_) status = record_timed();
    if (status && state_.chooses_tiles()) {
        const bool tiles = state_.plan().active_tiles;
        state_.use_tiles(!tiles);
        status = record_way(with_parts);
        state_.use_tiles(tiles);
    }
    if (status) choice_.restart();
    return status;
}

Status Stepper::record() {
    Change changing(*this);
    auto status = record_ways(changing.had_parts());
    if (status) changing.settle();
    return status;
}

Status Stepper::change(const Material& material, Content content, const std::function<Status()>& then) {
    Settings settings = state_.settings();
    settings.material = material;
    auto choice = effects_required(settings, content);
    if (!choice) return choice.status();
    const bool same_mask = choice->mask == state_.effects().mask;
    if (same_mask && material == state_.settings().material) {
        auto status = then ? then() : ok_status();
        if (!status) return status;
        state_.set_reasons(std::move(*choice));
        state_.content = content;
        return status;
    }
    const std::string news = same_mask ? std::string() : "effects " + effect_names(choice->mask);
    if (auto status = collect_timings(true); !status) return status; // of the passes until now
    {
        Change changing(*this);
        state_.set_material(material);
        auto status = same_mask ? ok_status() : state_.set_effects(*choice);
        if (status) status = record_ways(changing.had_parts());
        if (status && then) status = then();
        if (!status) return status;
        changing.settle();
    }
    state_.content = content;
    state_.set_reasons(std::move(*choice));
    stage_milliseconds_.clear();
    timed_steps_ = 0;
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

// The water's part, with the start passes or without, or a sand substep.
Result<compute::Program> Stepper::record_part(int part, bool start, int turn, Parity& parity) {
    compute::ProgramBuilder builder(start ? "start part" : part == 0 ? "water part" : "sand part");
    const auto& plan = state_.plan();
    std::vector<PlanPass> passes = part == 0 ? plan.water_passes : plan.substep_passes;
    if (start) {
        const auto at = passes.begin() + static_cast<std::ptrdiff_t>(plan.start_at);
        passes.insert(at, plan.start_passes.begin(), plan.start_passes.end());
    }
    for (const auto& pass : passes) {
        if (auto status = state_.append(builder, pass, parity); !status) return status;
    }
    if (part == 0 && plan.active_tiles) {
        if (auto status = active_.append(builder, turn); !status) return status;
    }
    return state_.device().compile(builder, state_.params());
}

Status Stepper::record_parts(std::size_t turn) {
    Parity parity = state_.fields().parity(static_cast<int>(turn));
    std::vector<compute::Program> recorded(static_cast<std::size_t>(parts()));
    for (std::size_t part = 0; part < recorded.size(); ++part) {
        auto program = record_part(static_cast<int>(part), false, static_cast<int>(turn), parity);
        if (!program) {
            for (auto& earlier : recorded) state_.device().destroy_program(earlier);
            return program.status();
        }
        recorded[part] = *program;
    }
    programs().parts[turn] = std::move(recorded);
    return ok_status();
}

Status Stepper::record_start(std::size_t turn) {
    Parity parity = state_.fields().parity(static_cast<int>(turn));
    auto program = record_part(0, true, static_cast<int>(turn), parity);
    if (!program) return program.status();
    programs().starts[turn] = *program;
    return ok_status();
}

Status Stepper::submit_parts(int parts) {
    const auto turn = static_cast<std::size_t>(state_.fields().turn());
    const bool start = starts();
    if (programs().parts[turn].empty()) {
        if (auto status = record_parts(turn); !status) return status;
    }
    if (start && programs().starts[turn].id == 0) {
        if (auto status = record_start(turn); !status) return status;
    }
    for (; parts_done_ < parts; ++parts_done_) {
        const auto part = static_cast<std::size_t>(parts_done_);
        auto ticket = state_.device().submit(part == 0 && start ? programs().starts[turn] : programs().parts[turn][part], input_);
        if (!ticket) return ticket.status();
        ticket_ = *ticket;
        if (part == 0) note_submitted(input_.wake_count > 0, 1);
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

StepInput Stepper::next_input() {
    StepInput input = inputs_.next(state_.steps);
    if (turns(state_.steps)) state_.tiles().wake_all();
    state_.tiles().wake_inputs(input);
    state_.tiles().put(input);
    return input;
}

bool Stepper::may_sleep(const StepInput& input) {
    return state_.plan().active_tiles && !profiling_ && active_.asleep() && input.wake_count == 0;
}

void Stepper::note_submitted(bool woken, int steps) {
    const bool tiles = state_.plan().active_tiles;
    if (tiles) {
        for (int n = 0; n < std::min(steps, 2); ++n) active_.submitted((state_.fields().turn() + n) % 2, ticket_, woken);
    }
    choice_.submitted(static_cast<std::uint64_t>(steps), tiles, ticket_);
    state_.tiles().submitted();
}

void Stepper::choose_tiles() {
    if (!state_.chooses_tiles() || state_.fields().turn() != 0 || starts()) return;
    const auto [ticket, count] = active_.newest();
    const double share = static_cast<double>(count) / static_cast<double>(state_.tiles().count());
    state_.use_tiles(choice_.wants_tiles(state_.steps, {ticket, share}));
}

HostTotals Stepper::totals() const { return {state_.steps, state_.sand_initial, state_.water_initial, inputs_.totals()}; }

Status Stepper::go_to(const HostTotals& totals) {
    parts_done_ = 0;
    asleep_ = false;
    state_.tiles().wake_all();
    choice_.restart();
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
    choose_tiles();
    if (auto status = hooks_.before_step(); !status) return status;
    input_ = next_input();
    asleep_ = may_sleep(input_);
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
    if (profiling_) {
        if (auto status = record_timed(); !status) { // for the way that was not taken so far
            inputs_.undo();
            return status;
        }
    }
    auto ticket = state_.device().submit(profiling_ ? programs().timed[turn] : programs().steps[turn], input_);
    if (!ticket) {
        inputs_.undo();
        return ticket.status();
    }
    ticket_ = *ticket;
    note_submitted(input_.wake_count > 0, 1);
    if (profiling_) {
        pending_timings_.push_back(*ticket);
        if (auto status = collect_timings(false); !status) return status;
    }
    return complete_step();
}

bool Stepper::can_run() {
    // From turn 0 to turn 0 where the world may go the other way in between.
    if (state_.chooses_tiles() && state_.fields().turn() != 0) return false;
    return !profiling_ && !starts() && hooks_.undisturbed(run_steps) == run_steps &&
           !(state_.plan().active_tiles && active_.asleep());
}

Status Stepper::run(bool& taken) {
    taken = false;
    choose_tiles();
    if (auto status = hooks_.before_step(); !status) return status;
    if (!can_run()) return ok_status(); // an edit brought a layer, whose first step starts otherwise
    const auto turn = static_cast<std::size_t>(state_.fields().turn());
    auto& program = programs().runs[turn];
    if (program.id == 0) {
        auto recorded = record_run(static_cast<int>(turn));
        // Inside a recording into the host's commands nothing new is compiled: single steps do.
        if (recorded.status().code == Code::not_ready) return ok_status();
        if (!recorded) return recorded.status();
        program = *recorded;
    }
    const auto before = inputs_.totals();
    const std::uint64_t first = state_.steps;
    bool woken = false;
    for (auto& input : run_inputs_) {
        input = next_input();
        woken |= input.wake_count > 0;
        state_.tiles().submitted();
        ++state_.steps;
    }
    auto ticket = state_.device().submit_inputs(program, run_inputs_);
    if (!ticket) {
        state_.steps = first;
        inputs_.set_totals(before);
        state_.tiles().wake_all();
        return ticket.status();
    }
    ticket_ = *ticket;
    input_ = run_inputs_.back();
    note_submitted(woken, run_steps);
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

Status Stepper::record_timed() {
    if (programs().timed[0].id != 0) return ok_status();
    for (int turn = 0; turn < 2; ++turn) {
        Parity parity = state_.fields().parity(turn);
        auto program = record_step(turn, parity, true);
        if (!program) return program.status();
        programs().timed[static_cast<std::size_t>(turn)] = *program;
    }
    return ok_status();
}

Status Stepper::set_profiling(bool on) {
    if (auto status = collect_timings(true); !status) return status;
    if (on) {
        if (auto status = record_timed(); !status) return status;
    }
    if (on && !profiling_) {
        stage_milliseconds_.clear();
        timed_steps_ = 0;
    }
    profiling_ = on;
    return ok_status();
}

// The device keeps the timings of a few submissions only: fetch them as they finish.
Status Stepper::collect_timings(bool all) {
    constexpr std::size_t most_pending = 4;
    while (!pending_timings_.empty() && (all || pending_timings_.size() > most_pending)) {
        const auto ticket = pending_timings_.front();
        pending_timings_.erase(pending_timings_.begin());
        if (auto status = state_.device().wait(ticket); !status) return status;
        auto timings = state_.device().timings(ticket);
        if (!timings) return timings.status();
        for (const auto& timing : *timings) stage_milliseconds_[timing.label] += timing.milliseconds;
        ++timed_steps_;
    }
    return ok_status();
}

Result<std::vector<StageTime>> Stepper::stage_times() {
    if (auto status = collect_timings(true); !status) return status;
    std::vector<StageTime> times;
    const auto add = [&](const PlanPass& pass, int repeats) {
        const std::string name(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name);
        auto found = std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == name; });
        if (found == times.end()) {
            const double total = stage_milliseconds_.contains(name) ? stage_milliseconds_[name] : 0;
            found = times.insert(times.end(), {name, timed_steps_ > 0 ? total / static_cast<double>(timed_steps_) : 0, 0});
        }
        found->passes += repeats;
    };
    for (const auto& pass : state_.plan().water_passes) add(pass, 1);
    for (const auto& pass : state_.plan().substep_passes) add(pass, state_.plan().substeps);
    if (const auto& other = state_.other_plan()) {
        for (const auto* passes : {&other->water_passes, &other->substep_passes})
            for (const auto& pass : *passes) add(pass, 0);
    }
    return times;
}

} // namespace wadi
