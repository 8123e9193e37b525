// Friction by thickness and speed (NUMERICS 2.8): sand on a chute comes to the speed at which friction bears it, and thin layers
// stand.
#include "tests/stability/quality.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

// Sand of Forterre and Pouliquen 2003 on a chute of 32 degrees, as 2.8 has it.
constexpr double MU = 0.5095, MU_2 = 0.9456, LENGTH = 1.58e-3, BETA = 0.65, GAMMA = 0.77, SLOPE = 0.6249, GRAVITY = 9.81;
const double COSINE = 1 / std::sqrt(1 + SLOPE * SLOPE);

/// Speed along the bed at which a layer so thick (normal to it) is borne [m/s].
double steady_speed(double thickness) {
    const double froude = BETA * thickness / LENGTH * (SLOPE - MU) / (MU_2 - SLOPE) - GAMMA;
    return froude * std::sqrt(GRAVITY * thickness * COSINE);
}

/// Speed along the bed, in the middle of a long chute along x or y, of a layer that began with `speed`.
double speed_after(double seconds, double thickness, double speed, double length, bool along_y = false) {
    const int cells = 700;
    const double dx = 0.5, dt = 0.01;
    auto scene = along_y ? flat_scene(3, cells, dx, dt) : flat_scene(cells, 3, dx, dt);
    scene.settings.method.largest_height = 256;
    auto& m = scene.settings.material;
    m.friction = MU;
    m.young_modulus = 0;
    m.flow_friction = MU_2;
    m.flow_length = length;
    m.flow_beta = BETA;
    m.flow_gamma = GAMMA;
    scene.fill(scene.fields.terrain, [&](double x, double y) { return SLOPE * (cells * dx - (along_y ? y : x)); });
    scene.fill(scene.fields.sand, [&](double, double) { return thickness / COSINE; });
    scene.fill(along_y ? scene.fields.sand_velocity_y : scene.fields.sand_velocity_x,
               [&](double, double) { return speed * COSINE; });
    auto world = make_world(scene);
    step(*world, static_cast<int>(seconds / dt));
    const auto u = cells_of(*world, along_y ? "sand_velocity_y" : "sand_velocity_x").values;
    const std::size_t middle = along_y ? 3 * (cells * 2 / 3) + 1 : cells + cells * 2 / 3;
    return static_cast<double>(u[middle]) / COSINE;
}

} // namespace

TEST_CASE("sand on a chute comes to a steady speed by its thickness, from below and from above") {
    for (const double thickness : {0.02, 0.04, 0.08}) {
        const double law = steady_speed(thickness);
        CAPTURE(thickness);
        CAPTURE(law);
        CHECK(speed_after(20, thickness, 0.8 * law, LENGTH) == doctest::Approx(law).epsilon(0.05));
        CHECK(speed_after(20, thickness, 1.2 * law, LENGTH) == doctest::Approx(law).epsilon(0.05));
    }
    CHECK(speed_after(20, 0.04, steady_speed(0.04), LENGTH, true) == doctest::Approx(steady_speed(0.04)).epsilon(0.05));
    CHECK(speed_after(20, 0.04, steady_speed(0.04), 0) > 2 * steady_speed(0.04)); // control: constant friction
}

TEST_CASE("a layer thinner than friction at rest bears stands, a thicker one slides") {
    const double stands =
        LENGTH * GAMMA / BETA * (MU_2 - SLOPE) / (SLOPE - MU); // 5.2 mm; where flows stop in the laboratory: 4.4 mm
    CHECK(speed_after(5, 0.85 * stands, 0, LENGTH) == 0);
    CHECK(speed_after(5, 1.15 * stands, 0, LENGTH) > 0.01);
    CHECK(speed_after(5, 0.85 * stands, 0, 0) > 1); // control: constant friction bears none
}
