// Shear at the corners of cells (NUMERICS 0, row 12): the least height times the mean stress keeps a thin edge calm that the mean
// of height times stress sets swinging.
#include "tests/reference/test_support.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::reference;
using namespace wadi::reference::test;

TEST_CASE("reference: shear at corners takes the least height; with mean heights films at a cliff run away") {
    for (const bool mean_shear : {false, true}) {
        Settings set = make_settings(40, 40, 0.1, 0.009);
        set.gravity = 0;
        set.material.friction = 0;
        set.material.young_modulus = 1e5;
        set.material.cohesion_dry = set.material.cohesion_wet = set.material.cohesion_capillary = 1e8;
        set.method.quantum = set.method.cohesion_cap = set.method.passive_pressure = 0;
        Solver<double> s(set, EFFECT_SAND | EFFECT_ELASTOPLASTIC);
        s.mean_corner_shear = mean_shear;
        const auto noise = [](double x, double y) { return 1e-6 * std::fmod(x * 7919.3 + y * 104729.7, 1.0); };
        fill(s, s.sand, [&](double x, double y) { return (std::hypot(x - 2, y - 2) < 1 ? 1.0 : 0.0) + 10 * noise(x, y); });
        for_all_faces(s, [&](const Axis& ax, int a, int b) {
            if (a > 0 && a < ax.along()) s.sand_velocity.along(ax)[ax.face(a, b)] = noise(b + 0.5, a + 0.5) - 0.5e-6;
        });
        double fastest = 0;
        for (int n = 0; n < 60; ++n) {
            s.step();
            fastest = std::max(fastest, largest(s.sand_velocity));
        }
        CHECK((mean_shear ? fastest > 1 : fastest < 1e-5));
    }
}
