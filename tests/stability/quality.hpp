// Measures of quality: what a run that is finite and keeps its mass can still get wrong.
#pragma once
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>

namespace wadi::test {

/// A field at cell centres.
struct Cells {
    int nx = 0, ny = 0;
    std::vector<float> values;
    double at(int i, int j) const {
        const int x = std::clamp(i, 0, nx - 1), y = std::clamp(j, 0, ny - 1); // level beyond the rim
        return static_cast<double>(
            values[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)]);
    }
};

inline Cells cells_of(World& world, const char* field) {
    const auto& g = world.settings().grid;
    Cells cells{g.nx, g.ny, std::vector<float>(static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny))};
    const auto status = world.reader().read(field, cells.values);
    REQUIRE_MESSAGE(status, status.message);
    return cells;
}

inline WorldStats stats_of(World& world) {
    auto stats = world.reader().stats();
    REQUIRE_MESSAGE(stats, stats.status().message);
    return *stats;
}

/// Sum of f(i, j) over all cells.
template <class F> double sum_over(const Cells& c, F f) {
    double sum = 0;
    for (int j = 0; j < c.ny; ++j)
        for (int i = 0; i < c.nx; ++i) sum += f(i, j);
    return sum;
}

inline double total(const Cells& c) {
    return sum_over(c, [&](int i, int j) { return c.at(i, j); });
}

inline double largest(const Cells& c) {
    double most = 0;
    for (const float x : c.values) most = std::max(most, std::fabs(static_cast<double>(x)));
    return most;
}

/// Share of the energy of a field that is in its checkerboard, the shortest wave of the grid along both axes.
inline double checkerboard(const Cells& c) {
    const auto row = [&](int i, int j) { return (2 * c.at(i, j) - c.at(i - 1, j) - c.at(i + 1, j)) / 4; };
    const double energy = sum_over(c, [&](int i, int j) { return c.at(i, j) * c.at(i, j); });
    return sum_over(c, [&](int i, int j) { return std::pow((2 * row(i, j) - row(i, j - 1) - row(i, j + 1)) / 4, 2); }) /
           std::max(energy, 1e-300);
}

inline double sand_checkerboard(World& world) { return checkerboard(cells_of(world, "sand_height")); }

/// Mean departure of a cell from the mean of its four neighbours, as a share of the mean depth. Slopes count nothing, edges
/// little.
inline double roughness(const Cells& c) {
    return sum_over(c,
                    [&](int i, int j) {
                        const double around = (c.at(i - 1, j) + c.at(i + 1, j)) + (c.at(i, j - 1) + c.at(i, j + 1));
                        return std::fabs(c.at(i, j) - around / 4);
                    }) /
           std::max(total(c), 1e-300);
}

/// Volume that lies elsewhere [m3].
inline double moved(const Cells& before, const Cells& after, double dx) {
    return sum_over(before, [&](int i, int j) { return std::fabs(after.at(i, j) - before.at(i, j)); }) / 2 * dx * dx;
}

/// sum |a - b| / sum |b|.
inline double difference(const Cells& a, const Cells& b) {
    return sum_over(b, [&](int i, int j) { return std::fabs(a.at(i, j) - b.at(i, j)); }) /
           std::max(sum_over(b, [&](int i, int j) { return std::fabs(b.at(i, j)); }), 1e-300);
}

/// Kinetic energy of sand, water above it and water inside it [J].
inline double kinetic_energy(World& world) {
    const auto sand = cells_of(world, "sand_height"), water = cells_of(world, "water_height");
    const auto& s = world.settings();
    const bool split = (world.plan().effects & EFFECT_MIXTURE) != 0;
    const auto of = [&](const std::string& layer, double density, auto depth) {
        const auto u = cells_of(world, (layer + "_velocity_x").c_str()), v = cells_of(world, (layer + "_velocity_y").c_str());
        return sum_over(u, [&](int i, int j) {
            return 0.5 * density * depth(i, j) * (u.at(i, j) * u.at(i, j) + v.at(i, j) * v.at(i, j)) * s.grid.dx * s.grid.dx;
        });
    };
    const auto inside = [&](int i, int j) { return split ? std::min(sand.at(i, j), water.at(i, j)) : 0.0; };
    return of("sand", s.material.sand_density, [&](int i, int j) { return sand.at(i, j); }) +
           of("mixed", s.material.water_density, inside) +
           of("water", s.material.water_density, [&](int i, int j) { return water.at(i, j) - inside(i, j); });
}

/// Kinetic and potential energy of a world with water alone [J].
inline double water_energy(World& world) {
    const auto h = cells_of(world, "water_height"), ground = cells_of(world, "terrain");
    const auto& s = world.settings();
    return kinetic_energy(world) + sum_over(h, [&](int i, int j) {
               return s.material.water_density * s.gravity * h.at(i, j) * (ground.at(i, j) + 0.5 * h.at(i, j)) * s.grid.dx *
                      s.grid.dx;
           });
}

/// The largest value of a measure, asked every `every` steps of a run.
template <class Measure> double worst(World& world, int steps, int every, Measure measure) {
    double most = 0;
    for (int n = 0; n < steps; n += every) {
        step(world, every);
        most = std::max(most, measure(world));
    }
    return most;
}

inline double water_checkerboard(World& world) { return checkerboard(cells_of(world, "water_height")); }
inline double sand_speed(World& world) {
    return std::max(largest(cells_of(world, "sand_velocity_x")), largest(cells_of(world, "sand_velocity_y")));
}

/// What must hold in any scene: every quantum in the ledger, heights >= 0, everything finite, speeds within the clamp.
inline bool ledger_holds(const World& world, const WorldStats& s) {
    const auto& set = world.settings();
    const double clamp = set.method.velocity_clamp * set.grid.dx * (1 + 1e-6), water_clamp = clamp / set.water_dt();
    const bool exact = s.water_quanta == s.water_initial + s.ledger.water_in - s.ledger.water_out &&
                       s.sand_quanta == s.sand_initial + s.ledger.sand_in - s.ledger.sand_out;
    return (exact || height_quantum(set.method) == 0) && s.not_finite == 0 && s.smallest_height >= 0 &&
           s.largest_water_speed <= water_clamp && s.largest_sand_speed <= clamp / set.dt * set.method.substeps;
}

inline void check_books(World& world) {
    const auto s = stats_of(world);
    CAPTURE(s.water_quanta - s.water_initial - s.ledger.water_in + s.ledger.water_out);
    CAPTURE(s.sand_quanta - s.sand_initial - s.ledger.sand_in + s.ledger.sand_out);
    CAPTURE(s.not_finite);
    CAPTURE(s.smallest_height);
    CAPTURE(s.largest_water_speed);
    CAPTURE(s.largest_sand_speed);
    CHECK(ledger_holds(world, s));
}

/// Makes a scene's world on every backend; `run(world)` steps, measures and checks it. The ledger is checked after it, and
/// backends whose arithmetic is exact must end in the CPU's bits.
template <class Run> void on_every_backend(const Scene& scene, Run run) {
    std::uint64_t expected = 0;
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(scene, {.backend = backend, .shared_device = true});
        run(*world);
        check_books(*world);
        const auto hash = hash_of(*world);
        if (expected == 0) expected = hash;
        if (world->device().capabilities().exact_float) CHECK(hash == expected);
    }
}

/// Length of runs: WADI_LONG_TESTS=10 makes those that ask ten times as long.
inline int long_runs(int steps) {
    const char* factor = std::getenv("WADI_LONG_TESTS");
    return factor != nullptr ? steps * std::max(1, std::atoi(factor)) : steps;
}

} // namespace wadi::test
