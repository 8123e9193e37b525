// Both methods run shipped levels, with the same bits on every backend.
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

Scene level_with(const std::string& name, int nx, int ny, const char* method) {
    LevelOverrides overrides;
    overrides.size = {nx, ny};
    overrides.method = method;
    auto level = load_level(WADI_SOURCE_DIR "/samples/levels/" + name + "/level.json", overrides);
    REQUIRE_MESSAGE(level, level.status().message);
    return {level->settings, level->fields};
}

// Relative change of the water's mass in a dam break of published on dry ground after 100 steps.
double drift_of_dam_break(bool limiter, double clamp) {
    auto scene = level_with("dam_break", 96, 96, "published");
    scene.settings.method.outflow_limiter = limiter;
    scene.settings.method.velocity_clamp = clamp;
    auto world = make_world(scene);
    step(*world, 100);
    const auto stats = world->reader().stats();
    REQUIRE(stats);
    return static_cast<double>(stats->water_quanta - stats->water_initial) / static_cast<double>(stats->water_initial);
}

} // namespace

TEST_CASE("published keeps its mass to rounding by its clamp alone, or by the outflow limiter; without either it is lost") {
    const double limited = drift_of_dam_break(true, 0.35), clamped = drift_of_dam_break(false, 0.25),
                 free = drift_of_dam_break(false, 0.35);
    MESSAGE("water gained in 100 steps: " << limited << " with the limiter, " << clamped << " with a clamp of a quarter, " << free
                                          << " with neither");
    CHECK(std::abs(limited) < 1e-5);
    CHECK(std::abs(clamped) < 1e-5);
    CHECK(std::abs(free) > 1e-3);
}

TEST_CASE("robust and published run dam_break, piles and canyon, each with the same bits on every backend") {
    struct Row {
        const char* name;
        int nx, ny, steps;
    };
    for (const Row& row : {Row{"dam_break", 64, 64, 20}, {"piles", 72, 48, 20}, {"canyon", 60, 77, 15}}) {
        std::uint64_t robust = 0;
        for (const char* method : {"robust", "published"}) {
            const std::string label = std::string(row.name) + " " + method;
            CAPTURE(label);
            std::uint64_t hash = 0;
            for (const auto& backend : available_backends()) {
                CAPTURE(backend);
                auto world =
                    make_world(level_with(row.name, row.nx, row.ny, method), {.backend = backend, .shared_device = true});
                CHECK(((world->plan().effects & EFFECT_PUBLISHED) != 0) == (std::string(method) != "robust"));
                step(*world, row.steps);
                const auto stats = world->reader().stats();
                REQUIRE(stats);
                CHECK(stats->not_finite == 0);
                CHECK(stats->smallest_height >= 0);
                const auto& s = world->settings();
                CHECK(stats->largest_water_speed > 0.01);
                CHECK(stats->largest_water_speed <= s.method.velocity_clamp * s.grid.dx / s.water_dt() * (1 + 1e-6));
                if (hash == 0) {
                    hash = hash_of(*world);
                    MESSAGE(label << ": fastest water " << stats->largest_water_speed << " m/s, sand "
                                  << stats->largest_sand_speed << " m/s");
                }
                CHECK(hash == hash_of(*world));
            }
            if (robust == 0) robust = hash;
            CHECK((hash == robust) == (std::string(method) == "robust"));
        }
    }
}
