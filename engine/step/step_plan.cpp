#include "engine/step/step_plan.hpp"
#include <algorithm>
#include <array>

namespace wadi {

namespace {

// What a list of active tiles consists of: the dispatches of a pass over tiles name them too.
constexpr std::array tile_fields = {"activity", "active_tiles", "active_counts", "active_list", "active_dispatch"};

using Names = std::map<std::string, std::string>; // a stage's binding name -> the plan's field name

class Builder {
  public:
    Builder(const StepPlan& plan, std::vector<PlanPass>& passes, bool in_substep)
        : plan_(plan), effects_(plan.effects), passes_(passes), in_substep_(in_substep), fused_(plan.fused),
          by_material_(plan.tiles_by_material) {}

    bool has(std::uint32_t bits) const { return (effects_ & bits) == bits; }

    /// Whether the plan has fused stages and the mask allows this one.
    bool can_fuse(const char* stage) const {
        const auto& info = compute::stage_table()[static_cast<std::size_t>(compute::find_stage(stage))];
        return fused_ && has(info.needs) && (effects_ & info.without) == 0;
    }
    bool fuse(const char* stage, std::vector<std::string> flips, const Names& names = {}) {
        if (!can_fuse(stage)) return false;
        run(stage, std::move(flips), names);
        return true;
    }
    /// In one pass with what accelerates the sand. That pass moves the water's velocities to their other buffers, which tiles
    /// without sand would have to do as well.
    bool fuses_momentum_exchange() const { return !by_material_ && can_fuse("accelerate_mixture"); }
    /// Whether active tiles have a list for each material.
    bool tiles_by_material() const { return by_material_; }
    std::vector<std::string> tile_lists() const { return plan_.tile_lists(); }

    void run(const char* stage, std::vector<std::string> flips = {}, const Names& names = {}) {
        PlanPass pass;
        pass.stage = compute::find_stage(stage);
        pass.in_substep = in_substep_;
        pass.flips = std::move(flips);
        if (by_material_) pass.tiles = in_substep_ ? "_sand" : "_water";
        for (const auto& binding : compute::stage_table()[static_cast<std::size_t>(pass.stage)].bindings) {
            const bool exists = (effects_ & binding.condition) == binding.condition;
            const std::string name(binding.name);
            const auto renamed = names.find(base_name(name));
            const std::string field = renamed == names.end() ? name
                                      : is_next(name)        ? next_name(renamed->second)
                                                             : renamed->second;
            pass.fields.push_back(exists ? field : std::string());
        }
        passes_.push_back(std::move(pass));
    }
    /// The latest pass changes nothing but where water and sand meet.
    void only_where_both_run() {
        if (by_material_) passes_.back().tiles = "_mixture";
    }

