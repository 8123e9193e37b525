// Suite 5: each fused stage against the stages that it stands for, in bits: two plans of one step, with and without fused stages,
// from the same state on the same device. A tile that is cut wrongly differs at its rim, so that grids end inside and at tiles.
#include "engine/step/run/step_inputs.hpp"
#include "tests/conformance/case.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/pass_runner.hpp"
#include "tests/conformance/target.hpp"
#include <algorithm>

namespace wadi::conformance {

namespace {

constexpr int steps = 3;

Status run_steps(PassRunner& runner, const Scene& scene) {
    StepInputs inputs(scene.settings);
    for (int n = 0; n < steps; ++n) {
        const StepInput input = inputs.next(n);
        for (const PlanPass* pass : runner.passes())
            if (auto status = runner.run(*pass, input); !status) return status;
    }
    return ok_status();
}

bool plans(const StepPlan& plan, int stage) {
    const auto has = [&](const std::vector<PlanPass>& passes) {
        return std::any_of(passes.begin(), passes.end(), [&](const PlanPass& pass) { return pass.stage == stage; });
    };
    return has(plan.water_passes) || has(plan.substep_passes);
}

std::vector<CaseSpec> list() {
    std::vector<CaseSpec> cases;
    const auto grids = grid_names(), scenes = scene_names(), methods = method_names_of_cases();
    const auto stages = compute::stage_table();
    for (std::size_t stage = 0; stage < stages.size(); ++stage) {
        if (!stages[stage].fused()) continue;
        const auto masks = stage_masks(static_cast<int>(stage));
        // Every stage meets every grid and scene, every mask some; where there are many, half of the cases by turns.
        const bool many = masks.size() > 24;
        const std::size_t rounds = masks.size() < 4 ? scenes.size() : many ? 1 : 2;
        std::size_t turn = 0;
        bool other = true;
        for (const std::uint32_t mask : masks) {
            const auto add = [&](const std::string& grid, const std::string& scene, const std::string& method,
                                 std::uint32_t more = 0) {
                cases.push_back({std::string(stages[stage].name),
                                 {{"grid", grid}, {"effects", effects_text(mask | more)}, {"scene", scene}, {"method", method}}});
            };
            other = !other;
            add("70x50", "random", "default");
            if (!many || !other) add("170x90", "patches", "default");
            if ((!many || !other) && ((mask | stages[stage].without) & EFFECT_OPEN_SIDES) == 0)
                add("33x17", "random", "default", EFFECT_OPEN_SIDES);
            if (many && !other) continue;
            for (std::size_t n = 0; n < rounds; ++n, ++turn)
                add(grids[turn % grids.size()], scenes[turn % scenes.size()], methods[turn % methods.size()]);
        }
    }
    return cases;
}

Verdict run(const CaseSpec& spec, Session& session) {
    auto device = session.device();
    if (!device) return verdict_of(device.status());
    if (!(*device)->capabilities().fused_stages) return {Outcome::not_supported, "its groups are too small for fused stages"};
    auto mask = parse_effects(spec.get("effects", "none"));
    if (!mask) return verdict_of(mask.status());
    auto scene = make_scene(spec.get("grid", "33x17"), spec.get("scene", "random"), spec.get("method", "default"), *mask);
    if (!scene) return verdict_of(scene.status());
    // Of two fused stages that could run, the wider does; the other one runs in worlds whose tiles have a list for each material,
    // here dense.
    Scene tiled = *scene;
    tiled.settings.active_tiles = 8;
    PassRunner apart(**device, *scene), wide(**device, *scene, {.fused = true}),
        narrow(**device, tiled, {.active_tiles = true, .fused = true});
    const bool is_wide = plans(wide.plan(), compute::find_stage(spec.name));
    PassRunner& together = is_wide ? wide : narrow;
    for (PassRunner* runner : {&apart, &together}) {
        if (auto status = runner->open(); !status) return verdict_of(status);
        if (auto status = run_steps(*runner, *scene); !status) return verdict_of(status);
    }
    if (!plans(together.plan(), compute::find_stage(spec.name))) return failed("the step plan does not run it");
    for (const auto& field : together.plan().fields) {
        if (field.role != FieldRole::state && field.role != FieldRole::ledger) continue;
        auto expected = apart.read(field.name), got = together.read(field.name);
        if (!expected || !got) return verdict_of(expected ? got.status() : expected.status());
        const auto differs = std::mismatch(expected->begin(), expected->end(), got->begin());
        if (differs.first == expected->end()) continue;
        const auto at = static_cast<int>(differs.first - expected->begin()) + GHOST - LEAD;
        const int pitch = apart.layout().pitch();
        return failed(field.name + " differs, first at (" + std::to_string(at % pitch - GHOST) + ", " +
                      std::to_string(at / pitch - GHOST) + ")");
    }
    return passed();
}

} // namespace

const Suite& fused_suite() {
    static const Suite suite = {"fused", "each fused stage against its stages one by one, in bits", list, run};
    return suite;
}

} // namespace wadi::conformance
