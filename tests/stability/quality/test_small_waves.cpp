// What is small must still move: the rest rule holds still what rounding makes of a level surface and nothing beyond it
// (NUMERICS 2.4e).
#include "tests/stability/quality.hpp"
#include <numbers>

using namespace wadi;
using namespace wadi::test;

namespace {

// Amplitude of a tank's first standing wave after so many periods, over that of the start [1]. Linear theory turns it about every
// half period and keeps it.
double seiche(int cells, double periods, double largest_height = 16) {
    const double length = 1, depth = 0.1, amplitude = 1e-3, gravity = 9.81, dx = length / cells;
    const double period = 2 * length / std::sqrt(gravity * depth);
    const int steps = static_cast<int>(std::ceil(periods * period / (0.4 * dx / std::sqrt(gravity * depth))));
    auto scene = flat_scene(cells, 1, dx, periods * period / steps);
    scene.settings.method.largest_height = largest_height; // what the quantum follows from
    const auto mode = [&](double x) { return std::cos(std::numbers::pi * x / length); };
    scene.fill(scene.fields.water, [&](double x, double) { return depth + amplitude * mode(x); });
    auto world = make_world(scene);
    step(*world, steps);
    const auto water = cells_of(*world, "water_height");
    double sum = 0;
    for (int i = 0; i < cells; ++i) sum += (water.at(i, 0) - depth) * mode((i + 0.5) * dx);
    return 2 * sum / cells / amplitude;
}

// Speed in the middle of a long channel of this slope over that of uniform flow, before waves from its ends arrive [1].
double river(double slope, double dx, double uniform) {
    const double depth = 0.1, gravity = 9.81, friction = gravity * depth * slope / (uniform * uniform);
    const double wave = std::sqrt(gravity * depth), time = 3 * uniform / (gravity * slope);
    const int cells = 2 * static_cast<int>(1.2 * wave * time / dx) + 1;
    auto scene = flat_scene(cells, 1, dx, 0.4 * dx / wave);
    scene.settings.material.bed_friction = friction;
    scene.fill(scene.fields.terrain, [&](double x, double) { return slope * (cells * dx - x); });
    scene.fill(scene.fields.water, [&](double, double) { return depth; });
    auto world = make_world(scene);
    step(*world, static_cast<int>(time / scene.settings.dt));
    return cells_of(*world, "water_velocity_x").at(cells / 2, 0) / uniform;
}

} // namespace

TEST_CASE("a seiche of a millimetre keeps its amplitude for two periods on 50 to 800 cells") {
    for (const int cells : {50, 100, 200, 400, 800}) {
        CAPTURE(cells);
        CHECK(seiche(cells, 0.5) == doctest::Approx(-1).epsilon(0.01));
        CHECK(seiche(cells, 2) == doctest::Approx(1).epsilon(0.01));
    }
    CHECK(seiche(400, 0.5, 128) > -0.9); // negative control: quanta and with them the rule eight times as wide
}

TEST_CASE("rivers of slope 1e-5 and 1e-4 reach their uniform flow on cells of half a metre and of 5 cm" *
          doctest::test_suite("long")) {
    CHECK(river(1e-5, 0.5, 0.01) == doctest::Approx(1).epsilon(0.01));
    CHECK(river(1e-4, 0.05, 0.03) == doctest::Approx(1).epsilon(0.01));
}
