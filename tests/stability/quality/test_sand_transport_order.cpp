// Second order transport of sand (NUMERICS 2.16): exact mass, no negative height, rest, the same bits on every backend. What it
// does for the errors is measured in tests/lab/sand.
#include "tests/stability/quality.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

Scene sand_and_water(int order) {
    auto scene = mixed_scene(48, 40);
    scene.settings.method.water_transport_order = 2;
    scene.settings.method.sand_transport_order = order;
    return scene;
}

} // namespace

TEST_CASE("second order of sand: exact mass, no negative height, the same bits on every backend, other bits than first order") {
    const auto run = [](World& world) { step(world, 60); };
    on_every_backend(sand_and_water(2), run);
    auto first = make_world(sand_and_water(1)), second = make_world(sand_and_water(2));
    run(*first);
    run(*second);
    CHECK(hash_of(*first) != hash_of(*second));
}

TEST_CASE("second order of sand: no negative height and exact mass at Courant numbers far above 1") {
    for (const double dt : {0.02, 0.2, 2.0}) {
        CAPTURE(dt);
        auto scene = flat_scene(40, 30, 0.5, dt);
        scene.fill(scene.fields.sand, [](double x, double y) {
            return std::max(0.0, 2 * std::sin(1.7 * x + 0.4 * y) * std::cos(2.3 * y - 0.2 * x));
        });
        scene.settings.method.water_transport_order = scene.settings.method.sand_transport_order = 2;
        auto world = make_world(scene);
        const auto start = hash_of(*world);
        step(*world, 40);
        const auto stats = world->reader().stats();
        REQUIRE(stats);
        CHECK(stats->sand_quanta == stats->sand_initial);
        CHECK(stats->smallest_height >= 0);
        CHECK(stats->not_finite == 0);
        CHECK(hash_of(*world) != start);
    }
}
