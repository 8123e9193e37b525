// Effects decide which passes and buffers exist: checked for every legal mask.
#include "engine/settings/data/method_presets.hpp"
#include "engine/settings/rules/effects.hpp"
#include "engine/step/plan/step_plan.hpp"
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <fstream>
#include <set>

using namespace wadi;

namespace {

// Laws of sand that are branches of stages that run anyway.
constexpr std::uint32_t sand_laws = EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION | EFFECT_RETENTION;

// With none of the sand's laws and with all that are legal, a few with some of them, and a few with each of what adds no pass but
// its own to any other: the water's viscosity, a map of rain, a rate of infiltration, foam, wetness, silt. Under sanitizers a few
// of all.
std::vector<std::uint32_t> legal_masks() {
    constexpr std::array lone = {EFFECT_SHOCK_VISCOSITY, EFFECT_RAIN_MAP, EFFECT_INFILTRATION, EFFECT_FOAM,
                                 EFFECT_WETNESS,         EFFECT_SILT};
    constexpr std::uint32_t any_lone = EFFECT_SHOCK_VISCOSITY | EFFECT_RAIN_MAP | EFFECT_INFILTRATION | only_seen;
    std::uint32_t all = all_effects;
    for (const auto& choice : choice_table()) all |= choice.bit;
    all &= ~any_lone;
    std::vector<std::uint32_t> masks;
    int between = 0;
    for (std::uint32_t mask = 1; mask <= all; ++mask) {
        if ((mask & any_lone) != 0 || (mask & (EFFECT_WATER | EFFECT_SAND)) == 0 || !is_legal(mask)) continue;
        bool most = true;
        for (const std::uint32_t law : {EFFECT_SLOPE_NORMAL, EFFECT_INTERNAL_FRICTION, EFFECT_RETENTION})
            most = most && ((mask & law) != 0 || !is_legal(mask | law));
        if (most || (mask & sand_laws) == 0 || ++between % 17 == 0) masks.push_back(mask);
        for (const std::uint32_t bit : lone)
            if (is_legal(mask | bit) && ++between % 17 == 0) masks.push_back(mask | bit);
    }
    masks.push_back(all_effects | any_lone);
    if (!test::few_steps) return masks;
    std::vector<std::uint32_t> few = {masks.back()};
    for (std::size_t n = 0; n < masks.size(); n += 17) few.push_back(masks[n]);
    return few;
}

// Every legal mask one by one, and fused: with and without active tiles, and without what accelerates sand on slopes.
std::vector<std::pair<std::uint32_t, PlanChoice>> legal_plans() {
    std::vector<std::pair<std::uint32_t, PlanChoice>> plans;
    for (const auto mask : legal_masks())
        for (const PlanChoice choice : {PlanChoice{},
                                        {.active_tiles = false, .fused = true},
                                        {.active_tiles = true, .fused = true},
                                        {.active_tiles = false, .fused = true, .fused_slopes = false}})
            plans.emplace_back(mask, choice);
    return plans;
}

// Every seventh of them, and so of each kind: for what hangs on few bits.
std::vector<std::pair<std::uint32_t, PlanChoice>> some_plans() {
    const auto all = legal_plans();
    std::vector<std::pair<std::uint32_t, PlanChoice>> some;
    for (std::size_t n = 0; n < all.size(); n += 7) some.push_back(all[n]);
    return some;
}

bool runs(const StepPlan& plan, const char* stage) {
    const int index = compute::find_stage(stage);
    REQUIRE(index >= 0);
    const auto is = [&](const PlanPass& pass) { return pass.stage == index; };
    return std::any_of(plan.water_passes.begin(), plan.water_passes.end(), is) ||
           std::any_of(plan.substep_passes.begin(), plan.substep_passes.end(), is);
}

constexpr std::uint32_t everything = all_effects | EFFECT_SHOCK_VISCOSITY;
constexpr std::uint32_t default_water = EFFECT_WATER | EFFECT_SHOCK_VISCOSITY; // of the default method

} // namespace

