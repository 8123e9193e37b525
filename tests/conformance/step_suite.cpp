// Suite 3: whole steps of a World, against the reference solver within a computed tolerance, and against the plainest CPU run
// in bits.
#include "engine/world.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/effect_sets.hpp"
#include "tests/conformance/fields.hpp"
#include "tests/conformance/locate.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/stage_reference.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>
#include <cstdlib>

namespace wadi::conformance {

namespace {

struct Row {
    const char* grid;
    std::uint32_t effects;
    const char* scene;
    const char* method;
    int steps;
};

constexpr Row against_reference[] = {
    {"33x17", EFFECT_WATER, "dam_break", "default", 4},
    {"33x17", EFFECT_WATER, "islands", "plain", 4},
    {"65x3", EFFECT_WATER | EFFECT_BED_FRICTION, "slope", "default", 4},
    {"63x5", EFFECT_WATER | EFFECT_RAIN | EFFECT_SOURCES, "slope", "default", 6},
    {"33x17", EFFECT_WATER | EFFECT_OPEN_SIDES, "flat", "default", 4},
    {"1x9", EFFECT_WATER | EFFECT_OPEN_SIDES | EFFECT_SOURCES, "flat", "default", 4},
    {"257x130", EFFECT_WATER, "cliff", "default", 2},
    {"33x17", EFFECT_WATER, "deep", "default", 3},
    {"33x17", EFFECT_SAND, "slope", "default", 4},
    {"64x4", EFFECT_SAND | ELASTIC, "cliff", "default", 3},
    {"33x17", EFFECT_SAND | ELASTIC | EFFECT_OPEN_SIDES, "flat", "default", 3},
    {"33x17", EFFECT_SAND | ELASTIC | EFFECT_SOURCES, "slope", "unsmoothed", 3},
    {"9x1", EFFECT_SAND | ELASTIC, "one_wet_cell", "default", 4},
    {"33x17", EFFECT_WATER | EFFECT_SAND, "cliff", "default", 3},
    {"33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG, "slope", "default", 3},
    {"33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE, "slope", "default", 3},
    {"33x17", WET, "slope", "default", 3},
    {"65x3", WET, "dam_break", "coarse", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION, "slope", "default", 2},
    {"33x17", WET | EFFECT_BED_SHEAR, "dam_break", "default", 2},
    {"33x17", EFFECT_SAND | SLOPES, "slope", "default", 3},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION, "cliff", "default", 2},
    {"33x17", WET | SLOPES | EFFECT_RETENTION, "dam_break", "default", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION, "slope", "default", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION, "flat", "plain", 2},
    {"257x130", WET | ELASTIC | EFFECT_COHESION, "dam_break", "default", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION, "deep", "default", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | EFFECT_RAIN | EFFECT_SOURCES, "slope", "default", 2},
    {"33x17", EFFECT_WATER | PUBLISHED, "dam_break", "default", 4},
    {"33x17", EFFECT_WATER | EFFECT_OPEN_SIDES | PUBLISHED, "flat", "default", 4},
    {"33x17", EFFECT_SAND | PUBLISHED, "slope", "default", 3},
    {"33x17", EFFECT_SAND | ELASTIC | PUBLISHED, "slope", "default", 3},
    {"33x17", EFFECT_SAND | ELASTIC | PUBLISHED, "cliff", "default", 2},
    {"33x17", EFFECT_SAND | ELASTIC | DIRECT, "slope", "default", 3},
    {"33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG | PUBLISHED, "slope", "default", 3},
    {"33x17", WATER_IN_SAND | PUBLISHED, "slope", "default", 3},
    {"33x17", WATER_IN_SAND | EFFECT_OPEN_SIDES | PUBLISHED, "flat", "default", 3},
    {"33x17", WATER_IN_SAND | ELASTIC | EFFECT_COHESION | PUBLISHED, "slope", "default", 2},
    {"33x17", WATER_IN_SAND | ELASTIC | EFFECT_COHESION | PUBLISHED, "flat", "plain", 2},
    {"33x17", WATER_IN_SAND | ELASTIC | EFFECT_COHESION | PUBLISHED | EFFECT_OPEN_SIDES, "flat", "default", 2},
    {"33x17", WATER_IN_SAND | ELASTIC | EFFECT_COHESION | DIRECT, "slope", "default", 2},
    {"33x17", EFFECT_WATER | SECOND, "dam_break", "default", 5},
    {"33x17", EFFECT_WATER | SECOND, "islands", "plain", 4},
    {"33x17", EFFECT_WATER | EFFECT_OPEN_SIDES | SECOND, "flat", "default", 4},
    {"33x17", EFFECT_WATER | SECOND | PUBLISHED, "dam_break", "default", 4},
    {"33x17", WET | SECOND, "slope", "default", 3},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SECOND, "slope", "default", 2},
    {"33x17", EFFECT_SAND | SAND_SECOND, "slope", "default", 4},
    {"64x4", EFFECT_SAND | ELASTIC | SLOPES | SAND_SECOND, "cliff", "default", 3},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION | SECOND | SAND_SECOND, "slope", "default", 2},
    {"33x17", WET | EFFECT_BED_SHEAR | SAND_SECOND, "dam_break", "default", 2},
    {"33x17", EFFECT_SAND | SLOPES | FLOWING, "slope", "default", 3},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION | FLOWING, "slope", "default", 2},
    {"33x17", WET | SLOPES | EFFECT_RETENTION, "dam_break", "porous", 2},
    {"33x17", WET | SLOPES | EFFECT_RETENTION | SOAKING, "dam_break", "porous", 2},
    {"33x17", WET | SLOPES | EFFECT_RETENTION | SOAKING, "slope", "default", 2},
    {"33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION, "slope", "porous", 2},
    {"33x17", WET | SECOND, "slope", "porous", 3},
    {"33x17", EFFECT_WATER | SEEN, "dam_break", "default", 6},
    {"33x17", WET | only_seen, "slope", "default", 3},
    {"33x17", EFFECT_WATER | SEEN | PUBLISHED, "dam_break", "default", 4},
    {"33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_SILT | PUBLISHED, "dam_break", "default", 4},
    {"33x17", ALL, "flat", "default", 2},
    {"1x1", ALL, "flat", "default", 2},
};

constexpr Row in_bits[] = {
    {"33x17", EFFECT_WATER, "dam_break", "default", 40},
    {"65x3", EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG | EFFECT_BED_FRICTION, "islands", "plain", 30},
    {"33x17", EFFECT_SAND | ELASTIC, "cliff", "default", 40},
    {"64x4", WET, "slope", "coarse", 30},
    {"63x5", ALL & ~EFFECT_COHESION, "random", "bare", 10},
    {"257x130", ALL, "random", "default", 20},
    {"33x17", ALL, "thin_film", "unsmoothed", 40},
    {"33x17", ALL, "deep", "default", 40},
    {"33x17", ALL_PUBLISHED, "random", "default", 20},
    {"33x17", ALL_PUBLISHED, "random", "bare", 20},
    {"33x17", ALL_PUBLISHED | DIRECT, "random", "default", 20},
    {"1x1", ALL_PUBLISHED, "random", "default", 20},
    {"64x4", WATER_IN_SAND | PUBLISHED, "slope", "coarse", 30},
    {"33x17", WET | SLOPES | EFFECT_RETENTION, "dam_break", "default", 40},
    {"33x17", EFFECT_WATER | SECOND, "dam_break", "default", 40},
    {"64x4", WET | SECOND, "slope", "coarse", 30},
    {"33x17", ALL | FLOWING, "random", "default", 20},
    {"33x17", ALL, "random", "porous", 20},
    {"33x17", ALL | SECOND, "random", "porous", 20},
    {"33x17", ALL | SECOND, "random", "default", 20},
    {"33x17", ALL | SECOND, "random", "bare", 20},
    {"1x1", ALL | SECOND, "random", "default", 20},
    {"33x17", EFFECT_SAND | ELASTIC | SLOPES | SAND_SECOND, "cliff", "default", 40},
    {"33x17", ALL | SECOND | SAND_SECOND, "random", "default", 20},
    {"1x1", ALL, "random", "default", 40},
    {"9x1", ALL, "dam_break", "default", 40},
};

std::vector<CaseSpec> list() {
    std::vector<CaseSpec> cases;
    const auto add = [&](const char* name, const Row& row) {
        cases.push_back({name,
                         {{"grid", row.grid},
                          {"effects", effects_text(row.effects)},
                          {"scene", row.scene},
                          {"method", row.method},
                          {"steps", std::to_string(row.steps)}}});
    };
    for (const Row& row : against_reference) add("world_against_reference", row);
    for (const Row& row : in_bits) add("world_against_cpu", row);
    return cases;
}

Verdict against_reference_run(const Scene& scene, int steps, Session& session) {
    auto world = open_world(session, scene);
    if (!world) return verdict_of(world.status());
    if (auto status = (*world)->step(static_cast<std::uint32_t>(steps)); !status) return verdict_of(status);
    References references(scene);
    for (int n = 0; n < steps; ++n) references.step();
    const FieldLayout layout{scene.settings.grid.nx, scene.settings.grid.ny};
    WorldParams range{};
    range.nx = layout.nx;
    range.ny = layout.ny;
    Verdict verdict;
    for (const auto& field : (*world)->plan().fields) {
        if (field.role != FieldRole::state) continue;
        auto got = (*world)->reader().read_raw(field.name);
        if (!got) return verdict_of(got.status());
        const auto low = reference_field(references.narrow, "", {field.name, false}, true);
        const auto high = reference_field(references.wide, "", {field.name, false}, true);
        const auto plain = reference_field(references.unrounded, "", {field.name, false}, true);
        const FieldCheck check{field.name, values_of(field.name, range), *got, low, high, plain};
        verdict = worse(verdict, compare_fields({check}, layout, height_quantum(scene.settings.method)));
    }
    if (verdict.outcome != Outcome::fail) return verdict;
    auto device = session.device();
    if (device) verdict.detail += "; " + locate_against_reference(**device, scene, steps);
    return verdict;
}

Verdict against_cpu_run(const Scene& scene, int steps, Session& session) {
    auto world = open_world(session, scene);
    if (!world) return verdict_of(world.status());
    if (!(*world)->device().capabilities().exact_float)
        return {Outcome::not_supported, "the device's arithmetic is not exact (capabilities().exact_float)"};
    auto cpu = open_plain_cpu();
    if (!cpu) return verdict_of(cpu.status());
    auto plain = World::create(scene.settings, scene.fields, std::move(*cpu));
    if (!plain) return verdict_of(plain.status());
    for (World* w : {world->get(), plain->get()})
        if (auto status = w->step(static_cast<std::uint32_t>(steps)); !status) return verdict_of(status);
    Verdict verdict = same_state(**world, **plain);
    if (verdict.outcome != Outcome::fail) return verdict;
    auto device = session.device();
    auto other = open_plain_cpu();
    if (device && other) verdict.detail += "; " + locate_against_device(**device, **other, scene, steps);
    return verdict;
}

Verdict run(const CaseSpec& spec, Session& session) {
    auto mask = parse_effects(spec.get("effects", "water"));
    if (!mask) return verdict_of(mask.status());
    auto scene = make_scene(spec.get("grid", "33x17"), spec.get("scene", "random"), spec.get("method", "default"), *mask);
    if (!scene) return verdict_of(scene.status());
    const int steps = std::clamp(std::atoi(spec.get("steps", "1").c_str()), 1, 100000);
    return spec.name == "world_against_cpu" ? against_cpu_run(*scene, steps, session)
                                            : against_reference_run(*scene, steps, session);
}

} // namespace

const Suite& step_suite() {
    static const Suite suite = {"step", "whole steps against the reference solver, and against the CPU in bits", list, run};
    return suite;
}

} // namespace wadi::conformance
