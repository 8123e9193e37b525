#include "engine/step/state_program.hpp"

namespace wadi {

StateProgram::~StateProgram() { forget(); }

void StateProgram::forget() {
    for (auto& program : programs_) state_.device().destroy_program(program);
}

Result<compute::Ticket> StateProgram::submit(const StepInput& input) {
    auto& device = state_.device();
    const auto& fields = state_.fields();
    if (!state_.lost()) return state_.lost();
    if (recording_ != fields.recording()) forget();
    recording_ = fields.recording();
    auto& program = programs_[fields.place()];
    if (program.id == 0) {
        compute::ProgramBuilder builder(label_);
        if (auto status = build_(builder, fields.parity()); !status) return status;
        auto compiled = device.compile(builder, state_.params());
        if (!compiled) return compiled.status();
        program = *compiled;
    }
    return device.submit(program, input);
}

} // namespace wadi
