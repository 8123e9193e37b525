// Lakes and piles with quantum and rest rule off: rounding stays rounding, for thousands of steps.
#include "engine/settings/data/method_presets.hpp"
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

Scene lake() {
    auto scene = flat_scene(24, 20, 0.25, 0.02);
    auto& method = scene.settings.method;
    method.quantum = 0;
    method.rest_rule = false;
    scene.settings.material.friction = 0.9;
    const auto bed = [](double x, double y) { return 0.1 * std::sin(1.3 * x) * std::cos(0.9 * y) + 0.2; };
    const auto dune = [](double x, double y) { return 0.3 * std::exp(-((x - 3) * (x - 3) + (y - 2.5) * (y - 2.5))); };
    scene.fill(scene.fields.terrain, bed);
    scene.fill(scene.fields.sand, dune);
    scene.fill(scene.fields.water, [&](double x, double y) { return 1 - bed(x, y); });
    return scene;
}

} // namespace

TEST_CASE("10 000 steps without quantum and rest rule: a lake over a dune keeps velocities of rounding, without growth" *
          doctest::test_suite("long")) {
    auto world = make_world(lake());
    step(*world, 2000);
    const double early = stats_of(*world).largest_water_speed;
    step(*world, 8000);
    CHECK(early < 5e-6);
    CHECK(stats_of(*world).largest_water_speed < 5e-6);
    CHECK(sand_speed(*world) == 0);
    on_every_backend(lake(), [](World& w) { step(w, long_runs(100)); });
    // Negative control: the paper's method, whose diffusion and drag stir such a lake.
    auto stirred = lake();
    choose_method(stirred.settings, "published");
    auto other = make_world(stirred);
    step(*other, 500);
    CHECK(stats_of(*other).largest_water_speed > 1e-3);
}

TEST_CASE("10 000 steps without quantum and rest rule: a pile within its slope keeps every height, above it moves" *
          doctest::test_suite("long")) {
    const auto displaced = [](double slope, int steps) {
        auto scene = flat_scene(24, 24, 0.1, 0.009);
        auto& method = scene.settings.method;
        method.quantum = 0;
        method.rest_rule = false;
        scene.fill(scene.fields.sand,
                   [&](double x, double y) { return std::max(0.0, 0.5 - slope * std::hypot(x - 1.2, y - 1.2)); });
        auto world = make_world(scene);
        const auto before = cells_of(*world, "sand_height");
        step(*world, steps);
        return moved(before, cells_of(*world, "sand_height"), 0.1);
    };
    CHECK(displaced(0.49, 10000) == 0);
    CHECK(displaced(0.55, 100) > 0);
}
