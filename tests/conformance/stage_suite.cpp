#include "tests/conformance/stage_suite.hpp"
#include "engine/step/plan/world_params.hpp"
#include "shaders/effect_rows.hpp"
#include "tests/conformance/active_tiles_check.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/edits_check.hpp"
#include "tests/conformance/fields.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/stage_checks.hpp"
#include "tests/conformance/stage_inputs.hpp"
#include "tests/conformance/values_check.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace wadi::conformance {

namespace {

using compute::Access;

// "stretch_xx" -> "stretch": the components of one field share a scale.
std::string vector_of(const std::string& base) {
    for (const char* suffix : {"_x", "_y", "_xx", "_xy", "_yy"})
        if (base.ends_with(suffix)) return base.substr(0, base.size() - std::string(suffix).size());
    return base;
}

// What one bit more or less of a cut to whole quanta makes.
double cut_to(const std::string& stage, const WorldParams& params) {
    if (stage == "carry_foam" || stage == "wet_ground" || stage == "carry_silt") return 0x1p-20; // quanta of their own
    const bool truncates = stage == "compute_water_flux" || stage == "compute_sand_flux" || stage == "diffuse_mixed_height";
    return truncates ? static_cast<double>(params.quantum) : 0.0;
}

// Runs the stage in both precisions and compares every output the reference has.
Verdict compare_with_reference(const StageRun& run) {
    const std::string stage(run.stage.name);
    const FieldLayout layout{run.params.nx, run.params.ny};
    auto& narrow = *run.pilot.narrow;
    auto& wide = *run.pilot.wide;
    run_reference_stage(narrow, stage);
    run_reference_stage(wide, stage);
    struct Output {
        FieldName name;
        std::vector<float> narrow;
        std::vector<double> wide;
        std::size_t binding;
    };
    std::map<std::string, std::vector<Output>> vectors;
    for (std::size_t b = 0; b < run.buffers.size(); ++b) {
        const auto& binding = run.stage.bindings[b];
        if (!run.buffers[b].exists || binding.access == Access::in || binding.type != compute::Scalar::f32) continue;
        Output out{field_of(stage, std::string(binding.name), run.scene.effects), {}, {}, b};
        out.narrow = reference_field(narrow, stage, out.name, true);
        out.wide = reference_field(wide, stage, out.name, true);
        if (stage == "open_sides") {
            fill_ghosts(out.narrow, out.name.base, narrow);
            fill_ghosts(out.wide, out.name.base, wide);
        }
        vectors[vector_of(out.name.base)].push_back(std::move(out));
    }
    Verdict verdict;
    for (const auto& [name, outputs] : vectors) {
        std::vector<FieldCheck> components;
        for (const Output& out : outputs)
            components.push_back({std::string(run.stage.bindings[out.binding].name),
                                  written_range(stage, out.name.base, run.params),
                                  run.buffers[out.binding].floats(),
                                  out.narrow,
                                  out.wide,
                                  {}});
        verdict = worse(verdict, compare_fields(components, layout, cut_to(stage, run.params)));
    }
    return verdict;
}

// Where a stage begins with grids and methods: by its name, so that a new stage leaves the others' cases as they are.
std::size_t first_turn(std::string_view stage) {
    return std::accumulate(stage.begin(), stage.end(), std::size_t{0},
                           [](std::size_t sum, char letter) { return 31 * sum + static_cast<unsigned char>(letter); });
}

std::vector<CaseSpec> list() {
    std::vector<CaseSpec> cases;
    const auto grids = grid_names(), scenes = scene_names(), methods = method_names_of_cases();
    const auto stages = compute::stage_table();
    for (std::size_t stage = 0; stage < stages.size(); ++stage) {
        if (stages[stage].fused()) continue; // fused_suite
        auto masks = stage_masks(static_cast<int>(stage));
        if (stages[stage].tested_effects == 0 && masks.front() == 0)
            masks.front() = EFFECT_WATER; // a stage that publishes any layer
        // Every stage meets every grid and method, its masks every scene or, where there are many, one half or the other; not the
        // full product.
        const std::size_t rounds = masks.size() < 3 ? 2 * scenes.size() : masks.size() < 7 ? scenes.size() : scenes.size() / 2;
        const std::size_t first = first_turn(stages[stage].name);
        std::size_t turn = 0;
        for (const std::uint32_t mask : masks) {
            // What stands on slow sand is little beside what is in it: without a quantum that difference is rounding.
            const bool little = stages[stage].name == "integrate_water_velocity" && (mask & EFFECT_INFILTRATION) != 0;
            const auto add = [&](const char* grid, const std::string& scene, const std::string& method, std::uint32_t more = 0) {
                cases.push_back({std::string(stages[stage].name),
                                 {{"grid", grid}, {"effects", effects_text(mask | more)}, {"scene", scene}, {"method", method}}});
            };
            add("33x17", "random", "default");
            // Open sides put velocities and water on the rim of every other stage as well.
            if ((mask & EFFECT_OPEN_SIDES) == 0) {
                add("33x17", "random", "default", EFFECT_OPEN_SIDES);
                add("5x7", "slope", little ? "unsmoothed" : "plain", EFFECT_OPEN_SIDES);
            }
            for (std::size_t n = 0; n < rounds; ++n, ++turn) {
                const std::string scene = scenes[(turn + 1) % scenes.size()], method = methods[(turn + first) % methods.size()];
                // A lake without a quantum is nothing but rounding: no reference says what it should be.
                const bool rounding_only = scene == "lake" && (method == "plain" || method == "bare");
                // In a film of many cells some stress is smaller than what one bit of the stretch makes.
                const char* const grid = grids[(turn + first) % grids.size()];
                const bool unresolved =
                    scene == "thin_film" && grid == std::string("70x50") && (mask & EFFECT_ELASTOPLASTIC) != 0;
                // Among many random cells without a quantum one holds so little mixed water that its height is rounding.
                const bool film = scene == "random" && grid == std::string("70x50") && (mask & EFFECT_MIXTURE) != 0 &&
                                  (method == "plain" || method == "bare");
                // One cell on a brush's soft rim: without a quantum nothing but that cell gives its strain a scale.
                const bool one_value = scene == "one_wet_cell" && stages[stage].name == "apply_edits" &&
                                       (mask & EFFECT_ELASTOPLASTIC) != 0 && (method == "plain" || method == "bare");
                // On level ground nothing bends but what coarse quanta make of it.
                const bool straight = scene == "dam_break" && stages[stage].name == "bend_sand_velocity";
                // A film is so level that what its slopes withhold of the push, 1 - C r, is rounding, unless quanta are coarse;
                // of second order so much less is left that coarse quanta are of no help.
                const bool level_film =
                    scene == "thin_film" && stages[stage].name == "integrate_sand_velocity" && (mask & EFFECT_SLOPE_NORMAL) != 0;
                // One deep cell that has yielded: kept as it is, its F holds less strain than a float beside 1 resolves.
                const bool lone = grid == std::string("1x1") && (mask & EFFECT_DIRECT_STRAIN) != 0;
                add(lone ? "9x1" : grid, scene,
                    level_film && (mask & EFFECT_SECOND_ORDER_SAND) == 0           ? "coarse"
                    : level_film                                                   ? "default"
                    : rounding_only || unresolved || film || one_value || straight ? "unsmoothed"
                                                                                   : method);
            }
        }
        if (stages[stage].name == "integrate_water_velocity") {
            // NUMERICS 2.4f hangs on parameters that two effects set, of which the stage tests no bit.
            for (const std::uint32_t mask : masks) {
                const std::uint32_t whole = with_needs(mask | EFFECT_SLOPE_NORMAL | EFFECT_DRAG);
                if ((mask & EFFECT_MIXTURE) == 0 || !is_legal(whole)) continue;
                for (const char* const scene : {"random", "dam_break", "cliff"})
                    cases.push_back(
                        {"integrate_water_velocity",
                         {{"grid", "33x17"}, {"effects", effects_text(whole)}, {"scene", scene}, {"method", "default"}}});
            }
        }
        if (stages[stage].name == "apply_sources") {
            cases.push_back({"apply_sources",
                             {{"grid", "33x17"}, {"effects", "water+sources"}, {"scene", "point_jet"}, {"method", "default"}}});
        }
    }
    return cases;
}

/// Between the lowest and the highest column: some stand above it, which no world's first state may.
float middle_column(const StageRun& run) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (int j = 0; j < run.params.ny; ++j) {
        for (int i = 0; i < run.params.nx; ++i) {
            const float column = run.before("terrain", i, j) + run.before("sand_height", i, j) + run.before("water_height", i, j);
            low = std::min(low, column);
            high = std::max(high, column);
        }
    }
    return 0.5F * (low + high);
}

