// Suite 4: what must hold in any scene after many steps.
#include "engine/step/plan/world_params.hpp"
#include "tests/conformance/compare.hpp"
#include "tests/conformance/effect_sets.hpp"
#include "tests/conformance/half_turn.hpp"
#include "tests/conformance/masks.hpp"
#include "tests/conformance/symmetry.hpp"
#include "tests/conformance/worlds.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace wadi::conformance {

namespace {

CaseSpec spec_of(const char* name, const char* grid, std::uint32_t effects, const std::string& scene, const std::string& method,
                 int steps) {
    return {name,
            {{"grid", grid},
             {"effects", effects_text(effects)},
             {"scene", scene},
             {"method", method},
             {"steps", std::to_string(steps)}}};
}

std::vector<CaseSpec> list() {
    std::vector<CaseSpec> cases;
    const auto add = [&](const char* name, const char* grid, std::uint32_t effects, const std::string& scene, const char* method,
                         int steps) { cases.push_back(spec_of(name, grid, effects, scene, method, steps)); };
    add("bounds", "65x33", EFFECT_WATER, "dam_break", "default", 300);
    add("bounds", "33x17", EFFECT_WATER | EFFECT_RAIN | EFFECT_SOURCES | EFFECT_OPEN_SIDES | EFFECT_BED_FRICTION, "islands",
        "default", 300);
    add("bounds", "33x17", EFFECT_SAND | ELASTIC, "cliff", "default", 300);
    add("bounds", "33x17", EFFECT_SAND | EFFECT_SOURCES | EFFECT_OPEN_SIDES, "random", "coarse", 300);
    add("bounds", "33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_MIXTURE, "random", "default", 300);
    add("bounds", "33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG, "dam_break", "default", 300);
    add("bounds", "33x17", WET, "deep", "default", 300);
    add("bounds", "64x48", ALL, "random", "default", 300);
    add("bounds", "64x48", ALL, "dam_break", "unsmoothed", 300);
    add("bounds", "33x17", ALL, "thin_film", "default", 300);
    add("bounds", "33x17", WET | ELASTIC | EFFECT_COHESION, "cliff", "plain",
        300); // closed: its ledger would count rounded quanta
    add("bounds", "33x17", ALL | SECOND, "random", "default", 300);
    add("bounds", "33x17", ALL | SECOND, "thin_film", "default", 300);
    add("bounds", "33x17", ALL | SAND_SECOND, "random", "default", 300);
    add("bounds", "33x17", ALL, "random", "porous", 300);
    add("bounds", "33x17", ALL | SOAKING, "random", "porous", 300);
    add("bounds", "33x17", EFFECT_SAND | ELASTIC | SLOPES | SAND_SECOND, "cliff", "default", 300);
    add("bounds", "33x17", WET | ELASTIC | EFFECT_COHESION | SECOND, "cliff", "plain", 300);
    add("bounds", "33x17", ALL_PUBLISHED, "random", "default", 300);
    add("bounds", "33x17", ALL_PUBLISHED | DIRECT, "random", "default", 300);
    for (int seed = 1; seed <= 8; ++seed)
        add("bounds", "24x20", ALL & ~EFFECT_SOURCES, "random", ("fuzz" + std::to_string(seed)).c_str(), 80);
    add("lake_at_rest", "33x17", EFFECT_WATER, "lake_at_rest", "default", 200);
    add("lake_at_rest", "65x33", WET, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | ELASTIC | EFFECT_COHESION, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | EFFECT_BED_SHEAR, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", EFFECT_WATER | EFFECT_SAND | EFFECT_DRAG | EFFECT_BED_FRICTION, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", EFFECT_WATER | PUBLISHED, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | SLOPES | EFFECT_RETENTION, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | SLOPES | EFFECT_RETENTION | SOAKING, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", EFFECT_WATER | SECOND, "lake_at_rest", "default", 200);
    add("lake_at_rest", "33x17", WET | ELASTIC | EFFECT_COHESION | SECOND, "lake_at_rest", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | PUBLISHED, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND, "static_pile", "default", 200);
    add("static_pile", "65x33", EFFECT_SAND | ELASTIC, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | ELASTIC, "static_pile", "bare", 200);
    add("static_pile", "65x33", EFFECT_SAND | SLOPES, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | ELASTIC | SLOPES, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | SAND_SECOND, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | ELASTIC | SLOPES | SAND_SECOND, "static_pile", "default", 200);
    add("static_pile", "33x17", WET | SLOPES | EFFECT_RETENTION, "static_pile", "default", 200);
    add("static_pile", "33x17", EFFECT_SAND | SLOPES | FLOWING, "static_pile", "default", 200);
    for (const char* symmetry : {"mirror_x", "mirror_y", "transpose"}) {
        add(symmetry, "33x17", EFFECT_WATER | EFFECT_OPEN_SIDES | EFFECT_BED_FRICTION, "islands", "default", 40);
        add(symmetry, "33x17", EFFECT_SAND | ELASTIC, "cliff", "default", 40);
        add(symmetry, "33x17", WET | EFFECT_BED_SHEAR, "islands", "default", 40);
        add(symmetry, "33x17", EFFECT_SAND | SLOPES, "cliff", "default", 40);
        add(symmetry, "33x17", WET | ELASTIC | EFFECT_COHESION | SLOPES | EFFECT_RETENTION, "cliff", "default", 40);
        add(symmetry, "33x17", ALL, "random", "default", 40);
        add(symmetry, "33x17", ALL | SECOND, "random", "default", 40);
        add(symmetry, "33x17", ALL | FLOWING, "random", "default", 40);
        add(symmetry, "33x17", ALL | SOAKING, "random", "porous", 40);
        add(symmetry, "33x17", ALL | SECOND | SOAKING, "random", "default", 40);
        add(symmetry, "33x17", ALL, "random", "porous", 40);
        add(symmetry, "33x17", ALL | SECOND, "random", "porous", 40);
        add(symmetry, "33x17", ALL | SAND_SECOND, "random", "default", 40);
        add(symmetry, "33x17", ALL_PUBLISHED | DIRECT, "random", "default", 40);
        add(symmetry, "33x17", ALL_PUBLISHED, "random", "default", 40);
        add(symmetry, "65x3", ALL, "random", "plain", 30);
    }
    for (const char* variant : {"same_again", "same_without_replay", "same_with_full_barriers", "same_interleaved"})
        add(variant, "33x17", ALL, "random", "default", 30);
    for (const char* strain : {"polar", "direct", "left_stretch"}) cases.push_back({"half_turn", {{"strain", strain}}});
    return cases;
}

// The page's fuzz (NUMERICS 5, item 13): anything that settings may say.
void fuzz(Scene& scene, std::uint32_t seed) {
    std::uint32_t state = seed * 747796405u + 2891336453u;
    const auto between = [&](double low, double high) { // evenly on a logarithmic scale
        state = state * 1664525u + 1013904223u;
        return low * std::pow(high / low, static_cast<double>(state >> 8) / static_cast<double>(1u << 24));
    };
    auto& s = scene.settings;
    const double old_dx = s.grid.dx;
    s.grid.dx = between(1e-2, 10);
    for (Side& side : s.sides) {
        side.from *= s.grid.dx / old_dx;
        side.to *= s.grid.dx / old_dx;
    }
    s.dt = between(1e-4, 1);
    s.method.substeps = static_cast<int>(between(1, 6.9));
    s.method.largest_height = 1024;
    s.material.friction = between(1e-2, 5);
    s.material.young_modulus = between(1e2, 1e9);
    s.material.cohesion_wet = s.material.cohesion_capillary = between(1, 1e8);
    s.material.exchange_rate = between(1, 1e12);
    s.material.diffusion_rate = between(1e-3, 1e3);
    const auto tall = static_cast<float>(between(0.1, 100));
    for (float& h : scene.fields.terrain) h *= tall / 4;
    for (float& h : scene.fields.sand) h *= tall;
    for (float& h : scene.fields.water) h *= tall;
    scene.fields.velocity_x.clear();
    scene.fields.velocity_y.clear();
    scene.fields.sand_velocity_x.clear();
    scene.fields.sand_velocity_y.clear();
}

// Two lakes with a wall between them, over a submerged dune, a half-emerged dune, an island and a shore; the sand's slopes stay
// below what its friction holds in water.
void lake_at_rest(Scene& scene) {
    const auto& grid = scene.settings.grid;
    const double quantum = height_quantum(scene.settings.method);
    scene.settings.material.friction = 0.8;
    scene.fields = {};
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const double u = (i + 0.5) / grid.nx, v = (j + 0.5) / grid.ny;
            const bool wall = j == grid.ny / 2, island = u > 0.8 && v > 0.7, shore = u < 0.4;
            const double bed = wall ? 2 : island ? 1.3 : shore ? 0.3 + 2.5 * (0.4 - u) : 0.3;
            const double terrain = quantum * std::nearbyint(bed / quantum);
            const double dune = std::max(0.0, 0.3 - 0.24 * std::abs(u - 0.6) * grid.nx * grid.dx);
            scene.fields.terrain.push_back(static_cast<float>(terrain));
            scene.fields.sand.push_back(wall || island || shore ? 0.0F : static_cast<float>(0.1 + dune));
            scene.fields.water.push_back(wall ? 0.0F : static_cast<float>(std::max(0.0, (v > 0.5 ? 0.875 : 0.5) - terrain)));
        }
    }
}

void static_pile(Scene& scene) {
    const auto& grid = scene.settings.grid;
    scene.settings.material.friction = 0.5;
    scene.settings.material.cohesion_dry = 0;
    scene.fields = {};
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const double r = std::hypot(i - grid.nx / 2.0, j - grid.ny / 2.0) * grid.dx;
            scene.fields.sand.push_back(static_cast<float>(std::max(0.0, 0.45 * 0.3 * grid.ny * grid.dx - 0.45 * r)));
        }
    }
}

