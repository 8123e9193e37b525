// Semi-Lagrangian velocities of the method published beside the flux form (NUMERICS 2.12).
#include "engine/settings/data/method_presets.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

// Ritter's dam break: 1 m of water in the western half, dry ground in the eastern one. How far the front (1 cm) ran in 3 s [m].
double front_of_dam_break(const char* method) {
    const double dx = 0.25, dam = 25;
    auto scene = flat_scene(200, 4, dx, 0.02);
    scene.fill(scene.fields.water, [&](double x, double) { return x < dam ? 1.0 : 0.0; });
    choose_method(scene.settings, method);
    scene.settings.method.velocity_clamp = 0.9;
    scene.settings.method.outflow_limiter = true;
    auto world = make_world(scene);
    step(*world, 150);
    const auto depth = world->reader().read_raw("water_height");
    REQUIRE(depth);
    const FieldLayout layout{200, 4};
    double front = 0;
    for (int i = 0; i < 200; ++i)
        if ((*depth)[layout.index(i, 1)] > 0.01F) front = (i + 1) * dx - dam;
    return front;
}

} // namespace

TEST_CASE("a traced-back front on dry ground stays behind the one in flux form, as the method's design says") {
    const double exact = 2 * std::sqrt(9.81) * 3, flux_form = front_of_dam_break("robust"),
                 traced = front_of_dam_break("published");
    MESSAGE("front after 3 s: exact " << exact << " m, flux form " << flux_form << " m, semi-Lagrangian " << traced << " m");
    CHECK(flux_form > 0.7 * exact);
    CHECK(traced < 0.85 * flux_form);
    CHECK(traced > 0.3 * exact);
}

TEST_CASE("a uniform stream keeps every bit of its velocity when traced back") {
    auto scene = flat_scene(32, 24, 0.5, 0.02);
    scene.fill(scene.fields.water, [](double, double) { return 1; });
    scene.fill(scene.fields.velocity_x, [](double, double) { return 0.7F; });
    scene.fill(scene.fields.velocity_y, [](double, double) { return -0.3F; });
    choose_method(scene.settings, "published");
    auto world = make_world(scene);
    step(*world, 3); // the walls' waves have come 3 cells far
    const auto u = world->reader().read_raw("water_velocity_x");
    REQUIRE(u);
    CHECK((*u)[FieldLayout{32, 24}.index(16, 12)] == 0.7F);
}