TEST_CASE("every legal mask gives a plan whose scratch is written before it is read") {
    for (const auto mask : legal_masks()) {
        const auto plan = make_step_plan(mask, 3);
        std::set<std::string> written;
        std::vector<PlanPass> order = plan.water_passes;
        order.insert(order.end(), plan.substep_passes.begin(), plan.substep_passes.end());
        for (const auto& pass : order) {
            const auto& bindings = compute::stage_table()[static_cast<std::size_t>(pass.stage)].bindings;
            for (std::size_t n = 0; n < bindings.size(); ++n) {
                const auto* field = plan.find(pass.fields[n]);
                if (field == nullptr || field->role != FieldRole::scratch || bindings[n].access != compute::Access::in) continue;
                CHECK_MESSAGE(written.contains(field->name),
                              "mask " << mask << ": " << field->name << " is read before it is written");
            }
            for (std::size_t n = 0; n < bindings.size(); ++n) {
                if (bindings[n].access != compute::Access::in) written.insert(pass.fields[n]);
            }
        }
    }
}

TEST_CASE("no pass binds one memory block twice with a write, whatever the mask") {
    for (const auto mask : legal_masks()) {
        const auto plan = make_step_plan(mask, 2);
        for (const auto* passes : {&plan.water_passes, &plan.substep_passes}) {
            for (const auto& pass : *passes) {
                std::set<int> blocks;
                for (const auto& name : pass.fields) {
                    const auto* field = plan.find(name);
                    if (field == nullptr || field->role != FieldRole::scratch) continue;
                    CHECK_MESSAGE(blocks.insert(field->memory).second,
                                  "mask " << mask << ": " << name << " shares its block within one pass");
                }
            }
        }
    }
}

TEST_CASE("scratch that lives across the substeps is overwritten by nobody in them") {
    const auto plan = make_step_plan(everything, 3);
    for (const char* name : {"pressure_x", "pressure_y", "saturation"}) {
        const auto* keeper = plan.find(name);
        REQUIRE(keeper != nullptr);
        for (const auto& pass : plan.substep_passes) {
            for (const auto& other : pass.fields) {
                const auto* field = plan.find(other);
                if (field == nullptr || field->role != FieldRole::scratch || field->name == name) continue;
                CHECK_MESSAGE(field->memory != keeper->memory, other << " lies on " << name);
            }
        }
    }
}

TEST_CASE("what accelerates sand on slopes runs stage by stage where its fused kernel does not pay, the rest fused") {
    const std::uint32_t dry = EFFECT_SAND | EFFECT_SLOPE_NORMAL;
    for (const auto& [mask, stage] : {std::pair{everything, "accelerate_mixture"}, std::pair{dry, "accelerate_sand"}}) {
        const auto whole = make_step_plan(mask, 3, {.fused = true});
        CHECK(runs(whole, stage));
        CHECK_FALSE(runs(whole, "bend_sand_velocity"));
        const auto apart = make_step_plan(mask, 3, {.fused = true, .fused_slopes = false});
        CHECK_FALSE(runs(apart, stage));
        for (const char* alone : {"bend_sand_velocity", "integrate_sand_velocity", "raise_failing_planes", "apply_friction"})
            CHECK_MESSAGE(runs(apart, alone), alone);
        CHECK(runs(make_step_plan(mask & ~EFFECT_SLOPE_NORMAL, 3, {.fused = true, .fused_slopes = false}), stage));
    }
    CHECK(runs(make_step_plan(everything, 3, {.fused = true, .fused_slopes = false}), "transport_sand"));
}

TEST_CASE("every flipped field comes back after two steps, and each pass writes what it flips") {
    for (const auto& [mask, choice] : legal_plans()) {
        const auto plan = make_step_plan(mask, 3, choice);
        for (const auto* passes : {&plan.water_passes, &plan.substep_passes}) {
            std::set<std::string> written;
            for (const auto& pass : *passes) {
                REQUIRE(pass.stage >= 0);
                const auto& bindings = compute::stage_table()[static_cast<std::size_t>(pass.stage)].bindings;
                for (std::size_t n = 0; n < bindings.size(); ++n) {
                    if (bindings[n].access != compute::Access::in) written.insert(pass.fields[n]);
                }
                for (const auto& flip : pass.flips)
                    CHECK_MESSAGE(written.contains(flip + "_next"), "mask " << mask << ": " << flip << " flips unwritten");
            }
        }
    }
}

