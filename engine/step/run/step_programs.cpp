#include "engine/step/run/step_programs.hpp"

namespace wadi {

void StepPrograms::drop() noexcept {
    const auto drop = [&](auto& programs) {
        for (auto& program : programs) state_.device().destroy_program(program);
    };
    for (Programs& programs : ways_) {
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

void StepPrograms::put(Ways ways) noexcept {
    drop();
    ways_ = std::move(ways);
}

Status StepPrograms::append_step(compute::ProgramBuilder& builder, int turn, Parity& parity, bool timestamps) {
    const auto add = [&](const PlanPass& pass) {
        auto status = state_.append(builder, pass, parity);
        if (status && timestamps)
            builder.timestamp(std::string(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name));
        return status;
    };
    for (int n = 0; n < state_.plan().water_substeps; ++n) {
        if (n > 0) builder.next_input();
        for (const auto& pass : state_.plan().water_part(n)) {
            if (auto status = add(pass); !status) return status;
        }
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

Result<compute::Program> StepPrograms::record_step(int turn, Parity& parity, bool timestamps) {
    compute::ProgramBuilder builder(timestamps ? "timed step" : "step");
    if (timestamps) builder.timestamp("start");
    if (auto status = append_step(builder, turn, parity, timestamps); !status) return status;
    return state_.device().compile(builder, state_.params());
}

Result<compute::Program> StepPrograms::record_run(int turn) {
    compute::ProgramBuilder builder("run of steps");
    Parity parity = state_.fields().parity(turn);
    for (int n = 0; n < run_steps; ++n) {
        if (n > 0) builder.next_input();
        if (auto status = append_step(builder, (turn + n) % 2, parity, false); !status) return status;
    }
    return state_.device().compile(builder, state_.params());
}

// A step flips each ping-pong field a fixed number of times, so two steps bring every field back: two programs suffice.
Status StepPrograms::record_way(bool with_parts) {
    Parity parity;
    for (int turn = 0; turn < 2; ++turn) {
        state_.fields().set_parity(turn, parity);
        auto program = record_step(turn, parity, false);
        if (!program) return program.status();
        now().steps[static_cast<std::size_t>(turn)] = *program;
        if (!with_parts) continue;
        if (auto status = record_parts(static_cast<std::size_t>(turn)); !status) return status;
    }
    return ok_status();
}

Status StepPrograms::record(bool with_parts, bool timed) {
    auto status = record_way(with_parts);
    if (status && timed) status = record_timed();
    if (status && state_.chooses_tiles()) {
        const bool tiles = state_.plan().active_tiles;
        state_.use_tiles(!tiles);
        status = record_way(with_parts);
        state_.use_tiles(tiles);
    }
    return status;
}

// A water substep, the first with the start passes or without, or a sand substep.
Result<compute::Program> StepPrograms::record_part(int part, bool start, int turn, Parity& parity) {
    const auto& plan = state_.plan();
    const bool water = part < plan.water_substeps;
    compute::ProgramBuilder builder(start ? "start part" : water ? "water part" : "sand part");
    for (const auto& pass : water ? plan.water_part(part, start) : plan.substep_passes) {
        if (auto status = state_.append(builder, pass, parity); !status) return status;
    }
    if (part + 1 == plan.water_substeps && plan.active_tiles) {
        if (auto status = active_.append(builder, turn); !status) return status;
    }
    return state_.device().compile(builder, state_.params());
}

Status StepPrograms::record_parts(std::size_t turn) {
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
    now().parts[turn] = std::move(recorded);
    return ok_status();
}

Status StepPrograms::record_timed() {
    if (now().timed[0].id != 0) return ok_status();
    for (int turn = 0; turn < 2; ++turn) {
        Parity parity = state_.fields().parity(turn);
        auto program = record_step(turn, parity, true);
        if (!program) return program.status();
        now().timed[static_cast<std::size_t>(turn)] = *program;
    }
    return ok_status();
}

Result<compute::Program> StepPrograms::timed(std::size_t turn) {
    if (auto status = record_timed(); !status) return status;
    return now().timed[turn];
}

Result<compute::Program> StepPrograms::run(std::size_t turn) {
    auto& program = now().runs[turn];
    if (program.id != 0) return program;
    auto recorded = record_run(static_cast<int>(turn));
    if (recorded) program = *recorded;
    return recorded;
}

Result<compute::Program> StepPrograms::part(std::size_t turn, std::size_t part, bool start) {
    if (now().parts[turn].empty()) {
        if (auto status = record_parts(turn); !status) return status;
    }
    if (part > 0 || !start) return now().parts[turn][part];
    auto& program = now().starts[turn];
    if (program.id != 0) return program;
    Parity parity = state_.fields().parity(static_cast<int>(turn));
    auto recorded = record_part(0, true, static_cast<int>(turn), parity);
    if (recorded) program = *recorded;
    return recorded;
}

} // namespace wadi
