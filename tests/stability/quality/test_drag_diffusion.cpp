// Explicit drag and Laplacian diffusion of the method published (NUMERICS 2.14, 2.15) beside our forms: a lake over saturated
// sand shows both faults, and explicit drag its bound.
#include "engine/settings/data/method_presets.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

// A lake of surface 2 m over a dune of uneven height, all of it under water and at rest by friction.
Scene drowned_dune() {
    auto scene = flat_scene(48, 32, 0.25, 0.02);
    const auto dune = [](double x, double y) { return 0.5 + 0.3 * std::exp(-((x - 6) * (x - 6) + (y - 4) * (y - 4)) / 4); };
    scene.fill(scene.fields.sand, dune);
    scene.fill(scene.fields.water, [](double, double) { return 2.0; });
    scene.settings.material.friction = 0.9;
    scene.settings.material.young_modulus = 0;
    return scene;
}

double speed_after(const Scene& scene, int steps) {
    auto world = make_world(scene);
    step(*world, steps);
    const auto stats = world->reader().stats();
    REQUIRE(stats);
    CHECK(stats->not_finite == 0);
    return stats->largest_water_speed;
}

// Sand and the water in it start with 0.4 and -0.2 m/s on frictionless ground; the largest water speed after some steps [m/s].
double speed_of_pair(const char* method, double exchange) {
    auto scene = flat_scene(24, 16, 0.5, 0.03);
    scene.fill(scene.fields.sand, [](double, double) { return 1; });
    scene.fill(scene.fields.water, [](double, double) { return 1; });
    scene.fill(scene.fields.velocity_x, [](double, double) { return -0.2; });
    scene.fill(scene.fields.sand_velocity_x, [](double, double) { return 0.4; });
    choose_method(scene.settings, method);
    scene.settings.gravity = 0;
    auto& material = scene.settings.material;
    material.friction = 0;
    material.young_modulus = 0;
    material.diffusion_rate = 0;
    material.exchange_rate = exchange;
    auto world = make_world(scene);
    step(*world, 4);
    const auto raw = world->reader().read_raw("mixed_velocity_x");
    REQUIRE(raw);
    return static_cast<double>(std::abs((*raw)[FieldLayout{24, 16}.index(12, 8)]));
}

} // namespace

TEST_CASE("published stirs a lake at rest over a dune, robust leaves every bit") {
    auto scene = drowned_dune();
    CHECK(speed_after(scene, 100) == 0);
    choose_method(scene.settings, "published");
    const double stirred = speed_after(scene, 100);
    MESSAGE("lake at rest over a drowned dune, published: " << stirred << " m/s");
    CHECK(stirred > 1e-3);
}

TEST_CASE("explicit drag holds below its bound c_e dts (1/rho_w + 1/rho_s) = 2 and blows up above it; the joint solve never") {
    const double dts = 0.03 / 3, bound = 2 / (dts * (1.0 / 1000 + 1.0 / 2000)); // h_m = h_s
    CHECK(speed_of_pair("published", 0.5 * bound) < 0.45);
    CHECK(speed_of_pair("published", 1.5 * bound) > 2);
    CHECK(speed_of_pair("robust", 1.5 * bound) < 0.45);
    CHECK(speed_of_pair("robust", 1000 * bound) < 0.45);
}