TEST_CASE("an effect that is off has no pass and no buffer") {
    const auto water = make_step_plan(EFFECT_WATER, 3);
    CHECK(water.substep_passes.empty());
    CHECK(water.water_passes.size() == 4);
    CHECK(water.find("sand_height") == nullptr);
    CHECK(water.find("mixed_velocity_x") == nullptr);
    CHECK(water.bytes_per_cell() <= 56);

    const auto dry = make_step_plan(EFFECT_SAND, 3);
    CHECK(dry.water_passes.empty());
    CHECK(dry.find("water_height") == nullptr);
    CHECK(dry.find("stretch_xx") == nullptr);
    CHECK_FALSE(runs(dry, "project_deformation_gradient"));
    CHECK(runs(make_step_plan(EFFECT_SAND | EFFECT_ELASTOPLASTIC, 3), "project_deformation_gradient"));

    const auto single = make_step_plan(EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG, 3);
    CHECK(single.find("mixed_velocity_x") == nullptr);
    CHECK_FALSE(runs(single, "compute_momentum_exchange"));

    const auto full = make_step_plan(everything, 3);
    CHECK(full.bytes_per_cell() <= 204);
    for (const auto& effect : effect_table()) {
        std::uint32_t without = everything & ~effect.bit;
        for (const auto& other : effect_table()) {
            if ((other.needs & ~without) != 0 && (without & other.bit) != 0) without &= ~other.bit;
        }
        const auto less = make_step_plan(without, 3);
        const bool fewer_passes =
            less.water_passes.size() + less.substep_passes.size() < full.water_passes.size() + full.substep_passes.size();
        // Some are branches of a stage that runs anyway; the others are passes of their own.
        const auto branches = [&](const PlanPass& pass) {
            return (compute::stage_table()[static_cast<std::size_t>(pass.stage)].tested_effects & effect.bit) != 0;
        };
        const bool is_branch = std::any_of(less.water_passes.begin(), less.water_passes.end(), branches) ||
                               std::any_of(less.substep_passes.begin(), less.substep_passes.end(), branches);
        CHECK_MESSAGE((fewer_passes || is_branch), effect.name << " off removes neither a pass nor a branch");
        CHECK(less.bytes_per_cell() <= full.bytes_per_cell());
    }
}

