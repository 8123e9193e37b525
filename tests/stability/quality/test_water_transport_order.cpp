// First and second order transport of water (NUMERICS 2.16): errors against exact solutions as cells halve, monotone velocities,
// exact mass, the same bits on every backend.
#include "tests/stability/quality.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double g = 9.81;

std::vector<double> row_of(World& world, const char* field, int nx, int ny) {
    const auto raw = world.reader().read_raw(field);
    REQUIRE(raw);
    const FieldLayout layout{nx, ny};
    std::vector<double> row;
    for (int i = 0; i < nx; ++i) row.push_back(static_cast<double>((*raw)[layout.index(i, 1)]));
    return row;
}

// Mean error of the depth [m] of Ritter's dam break on dry ground, 1 m deep, after 3 s.
double dam_break_error(int order, int n) {
    const double dx = 50.0 / n, dt = 0.04 * dx;
    auto scene = flat_scene(n, 3, dx, dt);
    scene.fill(scene.fields.water, [](double x, double) { return x < 25 ? 1 : 0; });
    scene.settings.method.water_transport_order = order;
    auto world = make_world(scene);
    const int steps = static_cast<int>(std::lround(3 / dt));
    step(*world, steps);
    const auto depth = row_of(*world, "water_height", n, 3);
    double error = 0;
    for (int i = 0; i < n; ++i) {
        const double s = ((i + 0.5) * dx - 25) / (steps * dt), c = std::sqrt(g);
        const double exact = s <= -c ? 1 : s >= 2 * c ? 0 : (2 * c - s) * (2 * c - s) / (9 * g);
        error += std::abs(depth[static_cast<std::size_t>(i)] - exact) / n;
    }
    return error;
}

// A wave that runs east into still water, u = 2 (sqrt(g h) - sqrt(g)): each depth keeps its speed u + sqrt(g h). Depth at x and
// t.
double simple_wave(double x, double t) {
    const auto start = [](double x0) { return 1 + 0.3 * std::exp(-(x0 - 20) * (x0 - 20) / 16); };
    double low = x - 60, high = x; // where the depth that is at x now came from
    for (int n = 0; n < 80; ++n) {
        const double middle = 0.5 * (low + high), c = std::sqrt(g * start(middle));
        (middle + t * (3 * c - 2 * std::sqrt(g)) < x ? low : high) = middle;
    }
    return start(low);
}

// Mean error of the depth [m] of that wave before it breaks.
double simple_wave_error(int order, int n) {
    const double dx = 60.0 / n, dt = 0.04 * dx;
    auto scene = flat_scene(n, 3, dx, dt);
    scene.fill(scene.fields.water, [](double x, double) { return simple_wave(x, 0); });
    scene.fill(scene.fields.velocity_x, [](double x, double) { return 2 * (std::sqrt(g * simple_wave(x, 0)) - std::sqrt(g)); });
    scene.settings.method.water_transport_order = order;
    auto world = make_world(scene);
    const int steps = static_cast<int>(std::lround(2 / dt));
    step(*world, steps);
    const auto depth = row_of(*world, "water_height", n, 3);
    double error = 0;
    for (int i = 0; i < n; ++i)
        error += std::abs(depth[static_cast<std::size_t>(i)] - simple_wave((i + 0.5) * dx, steps * dt)) / n;
    return error;
}

Scene wet_scene(int order) {
    auto scene = mixed_scene(48, 40);
    scene.settings.method.water_transport_order = order;
    return scene;
}

} // namespace

TEST_CASE("order of transport: a smooth wave's error falls by two and a half or more where first order halves it at best") {
    double first[2], second[2];
    for (int level = 0; level < 2; ++level) {
        const int n = 120 << level;
        first[level] = simple_wave_error(1, n);
        second[level] = simple_wave_error(2, n);
        MESSAGE("simple wave, " << n << " cells: order 1 " << first[level] << " m, order 2 " << second[level] << " m");
    }
    CHECK(first[0] < 2.2 * first[1]);
    CHECK(second[0] > 2.5 * second[1]);
    CHECK(second[0] < 0.55 * first[1]); // better than first order with half the cell size
}

