// The plan as a person reads it: effects and reasons, passes in order, buffers, bytes per cell.
#include "engine/world.hpp"
#include <cstdio>
#include <sstream>

namespace wadi {

namespace {

void list_passes(std::ostringstream& out, const std::vector<PlanPass>& passes) {
    const char* access_name[] = {"reads", "writes", "updates"};
    for (const auto& pass : passes) {
        const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
        out << "    " << stage.name << "\n";
        for (int access = 0; access < 3; ++access) {
            std::string names;
            for (std::size_t n = 0; n < pass.fields.size(); ++n) {
                if (pass.fields[n].empty() || static_cast<int>(stage.bindings[n].access) != access) continue;
                names += (names.empty() ? "" : ", ") + pass.fields[n];
            }
            if (!names.empty()) out << "      " << access_name[access] << " " << names << "\n";
        }
    }
}

} // namespace

std::string describe_plan(const WorldState& world) {
    const auto& plan = world.plan();
    const auto& settings = world.settings();
    std::ostringstream out;
    out << "grid " << world.layout().nx << " x " << world.layout().ny << ", dx " << settings.grid.dx << " m, dt " << settings.dt
        << " s, method " << settings.method.name << ", T = " << plan.substeps;
    if (plan.water_substeps > 1) out << ", N = " << plan.water_substeps;
    for (const auto& choice : choice_table())
        if ((plan.effects & choice.bit) != 0) out << ", " << choice.name;
    out << "\neffects\n";
    for (std::size_t n = 0; n < effect_table().size(); ++n) {
        const auto& effect = effect_table()[n];
        char line[160];
        std::snprintf(line, sizeof line, "  %-3s %-14s %s\n", (plan.effects & effect.bit) != 0 ? "on" : "-", effect.name,
                      world.effects().reasons[n].c_str());
        out << line;
    }
    out << "stages " << (plan.fused ? "fused where the effects allow" : "one by one") << "\n";
    out << "passes: " << plan.water_dispatches() << " per water step, " << plan.substep_passes.size() << " per sand substep, "
        << plan.dispatches() << " in all\n  water step\n";
    if (plan.water_substeps > 1 && plan.again_to > plan.again_from)
        out << "    (" << plan.again_to - plan.again_from << " passes from "
            << compute::stage_table()[static_cast<std::size_t>(plan.water_passes[plan.again_from].stage)].name << " on run "
            << plan.water_substeps << " times)\n";
    list_passes(out, plan.water_passes);
    if (!plan.start_passes.empty()) {
        out << "  step 0 as well, ahead of the fluxes\n";
        list_passes(out, plan.start_passes);
    }
    if (!plan.substep_passes.empty()) {
        out << "  sand substep, " << plan.substeps << " times\n";
        list_passes(out, plan.substep_passes);
    }
    int state = 0, partners = 0, state_bytes = 0, partner_bytes = 0;
    std::string state_names, scratch_names;
    for (const auto& field : plan.fields) {
        if (field.role == FieldRole::state || field.role == FieldRole::fixed) {
            ++state;
            partners += field.ping_pong ? 1 : 0;
            state_bytes += PlanField::element_bytes;
            partner_bytes += field.ping_pong ? PlanField::element_bytes : 0;
            state_names += (state_names.empty() ? "" : ", ") + field.name + (field.ping_pong ? " x2" : "");
        } else if (field.role == FieldRole::scratch) {
            scratch_names +=
                (scratch_names.empty() ? "" : ", ") + field.name + (field.memory < 0 ? "" : " @" + std::to_string(field.memory));
        }
    }
    out << "buffers: " << plan.field_buffers() << " fields = " << state << " state + " << partners << " ping-pong + "
        << plan.scratch_buffers() << " scratch\n"
        << "  state    " << state_names << "\n";
    if (!scratch_names.empty()) out << "  scratch  " << scratch_names << "  (@n: shared memory block)\n";
    out << "bytes per cell: " << plan.bytes_per_cell() << " (state " << state_bytes << ", ping-pong " << partner_bytes
        << ", scratch " << 4 * plan.scratch_buffers() << "); on the device " << world.device().bytes() / 1024
        << " KiB with padding, ledgers and outputs\n";
    char line[160];
    std::snprintf(line, sizeof line,
                  "traffic: %.0f bytes per cell and step if every pass moves each of its fields once; least is %.0f, state once "
                  "in and out\n",
                  plan.traffic_per_cell(), plan.least_traffic_per_cell());
    out << line;
    return out.str();
}

} // namespace wadi