Result<Scene> scene_of(const CaseSpec& spec) {
    auto mask = parse_effects(spec.get("effects", "water"));
    if (!mask) return mask.status();
    const std::string name = spec.get("scene", "random"), method = spec.get("method", "default");
    const bool own = name == "lake_at_rest" || name == "static_pile", fuzzed = method.starts_with("fuzz");
    auto scene = make_scene(spec.get("grid", "33x17"), own ? "flat" : name, fuzzed ? "default" : method, *mask);
    if (!scene) return scene;
    // A World keeps initial velocities as they are; here they start within the clamp, which must then hold for ever.
    const WorldParams params = derive_params(scene->settings, scene->effects);
    const auto clamp = [](std::vector<float>& field, float most) {
        for (float& u : field) u = std::clamp(u, -most, most);
    };
    auto& fields = scene->fields;
    for (auto* field : {&fields.velocity_x, &fields.velocity_y}) clamp(*field, params.water_velocity_clamp);
    for (auto* field : {&fields.sand_velocity_x, &fields.sand_velocity_y}) clamp(*field, params.sand_velocity_clamp);
    if (name == "lake_at_rest") lake_at_rest(*scene);
    if (name == "static_pile") static_pile(*scene);
    if (fuzzed) fuzz(*scene, static_cast<std::uint32_t>(std::atoi(method.c_str() + 4)));
    return scene;
}

