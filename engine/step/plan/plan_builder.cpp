#include "engine/step/plan/plan_builder.hpp"

namespace wadi {

bool PlanBuilder::can_fuse(const char* stage) const {
    const auto& info = compute::stage_table()[static_cast<std::size_t>(compute::find_stage(stage))];
    return plan_.fused && has(info.needs) && (effects_ & info.without) == 0;
}

bool PlanBuilder::fuse(const char* stage, std::vector<std::string> flips, const Names& names) {
    if (!can_fuse(stage)) return false;
    run(stage, std::move(flips), names);
    return true;
}

void PlanBuilder::run(const char* stage, std::vector<std::string> flips, const Names& names) {
    PlanPass pass;
    pass.stage = compute::find_stage(stage);
    pass.in_substep = in_substep_;
    pass.flips = std::move(flips);
    if (tiles_by_material()) pass.tiles = in_substep_ ? "_sand" : "_water";
    for (const auto& binding : compute::stage_table()[static_cast<std::size_t>(pass.stage)].bindings) {
        const bool exists = (effects_ & binding.condition) == binding.condition;
        const std::string name(binding.name);
        const auto renamed = names.find(base_name(name));
        const std::string field = renamed == names.end() ? name : is_next(name) ? next_name(renamed->second) : renamed->second;
        pass.fields.push_back(exists ? field : std::string());
    }
    passes_.push_back(std::move(pass));
}

void PlanBuilder::only_where_both_run() {
    if (tiles_by_material()) passes_.back().tiles = "_mixture";
}

void account_water(PlanBuilder& b) {
    b.run("account_sides", {}, {{"flux_x", "water_flux_x"}, {"flux_y", "water_flux_y"}, {"side_ledger", "water_side_ledger"}});
    if (!b.has(EFFECT_MIXTURE)) return;
    b.run("account_sides", {}, {{"flux_x", "mixed_flux_x"}, {"flux_y", "mixed_flux_y"}, {"side_ledger", "water_side_ledger"}});
}

void plan_sand_height(PlanBuilder& b) {
    b.run("limit_sand_outflow");
    b.run("compute_sand_flux");
    account_sand(b);
    b.run("integrate_sand_height");
}

void account_sand(PlanBuilder& b) {
    if (!b.has(EFFECT_OPEN_SIDES)) return;
    b.run("account_sides", {}, {{"flux_x", "sand_flux_x"}, {"flux_y", "sand_flux_y"}, {"side_ledger", "sand_side_ledger"}});
}

Names drag_names(const PlanBuilder& b) {
    if (!b.has(EFFECT_DRAG)) return {};
    const std::string layer = b.has(EFFECT_MIXTURE) ? "mixed_velocity_" : "water_velocity_";
    return {{"drag_velocity_x", layer + "x"}, {"drag_velocity_y", layer + "y"}};
}

} // namespace wadi
