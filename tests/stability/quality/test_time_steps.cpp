// Waves and stress at time steps far beyond what the grid can follow are slowed, but as smooth as within; at steps so short that
// a flux is a small part of a quantum, velocities still gather.
#include "engine/level/level.hpp"
#include "tests/stability/quality.hpp"
#include <array>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double GRAVITY = 9.81;

/// A column of water 8 m deep in 1 m of it, at dt/dx sqrt(g W) = courant.
Scene flood(double courant) {
    auto scene = flat_scene(40, 40, 1, courant / std::sqrt(GRAVITY * 8));
    scene.settings.method.largest_height = 64;
    scene.fill(scene.fields.water, [](double x, double y) { return x < 14 && y < 20 ? 8.0 : 1.0; });
    return scene;
}

/// A damp pile with c_el dts/dx = courant by its stiffness ahead of the cap.
Scene stiff_pile(double courant) {
    auto scene = flat_scene(40, 40, 0.1, 0.009);
    auto& m = scene.settings.material;
    const double modulus = std::pow(courant * 0.1 / 0.003, 2) * m.sand_density; // lambda + 2 mu
    m.young_modulus = modulus * (1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio) / (1 - m.poisson_ratio);
    m.cohesion_wet = m.cohesion_capillary = 4.2e3;
    const auto inside = [](double x, double y) { return std::hypot(x - 2, y - 2) < 1.2; };
    scene.fill(scene.fields.sand, [&](double x, double y) { return inside(x, y) ? 1.0 : 0.0; });
    scene.fill(scene.fields.water, [&](double x, double y) { return inside(x, y) ? 0.25 : 0.0; });
    return scene;
}

} // namespace

TEST_CASE("gravity CFL 0.4 to 20: water stays free of a checkerboard and gains no energy; without the gravity cap it does not") {
    for (const double courant : {0.4, 0.8, 2.0, 5.0, 20.0}) {
        CAPTURE(courant);
        auto scene = flood(courant);
        on_every_backend(scene, [&](World& world) {
            const double start = water_energy(world);
            CHECK(worst(world, 40, 10, water_checkerboard) < 2e-4);
            CHECK(water_energy(world) < start);
        });
        if (courant < 0.8) continue;
        scene.settings.method.gravity_cap = 0;
        CHECK(worst(*make_world(scene), 200, 10, water_checkerboard) > 0.1);
    }
}

TEST_CASE("elastic CFL 0.3 to 5: a damp pile comes to rest; without the elastic cap it shakes for ever" *
          doctest::test_suite("long")) {
    for (const double courant : {0.3, 0.8, 1.5, 5.0}) {
        CAPTURE(courant);
        auto scene = stiff_pile(courant);
        auto held = make_world(scene);
        step(*held, 200);
        CHECK(sand_speed(*held) == 0); // as drawn, prestressed
        scene = level_ground(scene);
        auto world = make_world(scene);
        step(*world, 200);
        check_books(*world);
        CHECK(sand_speed(*world) < 0.01);
        CHECK(roughness(cells_of(*world, "sand_height")) < 0.1);
        if (courant < 1.5) continue;
        scene.settings.method.elastic_cap = 0;
        auto bare = make_world(scene);
        step(*bare, 200);
        CHECK(sand_speed(*bare) > 0.1);
    }
    on_every_backend(stiff_pile(5), [](World& world) { step(world, 30); });
}

TEST_CASE("at dt = 1e-5 s water on a slope gathers speed as gravity says, though no quantum moves yet") {
    auto scene = flat_scene(24, 24, 1, 1e-5);
    scene.fill(scene.fields.terrain, [](double x, double) { return 0.01 * x; });
    scene.fill(scene.fields.water, [](double, double) { return 1.0; });
    on_every_backend(scene, [](World& world) {
        const auto before = cells_of(world, "water_height");
        step(world, 200);
        CHECK(cells_of(world, "water_velocity_x").at(12, 12) == doctest::Approx(-GRAVITY * 0.01 * 200e-5).epsilon(0.01));
        // A quantum in 500 steps at most, and none of these has so high a phase: NUMERICS 2.2.
        CHECK(moved(before, cells_of(world, "water_height"), 1) == 0);
    });
    scene.settings.dt = 1e-2; // negative control: long steps do move quanta
    auto longer = make_world(scene);
    const auto before = cells_of(*longer, "water_height");
    step(*longer, 10);
    CHECK(moved(before, cells_of(*longer, "water_height"), 1) > 0);
}

