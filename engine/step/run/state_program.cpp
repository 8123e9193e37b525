#include "engine/step/run/state_program.hpp"

namespace wadi {

StateProgram::~StateProgram() { forget(); }

void StateProgram::forget() {
    for (auto& program : programs_) state_.device().destroy_program(program);
}

Status StateProgram::record() {
    const auto& fields = state_.fields();
    if (!state_.lost()) return state_.lost();
    if (recording_ != fields.recording()) forget();
    recording_ = fields.recording();
    auto& program = programs_[fields.place()];
    if (program.id != 0) return ok_status();
    compute::ProgramBuilder builder(label_);
    if (auto status = build_(builder, fields.parity()); !status) return status;
    auto compiled = state_.device().compile(builder, state_.params());
    if (compiled) program = *compiled;
    return compiled.status();
}

Result<compute::Ticket> StateProgram::submit(const StepInput& input) {
    if (auto status = record(); !status) return status;
    return state_.device().submit(programs_[state_.fields().place()], input);
}

} // namespace wadi
