#include "engine/step/state_program.hpp"

namespace wadi {

StateProgram::~StateProgram() { forget(); }

void StateProgram::forget() {
    for (auto& program : programs_) {
        state_.device().destroy_program(program);
        program = {};
    }
}

Result<compute::Ticket> StateProgram::submit(const StepInput& input) {
    if (!state_.lost()) return state_.lost();
    if (recording_ != state_.recording()) forget();
    recording_ = state_.recording();
    auto& program = programs_[static_cast<std::size_t>(state_.turn())];
    if (program.id == 0) {
        compute::ProgramBuilder builder(label_);
        if (auto status = build_(builder, state_.parity()); !status) return state_.note(status);
        auto compiled = state_.device().compile(builder, state_.params());
        if (!compiled) return state_.note(compiled.status());
        program = *compiled;
    }
    auto ticket = state_.device().submit(program, input);
    if (!ticket) return state_.note(ticket.status());
    return ticket;
}

} // namespace wadi