namespace {

// The canyon at a test's size, to its end.
constexpr double CANYON_SECONDS = 70;

Result<Level> canyon(double dt) {
    LevelOverrides overrides;
    overrides.size = {100, 128};
    overrides.dt = dt;
    return load_level(WADI_SOURCE_DIR "/samples/levels/canyon/level.json", overrides);
}

struct Eroded {
    std::array<double, 3> sand; // moved after 30 and 50 s and at the end [m3]
    double rate;                // at 30 s, in the midst of the second dam's failure [m3/s]
};

Eroded eroded(const Level& level) {
    const auto world = make_world({level.settings, level.fields});
    const auto before = cells_of(*world, "sand_height");
    const auto until = [&](double seconds) {
        const auto steps = static_cast<int>(std::lround(seconds / level.settings.dt)) - static_cast<int>(world->steps());
        step(*world, steps);
        return moved(before, cells_of(*world, "sand_height"), level.settings.grid.dx);
    };
    const double ahead = until(29.5), then = until(30), later = until(30.5), some = until(50);
    return {{then, some, until(CANYON_SECONDS)}, later - ahead};
}

} // namespace

TEST_CASE("the canyon's flood moves the same sand at any dt that the loader takes without a word" * doctest::test_suite("long")) {
    const double most = 0.0355, shipped = 0.015; // [s]; most: the loader says so
    const auto longest = canyon(most), longer = canyon(most * 1.01), as_shipped = canyon(shipped), quarter = canyon(most / 4),
               twice = canyon(most * 2);
    for (const auto* level : {&longest, &longer, &as_shipped, &quarter, &twice}) REQUIRE_MESSAGE(*level, level->status().message);
    CHECK(longest->warnings.empty());
    CHECK(!longer->warnings.empty());
    const auto most_sand = eroded(*longest), shipped_sand = eroded(*as_shipped), converged = eroded(*quarter),
               wrong = eroded(*twice);
    for (const std::size_t n : {0, 1, 2}) {
        CAPTURE(n);
        CHECK(std::fabs(shipped_sand.sand[n] / converged.sand[n] - 1) < 0.02);
        if (n > 0) CHECK(std::fabs(most_sand.sand[n] / converged.sand[n] - 1) < 0.02);
        CHECK(std::fabs(wrong.sand[n] / converged.sand[n] - 1) > 0.05); // negative control: what the loader warns of
    }
    // At 30 s a dam fails, and 7 % of what has moved by then moves in each second: a time counts there, not a volume.
    const auto ahead = [&](const Eroded& of) { return (of.sand[0] - converged.sand[0]) / converged.rate; };
    CHECK(std::fabs(ahead(most_sand)) < 0.5);
    CHECK(std::fabs(ahead(wrong)) > 2);
}

TEST_CASE("15 to 240 frames a second take the same steps to the same bits" * doctest::test_suite("long")) {
    const auto level = canyon(0.03);
    REQUIRE_MESSAGE(level, level.status().message);
    std::uint64_t expected = 0;
    for (const std::uint64_t frames : {15, 24, 60, 144, 240}) {
        CAPTURE(frames);
        const auto world = make_world({level->settings, level->fields});
        REQUIRE(world->set_update_settings({.max_steps_in_flight = 0}));
        Frame frame;
        for (std::uint64_t n = 0; n < 12 * frames; ++n) REQUIRE(world->update(1'000'000'000 / frames, frame));
        CHECK(frame.dropped_total == 0);
        REQUIRE(world->steps() >= 399); // 12 s, less what a frame of whole nanoseconds leaves out
        step(*world, 400 - static_cast<int>(world->steps()));
        const auto hash = hash_of(*world);
        if (expected == 0) expected = hash;
        CHECK(hash == expected);
    }
    const auto coarse = canyon(0.06); // negative control
    REQUIRE_MESSAGE(coarse, coarse.status().message);
    const auto other = make_world({coarse->settings, coarse->fields});
    step(*other, 200);
    CHECK(hash_of(*other) != expected);
}