// Depths, speeds, finiteness and mass.
Verdict check_bounds(World& world) {
    auto stats = world.reader().stats();
    if (!stats) return verdict_of(stats.status());
    const WorldParams params = derive_params(world.settings(), world.plan().effects);
    const WorldStats& s = *stats;
    if (s.not_finite > 0) return failed(std::to_string(s.not_finite) + " values are not finite");
    if (s.smallest_height < 0) return failed("a height is " + std::to_string(s.smallest_height) + " m");
    // A mean of two velocities at the clamp may round above it.
    const auto clamped = [](double speed, float clamp) { return speed <= static_cast<double>(clamp) * (1 + 5e-7); };
    if (!clamped(s.largest_water_speed, params.water_velocity_clamp))
        return failed("water at " + std::to_string(s.largest_water_speed) + " m/s, the clamp is " +
                      std::to_string(params.water_velocity_clamp));
    if (!clamped(s.largest_sand_speed, params.sand_velocity_clamp))
        return failed("sand at " + std::to_string(s.largest_sand_speed) + " m/s, the clamp is " +
                      std::to_string(params.sand_velocity_clamp));
    const std::int64_t water = s.water_quanta - s.water_initial - (s.ledger.water_in - s.ledger.water_out);
    const std::int64_t sand = s.sand_quanta - s.sand_initial - (s.ledger.sand_in - s.ledger.sand_out);
    const bool exact = height_quantum(world.settings().method) > 0;
    const auto most = [&](std::int64_t initial, std::int64_t in) {
        return exact ? 0.0 : 5e-6 * static_cast<double>(initial + in);
    };
    if (std::abs(static_cast<double>(water)) > most(s.water_initial, s.ledger.water_in))
        return failed("water drifts by " + std::to_string(water) + " quanta of " + std::to_string(s.water_initial));
    if (std::abs(static_cast<double>(sand)) > most(s.sand_initial, s.ledger.sand_in))
        return failed("sand drifts by " + std::to_string(sand) + " quanta of " + std::to_string(s.sand_initial));
    return {};
}

