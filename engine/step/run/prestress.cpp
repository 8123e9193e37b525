#include "engine/step/run/prestress.hpp"

namespace wadi {

Status change_balance(WorldState& state, const Region& region, Balance change) {
    if (!state.settings().method.prestress || (state.plan().effects & EFFECT_ELASTOPLASTIC) == 0) return ok_status();
    StepInput input{};
    input.edit_count = 1;
    cover(region, input.edit[0]);
    input.edit[0].kind = EDIT_BALANCE;
    input.edit[0].amount = static_cast<float>(change);
    auto& device = state.device();
    auto no_stamps = device.create_buffer({STAMP_PAGE * 4, "no stamps"});
    if (!no_stamps) return no_stamps.status();
    const auto run = [&] {
        compute::ProgramBuilder builder("balance");
        if (auto status = state.append_stage(builder, "apply_edits", state.fields().parity(), {{"stamp_images", *no_stamps}});
            !status)
            return status;
        auto program = device.compile(builder, state.params());
        if (!program) return program.status();
        auto ticket = device.submit(*program, input);
        const auto status = ticket ? device.wait(*ticket) : ticket.status();
        device.destroy_program(*program);
        return status;
    };
    const auto status = run();
    device.destroy_buffer(*no_stamps);
    return status;
}

Status put_in_balance(WorldState& state) {
    return change_balance(state, {0, 0, state.layout().nx, state.layout().ny}, Balance::add);
}

Status balance_anew(WorldState& state) {
    if (!state.settings().method.prestress) return ok_status();
    const std::vector<float> none(state.layout().size());
    for (const char* name : {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"}) {
        if (auto status = state.fields().write(name, 0, none); !status) return status;
    }
    return put_in_balance(state);
}

} // namespace wadi
