// Shores that move over sloping ground (NUMERICS 2.4c, 2.16): run-up, standing waves on a beach, walls.
#include "tests/stability/quality.hpp"
#include <numbers>

using namespace wadi;
using namespace wadi::test;

namespace {

// The first row's depth of water [m].
std::vector<double> depth_along(World& world) {
    const auto water = cells_of(world, "water_height");
    std::vector<double> depth;
    for (int i = 0; i < water.nx; ++i) depth.push_back(water.at(i, 0));
    return depth;
}

// Run-up of a solitary wave of height 0.0185 on still water 1 m deep, on a beach of 1:19.85, over Synolakis' (1987) law
// R = 2.831 sqrt(cot beta) H^(5/4): ground below the highest cell that gets deeper than a millimetre.
double run_up(int order, double dx) {
    const double height = 0.0185, cot = 19.85, gravity = 9.81, law = 2.831 * std::sqrt(cot) * std::pow(height, 1.25);
    const double toe = 60, dt = 0.25 * dx / std::sqrt(gravity), number = std::sqrt(0.75 * height);
    const double crest = toe - std::acosh(std::sqrt(20)) / number; // at the toe the wave is a twentieth of its height
    auto scene = flat_scene(static_cast<int>((toe + cot * (1 + 2 * law)) / dx), 1, dx, dt);
    const auto wave = [&](double x) { return x < toe ? height / std::pow(std::cosh(number * (x - crest)), 2) : 0.0; };
    const auto bed = [&](double x) { return std::max(0.0, (x - toe) / cot); };
    scene.fill(scene.fields.terrain, [&](double x, double) { return bed(x); });
    scene.fill(scene.fields.water, [&](double x, double) { return std::max(0.0, 1 + wave(x) - bed(x)); });
    scene.fill(scene.fields.velocity_x, [&](double x, double) { return std::sqrt(gravity) * wave(x) / (1 + wave(x)); });
    scene.settings.method.water_transport_order = order;
    auto world = make_world(scene);
    double highest = 0;
    for (int n = 0; n < 25 / dt; n += 4) {
        step(*world, 4);
        const auto depth = depth_along(*world);
        for (std::size_t i = 0; i < depth.size(); ++i)
            if (depth[i] > 1e-3) highest = std::max(highest, bed((static_cast<double>(i) + 0.5) * dx) - 1);
    }
    return highest / law;
}

// Standing waves on a plane beach of slope S (Carrier and Greenspan 1958), in lengths of l, heights of S l and times of sqrt(l/(S
// g)): with potential A J0(s) cos(w), u = -A J1(s) cos(w)/s, surface = -A J0(s) sin(w)/4 - u^2/2, depth = s^2/16 and time = w/2 -
// u. At rest and at its lowest at w = pi/2; breaks from A = 1.
struct BeachWave {
    double amplitude = 0.6;
    double depth(double x, double since_lowest) const {
        const double time = since_lowest + std::numbers::pi / 4;
        const auto surface = [&](double s) {
            double u = 0, w = 0;
            for (int n = 0; n < 60; ++n) {
                w = 2 * (time + u);
                u = -amplitude * std::cos(w) * (s > 0 ? std::cyl_bessel_j(1, s) / s : 0.5);
            }
            return -amplitude * std::cyl_bessel_j(0, s) * std::sin(w) / 4 - u * u / 2;
        };
        if (surface(0) <= x) return 0; // landward of the shore
        double shore = 0, sea = 14;
        for (int n = 0; n < 50; ++n) {
            const double middle = (shore + sea) / 2;
            (surface(middle) - middle * middle / 16 > x ? shore : sea) = middle;
        }
        return shore * shore / 16;
    }
};

// Mean over the four quarters of a period of the volume that is in the wrong place landward of x = -l/2, in S l^2. The sea ends
// at -8 l, too far to be felt within a period.
double standing_wave_error(int order, int cells) {
    const BeachWave exact;
    const double length = 20, slope = 0.05, sea = 8, dx = (sea + 0.4) * length / cells;
    const double unit = std::sqrt(length / (slope * 9.81)), quarter = std::numbers::pi / 4 * unit;
    const int steps = static_cast<int>(std::ceil(quarter / (0.1 * dx / std::sqrt(9.81 * sea * slope * length))));
    auto scene = flat_scene(cells, 1, dx, quarter / steps);
    const auto place = [&](double x) { return x / length - sea; };
    scene.fill(scene.fields.terrain, [&](double x, double) { return slope * x; });
    scene.fill(scene.fields.water, [&](double x, double) { return slope * length * exact.depth(place(x), 0); });
    scene.settings.method.water_transport_order = order;
    auto world = make_world(scene);
    double error = 0;
    for (int n = 1; n <= 4; ++n) {
        step(*world, steps);
        const auto depth = depth_along(*world);
        for (int i = 0; i < cells; ++i) {
            const double x = place((i + 0.5) * dx);
            if (x < -0.5) continue;
            const double right = slope * length * exact.depth(x, n * quarter / unit);
            error += std::abs(depth[static_cast<std::size_t>(i)] - right) * dx / 4;
        }
    }
    return error / (slope * length * length);
}

// Water [m2] that a dam break of 1 m throws over a wall 10 m away.
double over_wall(double wall, double dx) {
    const int cells = static_cast<int>(std::lround(26 / dx));
    auto scene = flat_scene(cells, 1, dx, 0.25 * dx / std::sqrt(9.81));
    scene.fill(scene.fields.terrain, [&](double x, double) { return x > 20 && x < 21 ? wall : 0; });
    scene.fill(scene.fields.water, [](double x, double) { return x < 10 ? 1 : 0; });
    scene.settings.method.water_transport_order = 2;
    auto world = make_world(scene);
    step(*world, static_cast<int>(10 / scene.settings.dt));
    const auto depth = depth_along(*world);
    double over = 0;
    for (int i = 0; i < cells; ++i)
        if ((i + 0.5) * dx > 20) over += depth[static_cast<std::size_t>(i)] * dx;
    return over;
}

} // namespace

TEST_CASE("shores: a solitary wave runs up a beach as high as Synolakis' law says") {
    for (const auto& [dx, most] : {std::pair{0.15, 0.15}, {0.07, 0.08}}) {
        const double first = run_up(1, dx), second = run_up(2, dx);
        MESSAGE("cells of " << dx << " m: run-up over the law, order 1 " << first << ", order 2 " << second);
        CHECK(std::abs(second - 1) < most);
        CHECK(std::abs(first - 1) < 1.5 * most);
    }
}

TEST_CASE("shores: standing waves on a beach converge to Carrier's and Greenspan's at an order above 1.4" *
          doctest::test_suite("long")) {
    double first[3], second[3];
    for (int level = 0; level < 3; ++level) {
        const int cells = 200 << level;
        first[level] = standing_wave_error(1, cells);
        second[level] = standing_wave_error(2, cells);
        MESSAGE(cells << " cells: error of order 1 " << first[level] << ", of order 2 " << second[level]);
    }
    CHECK(std::log2(second[0] / second[2]) / 2 > 1.4);
    CHECK(std::log2(first[0] / first[2]) / 2 > 0.7);
    CHECK(second[1] < 0.5 * first[2]); // better than first order on cells half as large
}

TEST_CASE("shores: water runs over a wall lower than its head, and hardly a splash over one as high as it can get") {
    const double low = over_wall(0.6, 0.2), high = over_wall(2, 0.2);
    MESSAGE("over a wall of 0.6 m " << low << " m2, of 2 m " << high << " m2");
    CHECK(low > 1);
    CHECK(high < 1e-3);
}