Verdict run_bounds(World& world, int steps) {
    for (int done = 0; done < steps;) {
        const int now = std::min(done < 3 ? 1 : 100, steps - done);
        if (auto status = world.step(static_cast<std::uint32_t>(now)); !status) return verdict_of(status);
        done += now;
        Verdict verdict = check_bounds(world);
        if (verdict.outcome == Outcome::ok) continue;
        verdict.detail += ", after " + std::to_string(done) + " steps";
        return verdict;
    }
    return {};
}

// A fixed point of both parities, and still one after many steps.
Verdict run_rest(World& world, World& start, int steps) {
    for (const int count : {1, 1, steps}) {
        if (auto status = world.step(static_cast<std::uint32_t>(count)); !status) return verdict_of(status);
        Verdict verdict = same_state(world, start);
        if (verdict.outcome == Outcome::ok) continue;
        verdict.detail += ", after " + std::to_string(world.steps()) + " steps";
        return verdict;
    }
    return {};
}

Verdict run_symmetry(const Scene& scene, World& world, Session& session, const std::string& name, int steps) {
    const Symmetry symmetry = name == "mirror_x"   ? Symmetry::mirror_x
                              : name == "mirror_y" ? Symmetry::mirror_y
                                                   : Symmetry::transpose;
    auto image = open_world(session, image_of(scene, symmetry));
    if (!image) return verdict_of(image.status());
    for (World* w : {&world, image->get()})
        if (auto status = w->step(static_cast<std::uint32_t>(steps)); !status) return verdict_of(status);
    return compare_images(world, **image, symmetry);
}

// The same scene once more, differently run, must give the same bits.
Verdict run_same(const Scene& scene, World& world, Session& session, const std::string& name, int steps) {
    auto options = session.options();
    if (name == "same_without_replay") options.no_replay = !options.no_replay;
    if (name == "same_with_full_barriers") options.full_barriers = !options.full_barriers;
    const bool own = name == "same_without_replay" || name == "same_with_full_barriers";
    auto other = own ? open_world(session, scene, options) : open_world(session, scene);
    if (!other) return verdict_of(other.status());
    if (auto status = world.step(static_cast<std::uint32_t>(steps)); !status) return verdict_of(status);
    // Interleaved: step by step in turn with a third world, where the first ran alone.
    auto third = open_world(session, scene);
    if (!third) return verdict_of(third.status());
    for (int done = 0; done < steps; ++done) {
        if (auto status = (*other)->step(1); !status) return verdict_of(status);
        if (name != "same_interleaved") continue;
        if (auto status = (*third)->step(1); !status) return verdict_of(status);
    }
    return same_state(**other, world);
}

Verdict run(const CaseSpec& spec, Session& session) {
    if (spec.name == "half_turn") return run_half_turn(spec, session);
    auto scene = scene_of(spec);
    if (!scene) return verdict_of(scene.status());
    auto world = open_world(session, *scene);
    if (!world) return verdict_of(world.status());
    const int steps = std::clamp(std::atoi(spec.get("steps", "10").c_str()), 1, 100000);
    if (spec.name == "bounds") return run_bounds(**world, steps);
    if (spec.name.starts_with("same_")) return run_same(*scene, **world, session, spec.name, steps);
    if (spec.name == "lake_at_rest" || spec.name == "static_pile") {
        auto start = open_world(session, *scene);
        return start ? run_rest(**world, **start, steps) : verdict_of(start.status());
    }
    return run_symmetry(*scene, **world, session, spec.name, steps);
}

} // namespace

const Suite& invariant_suite() {
    static const Suite suite = {"invariant", "mass, bounds, rest, symmetry and repeatability after many steps", list, run};
    return suite;
}

} // namespace wadi::conformance
