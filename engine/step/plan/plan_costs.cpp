// What a plan costs per cell: memory, and bytes that its passes move.
#include "engine/step/plan/step_plan.hpp"
#include <algorithm>

namespace wadi {

namespace {

bool lasts(const PlanField& field) { return field.role == FieldRole::state || field.role == FieldRole::fixed; }

} // namespace

int StepPlan::scratch_buffers() const {
    const auto of_its_own = [](const PlanField& f) { return f.role == FieldRole::scratch && f.memory < 0; };
    return scratch_blocks + static_cast<int>(std::count_if(fields.begin(), fields.end(), of_its_own));
}

int StepPlan::field_buffers() const {
    int count = scratch_buffers();
    for (const auto& field : fields) {
        if (lasts(field)) count += field.ping_pong ? 2 : 1;
    }
    return count;
}

double StepPlan::bytes_per_cell() const {
    int bytes = 4 * scratch_buffers();
    for (const auto& field : fields)
        if (lasts(field)) bytes += PlanField::element_bytes * (field.ping_pong ? 2 : 1);
    return bytes;
}

double StepPlan::traffic_per_cell() const {
    double moved = 0;
    const auto add = [&](const PlanPass& pass, int times) {
        const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
        using enum compute::Extent;
        if (stage.extent != cells && stage.extent != faces && stage.extent != strips) return;
        for (std::size_t n = 0; n < pass.fields.size(); ++n) {
            const auto* field = pass.fields[n].empty() ? nullptr : find(base_name(pass.fields[n]));
            if (field == nullptr || (!lasts(*field) && field->role != FieldRole::scratch)) continue;
            moved += times * PlanField::element_bytes * (stage.bindings[n].access == compute::Access::inout ? 2 : 1);
        }
    };
    for (std::size_t n = 0; n < water_passes.size(); ++n) add(water_passes[n], times(n));
    for (const auto& pass : substep_passes) add(pass, substeps);
    return moved;
}

double StepPlan::least_traffic_per_cell() const {
    double moved = 0;
    for (const auto& field : fields)
        if (lasts(field)) moved += PlanField::element_bytes * (field.ping_pong ? 2 : 1);
    return moved;
}

} // namespace wadi
