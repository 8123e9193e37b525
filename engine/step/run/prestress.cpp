#include "engine/step/run/prestress.hpp"
#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace wadi {

namespace {

// Inputs of apply_edits, one submission each.
Status apply(WorldState& state, std::span<const StepInput> inputs) {
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
        auto status = ok_status();
        for (const StepInput& input : inputs) {
            auto ticket = device.submit(*program, input);
            status = ticket ? device.wait(*ticket) : ticket.status();
            if (!status) break;
        }
        device.destroy_program(*program);
        return status;
    };
    const auto status = run();
    device.destroy_buffer(*no_stamps);
    return status;
}

StepInput balance_input(const Region& region, Balance change) {
    StepInput input{};
    input.edit_count = 1;
    cover(region, input.edit[0]);
    input.edit[0].kind = EDIT_BALANCE;
    input.edit[0].amount = static_cast<float>(change);
    return input;
}

} // namespace

bool bounds_tension(const WorldState& state) {
    constexpr std::uint32_t bounded = EFFECT_COHESION | EFFECT_SLOPE_NORMAL;
    return state.settings().method.prestress && (state.plan().effects & bounded) == bounded;
}

StepInput bound_input(const WorldState& state, const Region& region, Balance change) {
    constexpr int around = balance_reach;
    const auto& layout = state.layout();
    const int west = std::max(region.i0 - around, 0), east = std::min(region.i0 + region.nx + around, layout.nx);
    const int south = std::max(region.j0 - around, 0), north = std::min(region.j0 + region.ny + around, layout.ny);
    StepInput input = balance_input({west, south, east - west, north - south}, change);
    input.edit[0].columns = 1;
    return input;
}

Status change_balance(WorldState& state, const Region& region, Balance change) {
    if (!state.settings().method.prestress || (state.plan().effects & EFFECT_ELASTOPLASTIC) == 0) return ok_status();
    const std::array inputs = {balance_input(region, change), bound_input(state, region, change)};
    return apply(state, std::span(inputs).first(bounds_tension(state) ? 2 : 1));
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