TEST_CASE("choices of method are passes of their own at their place in the order") {
    const auto order = [](const std::vector<PlanPass>& passes) {
        std::string names;
        for (const auto& pass : passes)
            names += std::string(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name) + " ";
        return names;
    };
    // The paper's Algorithm 1.
    constexpr std::uint32_t mixed = EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE | EFFECT_DIFFUSION | EFFECT_ELASTOPLASTIC;
    const auto plan = make_step_plan(mixed | EFFECT_PUBLISHED, 3);
    CHECK(order(plan.water_passes) == "diffuse_mixed_velocity diffuse_mixed_height spread_mixed_water "
                                      "update_water_boundary_types limit_water_outflow compute_water_flux integrate_water_height "
                                      "measure_layer_exchange extrapolate_velocity backtrace_water_velocity "
                                      "extrapolate_velocity backtrace_water_velocity give_layer_exchange push_water ");
    CHECK(order(plan.substep_passes) ==
          "update_sand_boundary_types limit_sand_outflow compute_sand_flux integrate_sand_height "
          "extrapolate_velocity backtrace_sand_velocity push_sand yield_right_stretch advect_deformation_gradient "
          "compute_sand_stress apply_sand_stress update_sand_boundary_types extrapolate_velocity stretch_deformation_gradient "
          "extrapolate_strain measure_layer_exchange give_layer_exchange apply_frictional_force ");
    CHECK(plan.find("rotation") != nullptr);
    const auto robust = make_step_plan(mixed, 3);
    CHECK(robust.find("rotation") == nullptr);
    auto scene = test::flat_scene(8, 8, 1, 0.01);
    scene.fill(scene.fields.water, [](double, double) { return 1; });
    choose_method(scene.settings, "published");
    scene.settings.method.strain_transport = StrainTransport::direct; // no sand: nothing to act on
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == (EFFECT_WATER | EFFECT_PUBLISHED));
    scene.settings.method = {};
    scene.settings.method.water_transport_order = 2;
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == (default_water | EFFECT_SECOND_ORDER_WATER));
    // The same passes and one more, which reads the terrain; for water in pores the fluxes read it as well.
    const auto second = make_step_plan(EFFECT_WATER | EFFECT_SECOND_ORDER_WATER, 3), first = make_step_plan(EFFECT_WATER, 3);
    CHECK(order(second.water_passes) == "limit_water_outflow compute_water_flux integrate_water_height center_water_velocity "
                                        "integrate_water_velocity ");
    CHECK(second.field_buffers() == first.field_buffers() + 1);
    // Step 0 tries them first; without a flip, since both programs of a step follow.
    CHECK(order(second.start_passes) == order(second.water_passes) + "start_water_velocity ");
    CHECK(second.start_at == 0);
    for (const auto& pass : second.start_passes) CHECK(pass.flips.empty());
    CHECK(first.start_passes.empty());
    CHECK(make_step_plan(EFFECT_WATER | EFFECT_SECOND_ORDER_WATER | EFFECT_PUBLISHED, 3).start_passes.empty());
    CHECK(make_step_plan(EFFECT_WATER | EFFECT_SECOND_ORDER_WATER | EFFECT_OPEN_SIDES | EFFECT_RAIN, 3).start_at == 2);
    const auto reads_terrain = [](const StepPlan& p) {
        return std::count_if(p.water_passes.begin(), p.water_passes.end(), [](const PlanPass& pass) {
            return std::find(pass.fields.begin(), pass.fields.end(), "terrain") != pass.fields.end();
        });
    };
    CHECK(reads_terrain(second) == reads_terrain(first) + 1);
    constexpr std::uint32_t pores = EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE;
    CHECK(reads_terrain(make_step_plan(pores | EFFECT_SECOND_ORDER_WATER, 3)) == reads_terrain(make_step_plan(pores, 3)) + 3);
    scene.settings.method.sand_transport_order = 2; // no sand: nothing to act on
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == (default_water | EFFECT_SECOND_ORDER_WATER));
    scene.fill(scene.fields.sand, [](double, double) { return 1; });
    CHECK((effects_required(scene.settings, content_of(scene.fields))->mask & EFFECT_SECOND_ORDER_SAND) != 0);
    const auto second_sand = make_step_plan(EFFECT_SAND | EFFECT_SECOND_ORDER_SAND, 3),
               first_sand = make_step_plan(EFFECT_SAND, 3);
    CHECK(order(second_sand.substep_passes) == order(first_sand.substep_passes));
    CHECK(second_sand.field_buffers() == first_sand.field_buffers());
    CHECK(second_sand.reach > first_sand.reach);
    constexpr std::uint32_t all = all_effects & ~(EFFECT_BED_SHEAR | EFFECT_ROUGHNESS | EFFECT_RAIN_MAP | EFFECT_FOAM |
                                                  EFFECT_WETNESS | EFFECT_SILT | sand_laws);
    CHECK(make_step_plan(all, 3).bytes_per_cell() == 132);
    CHECK(!is_legal(EFFECT_SAND | EFFECT_SLOPE_NORMAL | EFFECT_PUBLISHED));
    CHECK(!is_legal(EFFECT_SAND | EFFECT_ELASTOPLASTIC | EFFECT_DIRECT_STRAIN));
    auto dry = test::flat_scene(8, 8, 1, 0.01);
    dry.fill(dry.fields.sand, [](double, double) { return 1; });
    dry.settings.method.water_transport_order = 2; // no water: nothing to act on
    CHECK((effects_required(dry.settings, content_of(dry.fields))->mask & EFFECT_SECOND_ORDER_WATER) == 0);
}

TEST_CASE("effects follow from the scene, with a reason, and a level may force them") {
    using test::flat_scene;
    auto scene = flat_scene(8, 8, 1, 0.01);
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == 0);
    scene.fill(scene.fields.water, [](double, double) { return 1; });
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == default_water);
    scene.settings.method.shock_viscosity = 0;
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask == EFFECT_WATER);
    scene.settings.method.shock_viscosity = 0.25;
    scene.fill(scene.fields.sand, [](double, double) { return 1; });
    const auto full = effects_required(scene.settings, content_of(scene.fields));
    CHECK(full->mask == (default_water | EFFECT_SAND | EFFECT_MIXTURE | EFFECT_DIFFUSION | EFFECT_DRAG | EFFECT_ELASTOPLASTIC |
                         EFFECT_COHESION | EFFECT_SLOPE_NORMAL | EFFECT_INTERNAL_FRICTION | EFFECT_RETENTION));
    CHECK(full->reasons[0] == "the world holds water");
    scene.settings.effects = {{"mixture", Force::off}};
    CHECK(effects_required(scene.settings, content_of(scene.fields))->mask ==
          (default_water | EFFECT_SAND | EFFECT_DRAG | EFFECT_ELASTOPLASTIC | EFFECT_COHESION | EFFECT_SLOPE_NORMAL |
           EFFECT_INTERNAL_FRICTION));
    scene.settings.effects = {{"mixture", Force::off}, {"diffusion", Force::on}};
    const auto bad = effects_required(scene.settings, content_of(scene.fields));
    CHECK(bad.status().code == Code::bad_argument);
    CHECK(bad.status().message.find("effects.diffusion: on, but it needs mixture") != std::string::npos);
    for (const char* seen : {"foam", "wetness", "silt"}) { // on where there is what it needs, so that a world may run dry
        auto none = flat_scene(8, 8, 1, 0.01);
        none.settings.effects = {{seen, Force::on}};
        CHECK(effects_required(none.settings, {})->mask == 0);
        CHECK(effect_names(effects_required(none.settings, {.sand = true, .water = true})->mask).find(seen) != std::string::npos);
    }
    scene.settings.effects = {{"steam", Force::on}};
    CHECK(effects_required(scene.settings, content_of(scene.fields)).status().message.find("effects.steam") != std::string::npos);
}

