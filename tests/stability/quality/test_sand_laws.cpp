// Dry sand against the laboratory: how far a column runs out (Lube et al. 2004) and how steep a poured heap stands.
#include "tests/stability/quality.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

/// (final - initial)/initial radius of a column of height aspect * radius, along x; the edge is 1 % of the initial height.
double run_out(double aspect, double friction) {
    const int n = 97; // the middle cell's centre is the column's axis
    const double radius = 0.5;
    const double dx = radius / 12;
    auto scene = flat_scene(n, n, dx, 0.006);
    scene.settings.material.friction = friction;
    scene.settings.material.young_modulus = 0;
    const double middle = n * dx / 2;
    scene.fill(scene.fields.sand,
               [&](double x, double y) { return std::hypot(x - middle, y - middle) < radius ? aspect * radius : 0; });
    auto world = make_world(scene);
    step(*world, 500);
    CHECK(world->reader().stats()->largest_sand_speed == 0); // at rest
    const auto sand = cells_of(*world, "sand_height").values;
    int edge = 0;
    for (int i = n / 2; i < n; ++i) {
        if (static_cast<double>(sand[static_cast<std::size_t>((n / 2) * n + i)]) > 0.01 * aspect * radius) edge = i;
    }
    CHECK(edge < n - 1); // no wall met
    return ((edge - n / 2 + 0.5) * dx - radius) / radius;
}

struct Slopes {
    double axis = 0, diagonal = 0;
};

/// Mean slope of a heap poured slowly onto its middle, between 0.3 and 0.8 of its radius.
Slopes poured_slope(double friction) {
    const int n = 81;
    const double dx = 0.05;
    const double middle = n * dx / 2;
    auto scene = flat_scene(n, n, dx, 0.009);
    scene.settings.material.friction = friction;
    scene.settings.material.young_modulus = 0;
    Source source;
    source.material = SourceMaterial::sand;
    source.center = {middle, middle};
    source.radius = 0.1;
    const double seconds = 40; // of pouring
    const double foot = 1.2;   // radius of the cone that it makes [m]
    const double rate = friction * std::pow(foot, 3) / 3 / (source.radius * source.radius * seconds);
    source.rate.samples = {{0, rate}, {seconds, rate}, {seconds + 0.01, 0}};
    scene.settings.sources = {source};
    auto world = make_world(scene);
    step(*world, static_cast<int>((seconds + 8) / scene.settings.dt));
    const auto sand = cells_of(*world, "sand_height").values;
    step(*world, 100);
    CHECK(cells_of(*world, "sand_height").values ==
          sand); // nothing moves, though a face on the brink may keep a speed too slow to move a quantum
    CHECK(world->reader().stats()->largest_sand_speed < 2e-3);
    const auto at = [&](int i, int j) {
        return static_cast<double>(sand[static_cast<std::size_t>((n / 2 + j) * n + n / 2 + i)]);
    };
    const auto slope = [&](int along_x, int along_y) {
        const double spacing = dx * std::hypot(along_x, along_y);
        const int inner = static_cast<int>(0.3 * foot / spacing);
        const int outer = static_cast<int>(0.8 * foot / spacing);
        return (at(inner * along_x, inner * along_y) - at(outer * along_x, outer * along_y)) / ((outer - inner) * spacing);
    };
    CHECK(slope(1, 0) == doctest::Approx(slope(0, -1)).epsilon(0.02));
    return {slope(1, 0), slope(1, 1)};
}

} // namespace

TEST_CASE("a dry column of aspect up to 1 runs out as far as in the laboratory, with the friction of quartz sand" *
          doctest::test_suite("long")) {
    const auto as_measured = [](double aspect, double friction) {
        const double laboratory = 1.24 * aspect;
        const double here = run_out(aspect, friction);
        return std::fabs(here / laboratory - 1) < 0.2;
    };
    for (const double aspect : {0.3, 0.5, 0.75, 1.0}) CHECK(as_measured(aspect, 0.7));
    // Negative controls: sand too smooth and too rough.
    for (const double friction : {0.5, 1.2}) {
        CHECK_FALSE(as_measured(0.5, friction));
        CHECK_FALSE(as_measured(1.0, friction));
    }
}

TEST_CASE("a heap poured slowly stands at the friction slope along the axes and the diagonals, and at rest" *
          doctest::test_suite("long")) {
    const auto within = [](double slope, double friction) { return std::fabs(slope / friction - 1) < 0.08; };
    for (const double friction : {0.4, 0.7}) {
        const Slopes slopes = poured_slope(friction);
        CAPTURE(slopes.axis);
        CAPTURE(slopes.diagonal);
        CHECK(within(slopes.axis, friction));
        CHECK(within(slopes.diagonal, friction));
        CHECK_FALSE(within(slopes.axis, friction * 1.12)); // negative control: another friction
        CHECK_FALSE(within(slopes.diagonal, friction / 1.12));
    }
}