Verdict run(const CaseSpec& spec, Session& session) {
    auto device = session.device();
    return device ? run_stage_case(spec, **device, {}) : verdict_of(device.status());
}

} // namespace

Verdict run_stage_case(const CaseSpec& spec, compute::Device& device, const Tamper& tamper) {
    const int stage = compute::find_stage(spec.name);
    auto mask = parse_effects(spec.get("effects", "none"));
    if (!mask) return verdict_of(mask.status());
    auto scene = make_scene(spec.get("grid", "33x17"), spec.get("scene", "random"), spec.get("method", "default"), *mask);
    if (!scene) return verdict_of(scene.status());
    const auto& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    Pilot pilot = make_pilot(*scene, spec.name);
    if (lists_active_tiles(spec.name)) add_active_tiles(*scene, pilot.input);
    WorldParams params = derive_params(scene->settings, scene->effects);
    if (spec.name == "apply_edits") add_edits(*scene, pilot.input);
    if (spec.name == "write_values") add_values(*scene, pilot.input);
    auto buffers = stage_buffers(info, *scene, pilot, params);
    if (spec.name == "mark_limits") params.largest_height = middle_column({info, *scene, pilot, params, buffers});
    if (auto status = run_bench(device, stage, *mask, params, pilot.input, {}, buffers); !status) return verdict_of(status);
    if (tamper) tamper(info, buffers);
    Verdict guards = check_guards(info, buffers, {params.nx, params.ny});
    if (guards.outcome != Outcome::ok) return guards;
    const StageRun run{info, *scene, pilot, params, buffers};
    const Verdict definition = check_definition(run);
    return has_counterpart(spec.name) ? worse(definition, compare_with_reference(run)) : definition;
}

const Suite& stage_suite() {
    static const Suite suite = {"stage", "each stage under each mask it can tell apart, against the reference solver", list, run};
    return suite;
}

} // namespace wadi::conformance
