// What should rest, rests for ever: one step of each parity leaves every bit of a lake and of a pile unchanged
// On every backend there is.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

bool unchanged_after(World& world, int steps) {
    const auto before = state_of(world);
    step(world, steps);
    const auto after = state_of(world);
    for (std::size_t n = 0; n < before.size(); ++n) {
        for (std::size_t k = 0; k < before[n].second.size(); ++k) {
            if (before[n].second[k] != after[n].second[k]) {
                MESSAGE(before[n].first << " changed at " << k << ": " << before[n].second[k] << " -> " << after[n].second[k]);
                return false;
            }
        }
    }
    return true;
}

double gauss(double x, double y, double cx, double cy, double r) {
    return std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (r * r));
}

// A lake of surface 1 m over an uneven bed with an island, a submerged and a half-emerged dune.
Scene lake_over_dunes() {
    auto scene = flat_scene(64, 48, 0.25, 0.02);
    scene.fill(scene.fields.terrain, [](double x, double y) { return 1.4 * gauss(x, y, 3, 3, 1.5) + 0.02 * x; });
    // No film of sand on the island: it would rightly slide off its slopes.
    scene.fill(scene.fields.sand,
               [](double x, double y) { return std::max(0.0, 0.4 * gauss(x, y, 8, 8, 2) + gauss(x, y, 12, 4, 3) - 0.02); });
    // Surface on a whole quantum, as every height is.
    scene.fill(scene.fields.water,
               [](double x, double y) { return std::max(0.0, 1.0 - (1.4 * gauss(x, y, 3, 3, 1.5) + 0.02 * x)); });
    scene.settings.material.friction = 0.9;
    return scene;
}

Scene pile(double slope, double mu) {
    auto scene = flat_scene(50, 50, 0.1, 0.009);
    scene.fill(scene.fields.sand, [&](double x, double y) { return std::max(0.0, 1.0 - slope * std::hypot(x - 2.5, y - 2.5)); });
    scene.settings.material.friction = mu;
    return scene;
}

} // namespace

TEST_CASE("a lake over dunes, an island and a shore keeps every bit") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(lake_over_dunes(), {.backend = backend, .shared_device = true});
        CHECK(unchanged_after(*world, 1));
        CHECK(unchanged_after(*world, 1));
        CHECK(unchanged_after(*world, backend == "cpu" ? 200 : 20));
    }
}

TEST_CASE("a lake over rough bumps and a drowned dune from unrounded maps keeps every bit for 10 000 steps" *
          doctest::test_suite("long")) {
    auto scene = flat_scene(40, 30, 0.25, 0.02);
    const auto turned = [](double x, double y) { return 0.8 * x + 0.6 * y; }; // bumps lie across the grid
    const auto bed = [&](double x, double y) {
        return 0.3 + 0.13 * std::sin(5.1 * turned(x, y)) * std::cos(3.7 * turned(-y, x));
    };
    scene.fill(scene.fields.terrain, bed);
    scene.fill(scene.fields.sand, [](double x, double y) { return std::max(0.0, 0.3 * gauss(x, y, 5, 4, 2) - 0.02); });
    scene.fill(scene.fields.water, [&](double x, double y) { return std::max(0.0, 1.0 / 3 + 0.1 - bed(x, y)); });
    scene.settings.material.friction = 0.9;
    for (const int order : {1, 2}) {
        CAPTURE(order);
        scene.settings.method.water_transport_order = order;
        auto world = make_world(scene);
        step(*world, 2);
        CHECK(unchanged_after(*world, long_runs(10000)));
    }
}

TEST_CASE("negative control: a lake that is not level moves, and without quantum and rest rule it only nearly rests" *
          doctest::test_suite("long")) {
    auto tilted = lake_over_dunes();
    for (auto& w : tilted.fields.water) w = w > 0.5F ? w + 0.001F : w;
    CHECK_FALSE(unchanged_after(*make_world(tilted), 2));
    auto restless = lake_over_dunes();
    restless.settings.method.rest_rule = false;
    restless.settings.method.quantum = 0;
    auto world = make_world(restless);
    step(*world, 2000);
    auto stats = world->reader().stats();
    CHECK(stats->largest_water_speed < 1e-3);
}

TEST_CASE("a dry pile below the angle of repose keeps every bit, above it flows") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(pile(0.475, 0.5), {.backend = backend, .shared_device = true});
        CHECK(unchanged_after(*world, 1));
        CHECK(unchanged_after(*world, backend == "cpu" ? 300 : 20));
    }
    CHECK_FALSE(unchanged_after(*make_world(pile(0.55, 0.5)), 2));
}

TEST_CASE("a pile that has collapsed comes to exact rest, strained as it is") {
    auto scene = pile(0, 0.6);
    scene.fill(scene.fields.sand, [](double x, double y) { return std::hypot(x - 2.5, y - 2.5) < 0.8 ? 0.6 : 0.0; });
    scene.settings.material.cohesion_dry = 0;
    auto world = make_world(scene);
    step(*world, 1500);
    CHECK(unchanged_after(*world, 1));
    CHECK(unchanged_after(*world, 100));
}
