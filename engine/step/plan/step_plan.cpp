#include "engine/step/plan/plan_builder.hpp"
#include <algorithm>
#include <array>

namespace wadi {

namespace {

// What a list of active tiles consists of: the dispatches of a pass over tiles name them too.
constexpr std::array tile_fields = {"activity", "active_tiles", "active_counts", "active_list", "active_dispatch"};

// What transport of water takes for the sand: with infiltration that whose pores hold what is in them, so that the rest stands on
// it.
Names open_names(const PlanBuilder& b) {
    if (!b.has(EFFECT_INFILTRATION)) return {};
    return {{"sand_height", "open_sand"}};
}

// What the sand takes for its water: with infiltration none that waits above pores which have room.
Names felt_names(const PlanBuilder& b) {
    if (!b.has(EFFECT_INFILTRATION)) return {};
    return {{"water_height", "felt_water"}};
}

void plan_water_fluxes(PlanBuilder& b) {
    if (b.has(EFFECT_DIFFUSION)) b.run("diffuse_mixed_water", {}, open_names(b));
    b.run("limit_water_outflow", {}, open_names(b));
    b.run("compute_water_flux", {}, open_names(b));
}

// Both layers' fluxes and the new height.
void plan_water_transport(PlanBuilder& b) {
    plan_water_fluxes(b);
    if (b.has(EFFECT_OPEN_SIDES)) account_water(b);
    b.run("integrate_water_height", {"water_height"}, open_names(b));
    if (b.has(EFFECT_INFILTRATION)) b.run("infiltrate");
}

// Momentum advection of second order takes the pure water's velocities at the time of the heights, the mixed water's as they are.
void plan_water_velocity(PlanBuilder& b, std::vector<std::string> flips, Names names) {
    if (b.has(EFFECT_SECOND_ORDER_WATER)) b.run("center_water_velocity", {}, names);
    names["centered_mixed_velocity_x"] = "mixed_velocity_x";
    names["centered_mixed_velocity_y"] = "mixed_velocity_y";
    b.run("integrate_water_velocity", std::move(flips), names);
}

// Height and velocities of the water.
void plan_water_motion(PlanBuilder& b) {
    std::vector<std::string> moved = {"water_velocity_x", "water_velocity_y"};
    if (b.has(EFFECT_MIXTURE)) moved.insert(moved.end(), {"mixed_velocity_x", "mixed_velocity_y"});
    std::vector<std::string> all = moved;
    all.push_back("water_height");
    if (b.fuse("step_water", all) || b.fuse("step_mixed_water", all)) {
        if (b.has(EFFECT_OPEN_SIDES)) account_water(b);
        return;
    }
    plan_water_transport(b);
    plan_water_velocity(b, moved, {});
}

// What comes from outside; the published method spreads mixed water between that and the sides.
void plan_inflow(PlanBuilder b) {
    if (b.has(EFFECT_SOURCES | EFFECT_WATER) && !b.has(EFFECT_PUBLISHED)) b.run("mix_source_momentum");
    if (b.has(EFFECT_SOURCES)) b.run("apply_sources");
    if (b.has(EFFECT_RAIN)) b.run("apply_rain");
    if (b.has(EFFECT_RAIN_MAP) && !b.has(EFFECT_PUBLISHED)) b.run("dilute_water_velocity");
    if (b.has(EFFECT_INFILTRATION)) b.run("open_pores");
    if (b.has(EFFECT_PUBLISHED)) plan_published_diffusion(b);
    if (b.has(EFFECT_WATER | EFFECT_OPEN_SIDES)) b.run("open_sides");
}

// A step's heights and velocities are tried in the other buffers of their fields, and velocities go half the way there.
void plan_start(PlanBuilder b) {
    if (!b.has(EFFECT_SECOND_ORDER_WATER) || b.has(EFFECT_PUBLISHED)) return;
    plan_water_fluxes(b);
    b.run("integrate_water_height", {}, open_names(b));
    plan_water_velocity(b, {}, {{"water_height", "water_height_next"}});
    Names names;
    for (const std::string axis : {"x", "y"}) {
        names["velocity_" + axis] = "water_velocity_" + axis;
        names["tried_velocity_" + axis] = next_name("water_velocity_" + axis);
    }
    b.run("start_water_velocity", {}, names);
}

void plan_water(PlanBuilder b) {
    if (!b.has(EFFECT_WATER)) return;
    plan_water_motion(b);
}

// What water leaves on the surface to be seen, behind its motion.
void plan_surface(PlanBuilder b) {
    if (b.has(EFFECT_FOAM)) b.run("carry_foam", {"surface_foam"});
    if (b.has(EFFECT_WETNESS)) b.run("wet_ground");
    if (b.has(EFFECT_SILT)) b.run("carry_silt", {"silt"});
}

// What the sand's substeps take from the water, once for all of them.
void plan_water_on_sand(PlanBuilder b) {
    if (!b.has(EFFECT_WATER)) return;
    if (b.has(EFFECT_BED_SHEAR)) b.run("compute_bed_load");
    if (b.has(EFFECT_COHESION) && !b.fuse("smooth_saturation", {}, felt_names(b))) b.run("compute_saturation", {}, felt_names(b));
}

// Stretch and sand height move.
void plan_sand_transport(PlanBuilder& b) {
    const std::vector<std::string> stretch = {"stretch_xx", "stretch_xy", "stretch_yy"};
    if (b.fuse("transport_sand", stretch)) {
        account_sand(b);
        return;
    }
    plan_sand_height(b);
    if (b.has(EFFECT_ELASTOPLASTIC)) b.run("evolve_deformation_gradient", stretch);
}

void plan_sand(PlanBuilder b) {
    if (!b.has(EFFECT_SAND)) return;
    if (b.has(EFFECT_OPEN_SIDES)) b.run("open_sand_sides");
    plan_sand_transport(b);
    if (!b.has(EFFECT_MIXTURE) || b.fuses_momentum_exchange()) return;
    // Touches only the water's velocities, which the sand's velocity stage does not read: here both sand heights are at hand.
    b.run("compute_momentum_exchange");
    b.only_where_both_run();
}

// After the sand height has become current.
void plan_sand_forces(PlanBuilder b) {
    if (!b.has(EFFECT_SAND)) return;
    if (b.has(EFFECT_ELASTOPLASTIC) && !b.can_fuse("transport_sand")) b.run("project_deformation_gradient");
    const std::vector<std::string> sand = {"sand_velocity_x", "sand_velocity_y"};
    std::vector<std::string> moved = sand, fused = sand;
    if (b.has(EFFECT_SLOPE_NORMAL)) fused.emplace_back("wedge_depth");
    if (b.fuses_momentum_exchange()) {
        fused.insert(fused.end(), {"water_velocity_x", "water_velocity_y", "mixed_velocity_x", "mixed_velocity_y"});
        b.run("accelerate_mixture", fused);
        return;
    }
    Names drag = drag_names(b);
    for (const auto& [binding, field] : drag) {
        moved.push_back(field);
        fused.push_back(field);
    }
    drag.merge(felt_names(b));
    if (b.fuses_forces() && b.fuse("accelerate_sand", fused, drag)) return;
    if (b.has(EFFECT_SLOPE_NORMAL)) b.run("bend_sand_velocity");
    if (b.has(EFFECT_FLOW_FRICTION)) b.run("raise_friction");
    b.run("integrate_sand_velocity", sand, felt_names(b));
    if (b.has(EFFECT_SLOPE_NORMAL)) b.run("raise_failing_planes", {"wedge_depth"});
    b.run("apply_friction", moved, drag);
}

// One list of tiles, or one for the water's passes, one for the sand's and one for those of both.
void plan_active_tiles(PlanBuilder b) {
    if (!b.tiles_by_material()) {
        for (const char* stage : {"mark_active_tiles", "count_active_tiles", "list_active_tiles"}) b.run(stage);
        if (b.has(EFFECT_WATER)) b.run("keep_water_awake", {}, open_names(b));
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
    b.run("keep_water_awake", {}, {{"active_tiles", "active_tiles_water"}, {"activity", "activity_water"}});
}

// Two lists, unless the substeps move the water's velocities to their other buffers, as single-layer drag does: they would have
// to in tiles without sand, too. With infiltration the sand reads what the water's passes leave, also where all water is gone.
bool tells_materials_apart(std::uint32_t effects) {
    constexpr std::uint32_t both = EFFECT_WATER | EFFECT_SAND, drag = EFFECT_DRAG | EFFECT_MIXTURE;
    return (effects & both) == both && (effects & drag) != EFFECT_DRAG && (effects & EFFECT_INFILTRATION) == 0;
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
    for (std::size_t n = 0; n < plan.water_passes.size(); ++n) add({plan.water_passes[n]}, plan.times(n));
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
        if (field.role != FieldRole::scratch || field.name == "mixed_diffused" || field.name == "open_sand" ||
            field.name == "felt_water")
            continue;
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

std::vector<PlanPass> StepPlan::water_part(int n, bool start) const {
    std::vector<PlanPass> part;
    const auto add = [&](const std::vector<PlanPass>& from, std::size_t begin, std::size_t end) {
        part.insert(part.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                    from.begin() + static_cast<std::ptrdiff_t>(end));
    };
    add(water_passes, n == 0 ? 0 : again_from, start_at);
    if (start && n == 0) add(start_passes, 0, start_passes.size());
    add(water_passes, start_at, n + 1 == water_substeps ? water_passes.size() : again_to);
    return part;
}

const PlanField* StepPlan::find(const std::string& name) const& {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const PlanField& f) { return f.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

StepPlan make_step_plan(std::uint32_t effects, Substeps substeps, PlanChoice choice) {
    StepPlan plan;
    plan.active_tiles = choice.active_tiles;
    plan.fused = choice.fused;
    plan.fused_slopes = choice.fused_slopes;
    plan.effects = effects;
    plan.substeps = substeps.sand;
    plan.water_substeps = substeps.water;
    plan.tiles_by_material = choice.active_tiles && tells_materials_apart(effects);
    const PlanBuilder water(plan, plan.water_passes, false), substep(plan, plan.substep_passes, true);
    if (choice.active_tiles) plan_active_tiles(water);
    plan.again_from = plan.water_passes.size();
    plan_inflow(water);
    plan.start_at = plan.water_passes.size();
    plan_start({plan, plan.start_passes, false});
    const bool published = water.has(EFFECT_PUBLISHED);
    published ? plan_published_water(water) : plan_water(water);
    plan_surface(water);
    plan.again_to = plan.water_passes.size();
    if (!published) plan_water_on_sand(water);
    published ? plan_published_sand(substep) : plan_sand(substep);
    if (!plan.substep_passes.empty()) plan.substep_passes.back().flips.push_back("sand_height");
    published ? plan_published_friction(substep) : plan_sand_forces(substep);

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