TEST_CASE("order of transport: a dam break on dry ground is nearer than by first order with half the cell size") {
    for (const int n : {100, 200}) {
        const double first = dam_break_error(1, n), finer = dam_break_error(1, 2 * n), second = dam_break_error(2, n);
        MESSAGE("Ritter, " << n << " cells: order 1 " << first << " m, with half the cells' size " << finer << " m, order 2 "
                           << second << " m");
        CHECK(second < 0.75 * finer);
        CHECK(finer < first);
    }
}

TEST_CASE("order of transport: a velocity stays between those of its face and the four around it, at any time step") {
    for (const double dt : {0.02, 0.2, 1.0}) { // Courant numbers up to 0.1, 1 and 5
        const int nx = 60, ny = 50;
        auto scene = flat_scene(nx, ny, 0.5, dt);
        const auto jagged = [](double x, double y, double phase) {
            return std::sin(173 * x + phase) * std::cos(251 * y - phase * x);
        };
        scene.fill(scene.fields.water, [&](double x, double y) { return 1 + 0.98 * jagged(x, y, 0.3); });
        scene.fill(scene.fields.velocity_x, [&](double x, double y) { return 2.5 * jagged(x, y, 1); });
        scene.fill(scene.fields.velocity_y, [&](double x, double y) { return 2.5 * jagged(x, y, 2); });
        scene.settings.gravity = 0;
        auto& method = scene.settings.method;
        method.rest_rule = false;
        method.velocity_clamp = 10;
        method.water_transport_order = 2;
        auto world = make_world(scene);
        step(*world, 1); // and a half: velocities start half a step ahead
        const FieldLayout layout{nx, ny};
        int changed = 0, outside = 0;
        for (int n = 0; n < 10; ++n) {
            const std::array fields = {"water_velocity_x", "water_velocity_y"};
            const auto before_x = world->reader().read_raw(fields[0]), before_y = world->reader().read_raw(fields[1]);
            step(*world, 1);
            for (const bool is_y : {false, true}) {
                const auto& before = is_y ? before_y : before_x;
                const auto after = world->reader().read_raw(fields[is_y]);
                REQUIRE((before && after));
                for (int j = 1; j + 1 < ny; ++j) {
                    for (int i = 1; i + 1 < nx; ++i) {
                        const auto at = [&](int di, int dj) { return (*before)[layout.index(i + di, j + dj)]; };
                        const auto around = {at(0, 0), at(-1, 0), at(1, 0), at(0, -1), at(0, 1)};
                        const float u = (*after)[layout.index(i, j)];
                        changed += u != at(0, 0);
                        outside += u != 0 && (u < std::min(around) || u > std::max(around)); // 0: a dry face
                    }
                }
            }
        }
        MESSAGE("dt " << dt << " s: " << changed << " velocities changed");
        CHECK(changed > 10000);
        CHECK(outside == 0);
    }
}

TEST_CASE("second order of water: exact mass, no negative height, the same bits on every backend, other bits than first order") {
    const auto run = [](World& world) { step(world, 60); };
    on_every_backend(wet_scene(2), run);
    auto first = make_world(wet_scene(1)), second = make_world(wet_scene(2));
    run(*first);
    run(*second);
    CHECK(hash_of(*first) != hash_of(*second));
}

TEST_CASE("second order of water: the first half step belongs to step 0, whoever saved, loaded or went by parts before it") {
    auto scene = wet_scene(2), tiled = scene;
    tiled.settings.active_tiles = 8;
    const auto run = [](World& world) {
        step(world, 5);
        return hash_of(world);
    };
    auto plain = make_world(scene), loaded = make_world(scene), by_parts = make_world(scene), tiles = make_world(tiled);
    const auto start = save(*plain);
    const auto expected = run(*plain);
    step(*loaded, 3);
    REQUIRE(loaded->snapshots().load(start));
    CHECK(run(*loaded) == expected);
    for (int n = 0; n < 5 * by_parts->stepper().parts(); ++n) REQUIRE(by_parts->stepper().step_part());
    CHECK(hash_of(*by_parts) == expected);
    CHECK(run(*tiles) == expected);
    REQUIRE(loaded->snapshots().load(start));
    step(*loaded, 1);
    const auto later = save(*loaded);
    auto other = make_world(scene);
    REQUIRE(other->snapshots().load(later)); // no start behind step 0
    step(*other, 4);
    CHECK(hash_of(*other) == expected);
}