TEST_CASE("the engine's pages name every stage of a step, and none that there is not") {
    std::set<std::string> named; // first column of the tables about the step
    for (const auto& [page, wanted] :
         {std::pair{"/engine/step/STEP.md", "One step"}, std::pair{"/engine/step/README.md", "Active tiles"}}) {
        std::ifstream file(std::string(WADI_SOURCE_DIR) + page);
        std::string line, section;
        while (std::getline(file, line)) {
            if (line.starts_with("## ")) section = line.substr(3);
            if (section != wanted || !line.starts_with("| `")) continue;
            const std::string column = line.substr(0, line.find(" | "));
            for (std::size_t at = 0; (at = column.find('`', at)) != std::string::npos;) {
                const std::size_t end = column.find('`', at + 1);
                named.insert(column.substr(at + 1, end - at - 1));
                at = end + 1;
            }
        }
    }
    std::set<std::string> run;
    for (const auto& [mask, choice] : some_plans()) {
        const auto plan = make_step_plan(mask, 1, {.active_tiles = choice.active_tiles});
        for (const auto* passes : {&plan.start_passes, &plan.water_passes, &plan.substep_passes})
            for (const auto& pass : *passes) run.emplace(compute::stage_table()[static_cast<std::size_t>(pass.stage)].name);
    }
    for (const auto& stage : run) CHECK_MESSAGE(named.contains(stage), "not in the pages: " << stage);
    for (const auto& stage : named) CHECK_MESSAGE((run.contains(stage) || test::few_steps), "in the pages alone: " << stage);
}

TEST_CASE(
    "fields: every field of every plan has a row, and exists only with the effects that it names; state with these always") {
    for (const auto& [mask, choice] : some_plans()) {
        const auto plan = make_step_plan(mask, 2, choice);
        for (const auto& field : plan.fields) {
            CAPTURE(field.name);
            const FieldRow* row = find_field(field.name);
            REQUIRE(row != nullptr);
            CHECK(row->role == field.role);
            CHECK((mask & row->needs) == row->needs);
        }
        for (const auto& row : field_table())
            if (row.role == FieldRole::state && (mask & row.needs) == row.needs)
                CHECK_MESSAGE(plan.find(std::string(row.name)) != nullptr, row.name);
    }
}

TEST_CASE("fields: a name without a row is refused; no name, number or symbol stands in two rows") {
    CHECK_THROWS_WITH(field_row("sand_hight"), "the field 'sand_hight' has no row in engine/step/plan/field_table.cpp");
    CHECK(find_field("sand_height_water") == nullptr); // lists of tiles are two, fields are not
    CHECK(&field_row("active_list_sand") == &field_row("active_list"));
    std::set<std::string_view> names, symbols;
    std::set<int> hosts;
    int hashed = 0;
    for (const auto& row : field_table()) {
        CHECK_MESSAGE(names.insert(row.name).second, row.name);
        hashed += row.hashed ? 1 : 0;
        if (row.host < 0) continue;
        CHECK_MESSAGE(symbols.insert(row.symbol).second, row.name);
        CHECK_MESSAGE(hosts.insert(row.host).second, row.name);
        CHECK(find_host_field(row.host) == &row);
    }
    CHECK(hashed == 18);
    CHECK(*hosts.rbegin() + 1 == static_cast<int>(hosts.size())); // as wadi_field, without a gap
    CHECK(find_host_field(-1) == nullptr);
}