  private:
    const StepPlan& plan_;
    std::uint32_t effects_;
    std::vector<PlanPass>& passes_;
    bool in_substep_, fused_, by_material_;
};

// Semi-Lagrangian transport of one layer's velocities, by the boundary types from before its height moved (NUMERICS 2.12).
void plan_backtrace(Builder& b, const std::string& layer, const char* backtrace) {
    const std::string velocity = layer + "_velocity_", type = layer + "_face_type_";
    const Names names = {
        {"velocity_x", velocity + "x"}, {"velocity_y", velocity + "y"}, {"face_type_x", type + "x"}, {"face_type_y", type + "y"}};
    b.run("extrapolate_velocity", {}, names);
    b.run(backtrace, {velocity + "x", velocity + "y"}, names);
}

void account_water(Builder& b) {
    b.run("account_sides", {}, {{"flux_x", "water_flux_x"}, {"flux_y", "water_flux_y"}, {"side_ledger", "water_side_ledger"}});
    if (!b.has(EFFECT_MIXTURE)) return;
    b.run("account_sides", {}, {{"flux_x", "mixed_flux_x"}, {"flux_y", "mixed_flux_y"}, {"side_ledger", "water_side_ledger"}});
}

// What has spread ahead of transport is moved as mixed water, whether the sand is that high or not.
Names spread_heights(const Builder& b) {
    return b.has(EFFECT_DIFFUSION_AHEAD) ? Names{{"sand_height", "mixed_diffused"}} : Names{};
}

void plan_water_fluxes(Builder& b) {
    if (b.has(EFFECT_DIFFUSION) && !b.has(EFFECT_DIFFUSION_AHEAD)) b.run("diffuse_mixed_water");
    b.run("limit_water_outflow", {}, spread_heights(b));
    b.run("compute_water_flux", {}, spread_heights(b));
}

// The paper's explicit exchange between the layers, from velocities ahead of advection to those behind it (NUMERICS 2.21).
Names exchange_over(const std::string& before, const std::string& after) {
    return {{"sand_before", before}, {"sand_after", after}};
}

// Both layers' fluxes and the new height.
void plan_water_transport(Builder& b) {
    plan_water_fluxes(b);
    if (b.has(EFFECT_OPEN_SIDES)) account_water(b);
    b.run("integrate_water_height", {"water_height"}, spread_heights(b));
}

// Momentum advection of second order takes the pure water's velocities at the time of the heights, the mixed water's as they are.
void plan_water_velocity(Builder& b, std::vector<std::string> flips, Names names) {
    if (b.has(EFFECT_SECOND_ORDER_WATER)) b.run("center_water_velocity", {}, names);
    names["centered_mixed_velocity_x"] = "mixed_velocity_x";
    names["centered_mixed_velocity_y"] = "mixed_velocity_y";
    b.run("integrate_water_velocity", std::move(flips), names);
}

// Height and velocities of the water.
void plan_water_motion(Builder& b) {
    std::vector<std::string> moved = {"water_velocity_x", "water_velocity_y"};
    if (b.has(EFFECT_MIXTURE)) moved.insert(moved.end(), {"mixed_velocity_x", "mixed_velocity_y"});
    std::vector<std::string> all = moved;
    all.push_back("water_height");
    if (b.fuse("step_water", all) || b.fuse("step_mixed_water", all)) {
        if (b.has(EFFECT_OPEN_SIDES)) account_water(b);
        return;
    }
    plan_water_transport(b);
    if (b.has(EFFECT_EXPLICIT_EXCHANGE)) b.run("measure_layer_exchange", {}, exchange_over("mixed_predicted", "sand_height"));
    if (b.has(EFFECT_SEMI_LAGRANGIAN)) {
        plan_backtrace(b, "water", "backtrace_water_velocity");
        if (b.has(EFFECT_MIXTURE)) plan_backtrace(b, "mixed", "backtrace_water_velocity");
    }
    if (b.has(EFFECT_EXPLICIT_EXCHANGE)) {
        b.run("give_layer_exchange", {}, exchange_over("mixed_predicted", "sand_height"));
        b.run("renew_split");
    }
    plan_water_velocity(b, moved, {});
}

// What comes from outside.
void plan_inflow(Builder b) {
    if (b.has(EFFECT_SOURCES)) b.run("apply_sources");
    if (b.has(EFFECT_RAIN)) b.run("apply_rain");
    if (b.has(EFFECT_DIFFUSION_AHEAD)) {
        b.run("diffuse_mixed_velocity", {"mixed_velocity_x", "mixed_velocity_y"});
        b.run("diffuse_mixed_height");
        b.run("spread_mixed_water");
    }
    if (b.has(EFFECT_WATER | EFFECT_OPEN_SIDES)) b.run("open_sides");
}

// A step's heights and velocities are tried in the other buffers of their fields, and velocities go half the way there.
void plan_start(Builder b) {
    if (!b.has(EFFECT_SECOND_ORDER_WATER) || b.has(EFFECT_SEMI_LAGRANGIAN)) return;
    plan_water_fluxes(b);
    b.run("integrate_water_height");
    plan_water_velocity(b, {}, {{"water_height", "water_height_next"}});
    Names names;
    for (const std::string axis : {"x", "y"}) {
        names["velocity_" + axis] = "water_velocity_" + axis;
        names["tried_velocity_" + axis] = next_name("water_velocity_" + axis);
    }
    b.run("start_water_velocity", {}, names);
}

void plan_water(Builder b) {
    if (!b.has(EFFECT_WATER)) return;
    const bool traced = b.has(EFFECT_SEMI_LAGRANGIAN);
    if (traced) b.run("update_water_boundary_types", {}, spread_heights(b));
    // In flux form the diffusive flux carries its momentum; traced velocities need a pass for it.
    if (traced && b.has(EFFECT_LAPLACE_DIFFUSION) && !b.has(EFFECT_DIFFUSION_AHEAD))
        b.run("diffuse_mixed_velocity", {"mixed_velocity_x", "mixed_velocity_y"});
    plan_water_motion(b);
    if (b.has(EFFECT_WHOLE_PRESSURE)) b.run("push_mixed_water");
    if (b.has(EFFECT_BED_SHEAR)) b.run("compute_bed_load");
    // Algorithm 1 takes each cell's own, of the moment.
    if (b.has(EFFECT_COHESION) && !b.has(EFFECT_ALGORITHM_1) && !b.fuse("smooth_saturation", {})) b.run("compute_saturation");
}

void account_sand(Builder& b) {
    if (!b.has(EFFECT_OPEN_SIDES)) return;
    b.run("account_sides", {}, {{"flux_x", "sand_flux_x"}, {"flux_y", "sand_flux_y"}, {"side_ledger", "sand_side_ledger"}});
}

void plan_sand_height(Builder& b) {
    b.run("limit_sand_outflow");
    b.run("compute_sand_flux");
    account_sand(b);
    b.run("integrate_sand_height");
}

// Stretch and sand height move.
void plan_sand_transport(Builder& b) {
    const std::vector<std::string> stretch = {"stretch_xx", "stretch_xy", "stretch_yy"};
    if (b.fuse("transport_sand", stretch)) {
        account_sand(b);
        return;
    }
    plan_sand_height(b);
    if (b.has(EFFECT_WHOLE_STRAIN))
        b.run("advect_deformation_gradient", {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"});
    else if (b.has(EFFECT_ELASTOPLASTIC))
        b.run("evolve_deformation_gradient", stretch);
}

// The water's layers behind a change of the sand's height.
void plan_layer_exchange(Builder& b) {
    if (!b.has(EFFECT_EXPLICIT_EXCHANGE)) {
        b.run("compute_momentum_exchange");
        b.only_where_both_run();
        return;
    }
    for (const char* stage : {"measure_layer_exchange", "give_layer_exchange"}) {
        b.run(stage, {}, exchange_over("sand_height", next_name("sand_height")));
        b.only_where_both_run();
    }
}

// The water that drags the sand, by the names of the stages that do it.
Names drag_names(const Builder& b) {
    if (!b.has(EFFECT_DRAG)) return {};
    const std::string layer = b.has(EFFECT_MIXTURE) ? "mixed_velocity_" : "water_velocity_";
    return {{"drag_velocity_x", layer + "x"}, {"drag_velocity_y", layer + "y"}};
}

// Lines 5 to 9 of the paper's Algorithm 1 (NUMERICS 2.22).
void plan_algorithm_1(Builder& b) {
    const std::vector<std::string> strain = {"stretch_xx", "stretch_xy", "stretch_yy", "rotation"};
    const Names moved = {{"sand_height", next_name("sand_height")}};
    plan_sand_height(b);
    plan_backtrace(b, "sand", "backtrace_sand_velocity");
    Names push = drag_names(b);
    push.merge(Names(moved));
    b.run("push_sand", {}, push);
    if (b.has(EFFECT_WHOLE_STRAIN)) {
        b.run("yield_right_stretch", {}, moved);
        b.run("advect_deformation_gradient", strain);
        b.run("compute_sand_stress", {}, moved);
        b.run("apply_sand_stress", {}, moved);
        Names stretched = moved;
        if (b.has(EFFECT_STRAIN_BEYOND)) {
            b.run("update_sand_boundary_types", {}, moved);
            b.run("extrapolate_velocity", {},
                  {{"velocity_x", "sand_velocity_x"},
                   {"velocity_y", "sand_velocity_y"},
                   {"face_type_x", "sand_face_type_x"},
                   {"face_type_y", "sand_face_type_y"}});
            stretched.merge(
                Names{{"sand_velocity_x", "extrapolated_velocity_x"}, {"sand_velocity_y", "extrapolated_velocity_y"}});
        }
        b.run("stretch_deformation_gradient", {}, stretched);
        if (b.has(EFFECT_STRAIN_BEYOND)) b.run("extrapolate_strain", strain, moved);
    }
    if (b.has(EFFECT_MIXTURE)) plan_layer_exchange(b);
}

void plan_sand(Builder b) {
    if (!b.has(EFFECT_SAND)) return;
    if (b.has(EFFECT_OPEN_SIDES)) b.run("open_sand_sides");
    if (b.has(EFFECT_SEMI_LAGRANGIAN)) b.run("update_sand_boundary_types");
    if (b.has(EFFECT_ALGORITHM_1)) {
        plan_algorithm_1(b);
        return;
    }
    plan_sand_transport(b);
    // Touches only the water's velocities, which the sand's velocity stage does not read: here both sand heights are at hand.
    if (b.has(EFFECT_MIXTURE) && !b.fuses_momentum_exchange()) plan_layer_exchange(b);
}

// After the sand height has become current.
void plan_sand_forces(Builder b) {
    if (!b.has(EFFECT_SAND)) return;
    const bool printed = b.has(EFFECT_ALGORITHM_1); // only friction is left
    if (b.has(EFFECT_ELASTOPLASTIC) && !printed && !b.can_fuse("transport_sand")) b.run("project_deformation_gradient");
    const std::vector<std::string> sand = {"sand_velocity_x", "sand_velocity_y"};
    std::vector<std::string> moved = sand;
    if (b.fuses_momentum_exchange()) {
        moved.insert(moved.end(), {"water_velocity_x", "water_velocity_y", "mixed_velocity_x", "mixed_velocity_y"});
        b.run("accelerate_mixture", moved);
        return;
    }
    const Names drag = drag_names(b);
    for (const auto& [binding, field] : drag) moved.push_back(field);
    if (b.fuse("accelerate_sand", moved, drag)) return;
    if (!printed) {
        if (b.has(EFFECT_SEMI_LAGRANGIAN)) plan_backtrace(b, "sand", "backtrace_sand_velocity");
        b.run("integrate_sand_velocity", sand);
        if (b.has(EFFECT_WHOLE_STRAIN)) b.run("stretch_deformation_gradient");
        if (b.has(EFFECT_EXPLICIT_DRAG)) b.run("apply_drag", {}, drag);
    }
    b.run("apply_friction", moved, drag);
}

// One list of tiles, or one for the water's passes, one for the sand's and one for those of both.
void plan_active_tiles(Builder b) {
    if (!b.tiles_by_material()) {
        for (const char* stage : {"mark_active_tiles", "count_active_tiles", "list_active_tiles"}) b.run(stage);
        return;
    }
    b.run("choose_active_tiles");
    b.run("look_into_tiles");
    for (const char* stage : {"count_active_tiles", "list_active_tiles"}) {
        for (const std::string& ending : b.tile_lists()) {
            const auto fields = tile_list(ending);
            Names names;
            for (std::size_t n = 0; n < fields.size(); ++n) names[tile_fields[n]] = fields[n];
            b.run(stage, {}, names);
        }
    }
}

// Two lists, unless the substeps move the water's velocities to their other buffers, as single-layer drag does: they would have
// to in tiles without sand, too.
bool tells_materials_apart(std::uint32_t effects) {
    constexpr std::uint32_t both = EFFECT_WATER | EFFECT_SAND, drag = EFFECT_DRAG | EFFECT_MIXTURE;
    return (effects & both) == both && (effects & drag) != EFFECT_DRAG;
}

// What a pass reads on one side carries changes to the other: the sums along each direction count, and the largest of them.
int reach_of(const StepPlan& plan) {
    compute::Reach sum;
    const auto add = [&](const std::vector<PlanPass>& passes, int times) {
        for (const auto& pass : passes) {
            const auto& stage = compute::stage_table()[static_cast<std::size_t>(pass.stage)];
            const bool far = stage.fused() || (plan.effects & stage.far_effects) == stage.far_effects;
            const auto most = [&](int n) { return times * (far ? n : std::min(n, 1)); };
            sum.west += most(stage.reach.west);
            sum.south += most(stage.reach.south);
            sum.east += most(stage.reach.east);
            sum.north += most(stage.reach.north);
        }
    };
    add(plan.water_passes, 1);
    add(plan.substep_passes, plan.substeps);
    return std::max({sum.west, sum.south, sum.east, sum.north});
}

// Scratch fields whose lives do not overlap share memory. A life runs from the first to the last pass that names the field;
// what is written before the substeps and read in them lives through all of them.
void share_scratch(StepPlan& plan) {
    std::vector<const PlanPass*> order;
    for (const auto& pass : plan.water_passes) order.push_back(&pass);
    for (const auto& pass : plan.substep_passes) order.push_back(&pass);
    struct Life {
        PlanField* field;
        std::size_t first, last;
    };
    std::vector<Life> lives;
    for (auto& field : plan.fields) {
        // Its ghosts are read. They are 0, and what another field of this plan or of the one before leaves there must not get in.
        if (field.role != FieldRole::scratch || field.name == "mixed_diffused") continue;
        Life life{&field, order.size(), 0};
        for (std::size_t n = 0; n < order.size(); ++n) {
            if (std::find(order[n]->fields.begin(), order[n]->fields.end(), field.name) == order[n]->fields.end()) continue;
            life.first = std::min(life.first, n);
            life.last = std::max(life.last, n);
        }
        if (life.first < plan.water_passes.size() && life.last >= plan.water_passes.size()) life.last = order.size();
        lives.push_back(life);
    }
    std::sort(lives.begin(), lives.end(), [](const Life& a, const Life& b) { return a.first < b.first; });
    std::vector<std::size_t> busy_until; // per block
    for (auto& life : lives) {
        if (plan.active_tiles) life.last = order.size();
        std::size_t block = 0;
        while (block < busy_until.size() && busy_until[block] >= life.first) ++block;
        if (block == busy_until.size()) busy_until.push_back(0);
        busy_until[block] = life.last;
        life.field->memory = static_cast<int>(block);
    }
    plan.scratch_blocks = static_cast<int>(busy_until.size());
}

} // namespace

std::vector<std::string> StepPlan::tile_lists() const {
    if (!tiles_by_material) return {""};
    if ((effects & EFFECT_MIXTURE) == 0) return {"_water", "_sand"};
    return {"_water", "_sand", "_mixture"};
}

std::vector<std::string> tile_list(const std::string& ending) {
    std::vector<std::string> names(tile_fields.begin(), tile_fields.end());
    for (auto& name : names) name += ending;
    if (ending == "_mixture") names[0] = "activity_sand"; // its passes are of the substeps
    return names;
}

const PlanField* StepPlan::find(const std::string& name) const& {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const PlanField& f) { return f.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

StepPlan make_step_plan(std::uint32_t effects, int substeps, PlanChoice choice) {
    StepPlan plan;
    plan.active_tiles = choice.active_tiles;
    plan.fused = choice.fused;
    plan.effects = effects;
    plan.substeps = substeps;
    plan.tiles_by_material = choice.active_tiles && tells_materials_apart(effects);
    const Builder water(plan, plan.water_passes, false), substep(plan, plan.substep_passes, true);
    if (choice.active_tiles) plan_active_tiles(water);
    plan_inflow(water);
    plan.start_at = plan.water_passes.size();
    plan_start({plan, plan.start_passes, false});
    plan_water(water);
    plan_sand(substep);
    if (!plan.substep_passes.empty()) plan.substep_passes.back().flips.push_back("sand_height");
    plan_sand_forces(substep);

    plan.fields.push_back({"terrain", field_row("terrain").role});
    plan.fields.push_back({"source_ledger", field_row("source_ledger").role}); // edits count there in any world
    for (const auto* passes : {&plan.water_passes, &plan.substep_passes}) {
        for (const auto& pass : *passes) {
            for (const auto& name : pass.fields) {
                if (name.empty()) continue;
                const std::string base = base_name(name);
                auto found =
                    std::find_if(plan.fields.begin(), plan.fields.end(), [&](const PlanField& f) { return f.name == base; });
                if (found == plan.fields.end()) found = plan.fields.insert(plan.fields.end(), {base, field_row(base).role});
                found->ping_pong |= is_next(name);
            }
        }
    }
    // By name, so that a snapshot's bytes do not tell how a world was run.
    std::sort(plan.fields.begin(), plan.fields.end(), [](const PlanField& a, const PlanField& b) { return a.name < b.name; });
    share_scratch(plan);
    plan.reach = reach_of(plan);
    return plan;
}

void share_fields(StepPlan& tiled, StepPlan& whole) {
    for (const auto& field : whole.fields) {
        const auto found =
            std::find_if(tiled.fields.begin(), tiled.fields.end(), [&](const PlanField& f) { return f.name == field.name; });
        if (found != tiled.fields.end()) {
            found->ping_pong |= field.ping_pong;
            continue;
        }
        tiled.fields.push_back(field);
        if (field.role == FieldRole::scratch && field.memory >= 0) tiled.fields.back().memory = tiled.scratch_blocks++;
    }
    std::sort(tiled.fields.begin(), tiled.fields.end(), [](const PlanField& a, const PlanField& b) { return a.name < b.name; });
    whole.fields = tiled.fields;
    whole.scratch_blocks = tiled.scratch_blocks;
}

} // namespace wadi
