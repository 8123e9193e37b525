// Streams between upright banks that run across the grid: what stairs of cells take of their way (NUMERICS 2.3).
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

/// Shares of its speed along the banks and of its energy of motion.
struct Kept {
    double speed = 0, energy = 0;
};

// What water 1 m deep keeps in a ring of some five cells between upright banks, level and without friction, so that it meets
// banks at every angle: after 5, 20, 80 and 160 s. blocked: cells of the ring that a wall fills from one bank on.
std::vector<Kept> kept_in_ring(int order, double blocked) {
    const int n = 60;
    auto scene = flat_scene(n, n, 1, 0.05);
    scene.settings.method.water_transport_order = order;
    const auto wet = [&](double x, double y) {
        const double r = std::hypot(x - n / 2.0, y - n / 2.0);
        const bool wall = std::abs(y - n / 2.0) < 1 && x > n / 2.0 && r < 18 - 2.4 + blocked;
        return std::abs(r - 18) < 2.4 && !wall;
    };
    // Not where it would throw water onto the banks: that falls back.
    const auto moves = [&](double x, double y) { return wet(x - 1, y) && wet(x + 1, y) && wet(x, y - 1) && wet(x, y + 1); };
    const auto round = [&](double x, double y, double part) {
        return moves(x, y) ? 0.5 * part / std::hypot(x - n / 2.0, y - n / 2.0) : 0;
    };
    scene.fill(scene.fields.terrain, [&](double x, double y) { return wet(x, y) ? 0 : 10; });
    scene.fill(scene.fields.water, [&](double x, double y) { return wet(x, y) ? 1 : 0; });
    scene.fill(scene.fields.velocity_x, [&](double x, double y) { return round(x, y, n / 2.0 - y); });
    scene.fill(scene.fields.velocity_y, [&](double x, double y) { return round(x, y, x - n / 2.0); });
    auto world = make_world(scene);
    const auto now = [&] {
        const auto u = cells_of(*world, "water_velocity_x"), v = cells_of(*world, "water_velocity_y");
        Kept sums;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                const double x = i + 0.5 - n / 2.0, y = j + 0.5 - n / 2.0;
                sums.speed += (v.at(i, j) * x - u.at(i, j) * y) / std::hypot(x, y);
                sums.energy += u.at(i, j) * u.at(i, j) + v.at(i, j) * v.at(i, j);
            }
        }
        return sums;
    };
    const Kept before = now();
    std::vector<Kept> kept;
    for (const int steps : {100, 300, 1200, 1600}) {
        step(*world, steps);
        const Kept after = now();
        kept.push_back({after.speed / before.speed, after.energy / before.energy});
        MESSAGE("order " << order << ", blocked " << blocked << ", " << world->time() << " s: speed " << kept.back().speed
                         << ", energy " << kept.back().energy);
    }
    CHECK(ledger_holds(*world, stats_of(*world)));
    return kept;
}

} // namespace

TEST_CASE("channels: banks across the grid let water go on, and give it nothing; a wall half across holds it") {
    for (const int order : {1, 2}) {
        CAPTURE(order);
        const auto kept = kept_in_ring(order, 0), held = kept_in_ring(order, 2.5);
        double before = 1;
        for (const Kept& now : kept) {
            CHECK(now.energy < before);
            before = now.energy;
        }
        CHECK(kept.back().speed > 0.75); // after 160 s
        CHECK(held.back().speed < 0.8 * kept.back().speed);
    }
}
