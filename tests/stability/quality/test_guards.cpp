// What each guard of a method is for: the same scene passes with it and fails without. Not here: the outflow limiter's bounds in
// other scenes (test_invariants.cpp), the elastic cap (test_time_steps.cpp), shear at corners
// (tests/reference/test_reference_guards.cpp), the reset of broken stretches and what the gradient clamp's value rests on
// (test_strain_extremes.cpp).
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

/// 8 m of water in 1 m of it at dt/dx sqrt(g W) = 2.
Scene flood() {
    auto scene = flat_scene(40, 40, 1, 2 / std::sqrt(9.81 * 8));
    scene.settings.method.largest_height = 64;
    scene.fill(scene.fields.water, [](double x, double y) { return x < 14 && y < 20 ? 8.0 : 1.0; });
    return scene;
}

/// The same of dry slippery sand, with `courant` of its substep.
Scene landslide(double courant) {
    auto scene = flat_scene(40, 40, 1, 3 * courant / std::sqrt(9.81 * 6));
    scene.settings.material.young_modulus = 0;
    scene.settings.material.friction = 0.1;
    scene.fill(scene.fields.sand, [](double x, double y) { return x < 14 && y < 20 ? 6.0 : 1.0; });
    return scene;
}

/// A terrace of sand beside a pit; how much of it is in the pit in the end, per metre of width [m2].
double filled_pit(double passive_pressure, double young_modulus, bool level = true) {
    auto scene = flat_scene(60, 6, 0.1, 0.009);
    scene.settings.material.young_modulus = young_modulus;
    scene.settings.method.passive_pressure = passive_pressure;
    scene.fill(scene.fields.terrain, [](double x, double) { return std::fabs(x - 3) < 0.8 ? 0.0 : 1.0; });
    scene.fill(scene.fields.sand, [](double x, double) { return x < 2.2 ? 1.2 : 0.0; });
    auto world = make_world(level ? level_ground(scene) : scene);
    step(*world, 500);
    const auto sand = cells_of(*world, "sand_height"), ground = cells_of(*world, "terrain");
    return sum_over(sand, [&](int i, int j) { return ground.at(i, j) < 0.5 ? sand.at(i, j) : 0.0; }) * 0.1 / 6;
}

/// A column so wet that it loses its cohesion while it drains.
Scene soaked_column(int smoothing) {
    auto scene = flat_scene(56, 56, 0.1, 0.009);
    auto& m = scene.settings.material;
    m.cohesion_wet = m.cohesion_capillary = 6.4e3;
    m.diffusion_rate = 0.002;
    scene.settings.method.saturation_smoothing = smoothing;
    const auto inside = [](double x, double y) { return std::hypot(x - 2.8, y - 2.8) < 1.7; };
    scene.fill(scene.fields.sand, [&](double x, double y) { return inside(x, y) ? 1.7 : 0.0; });
    scene.fill(scene.fields.water, [&](double x, double y) { return inside(x, y) ? 0.45 * 1.7 : 0.0; });
    return scene;
}

} // namespace

TEST_CASE("outflow limiter: the ledger holds; without it it does not") {
    for (const bool on : {true, false}) {
        auto scene = mixed_scene(40, 36);
        scene.settings.dt = 0.2;
        scene.settings.method.velocity_clamp = 0.9;
        scene.settings.method.outflow_limiter = on;
        auto world = make_world(scene);
        step(*world, 60);
        CHECK(ledger_holds(*world, stats_of(*world)) == on);
    }
}

TEST_CASE("velocity clamp: whirls too fast for dt pile water up a little and gain no energy; without it tenfold") {
    for (const double clamp : {0.35, 1e6}) {
        auto scene = flat_scene(40, 40, 0.5, 0.5);
        scene.settings.method.velocity_clamp = clamp;
        scene.settings.method.largest_height = 128;
        scene.settings.method.shock_viscosity = 0; // which takes its part of what whirls gain
        scene.fill(scene.fields.water, [](double x, double y) { return 0.5 + 0.3 * std::sin(x) * std::sin(y); });
        scene.fill(scene.fields.velocity_x, [&](double x, double y) { return 10 * std::sin(0.5 * x) * std::cos(0.5 * y); });
        scene.fill(scene.fields.velocity_y, [&](double x, double y) { return -10 * std::cos(0.5 * x) * std::sin(0.5 * y); });
        auto world = make_world(scene);
        step(*world, 20);
        const double highest = largest(cells_of(*world, "water_height"));
        CHECK((clamp < 1 ? highest < 4 : highest > 40));
    }
}

TEST_CASE("gravity caps of water and of sand: smooth beyond the CFL limit; without them there is a checkerboard") {
    auto scene = flood();
    CHECK(worst(*make_world(scene), 100, 10, water_checkerboard) < 1e-3);
    scene.settings.method.gravity_cap = 0;
    CHECK(worst(*make_world(scene), 100, 10, water_checkerboard) > 0.1);
    for (const double courant : {0.8, 2.0, 10.0}) {
        scene = landslide(courant);
        CHECK(worst(*make_world(scene), 100, 10, sand_checkerboard) < 2.5e-3); // fronts are steeper than those of level ground
        scene = level_ground(scene);
        CHECK(worst(*make_world(scene), 100, 10, sand_checkerboard) < 1e-3);
        scene.settings.method.sand_gravity_cap = 0;
        CHECK(worst(*make_world(scene), 100, 10, sand_checkerboard) > 0.1);
    }
}

TEST_CASE("compression cap: sand fills a pit, the weaker the more; without the cap it hardly does") {
    const double friction_only = filled_pit(1, 0), normal = filled_pit(1, 1e6), weak = filled_pit(0.3, 1e6),
                 none = filled_pit(0, 1e6);
    CHECK(friction_only > 1.3);
    CHECK(normal > 0.6 * friction_only);
    CHECK(weak > 0.75 * friction_only);
    CHECK(none < 0.4 * friction_only);
    // Gravity along slopes pushes sand over the brink with less than its weight: less falls in, and the cap counts less.
    const double on_slopes = filled_pit(1, 0, false);
    CHECK(on_slopes > 0.9);
    CHECK(filled_pit(1, 1e6, false) > 0.5 * on_slopes);
    CHECK(filled_pit(0, 1e6, false) == doctest::Approx(on_slopes)); // and sand without cohesion bears no compression at all
}

TEST_CASE("low-pass of saturation: a soaked column runs out smooth; without it, it falls into ripples") {
    const auto rough = [](const Scene& scene) {
        auto world = make_world(scene);
        step(*world, 300);
        return roughness(cells_of(*world, "sand_height"));
    };
    CHECK(rough(level_ground(soaked_column(2))) < 0.012);
    CHECK(rough(level_ground(soaked_column(1))) < 0.02);
    CHECK(rough(level_ground(soaked_column(0))) > 0.06);
    for (const int smoothing : {0, 2}) CHECK(rough(soaked_column(smoothing)) < 0.006); // laws by default do without
}

TEST_CASE("gradient clamp: sand that runs into sand is pressed; without it the strain turns inside out and is lost") {
    for (const double clamp : {0.4, 0.0}) {
        auto scene = level_ground(flat_scene(32, 8, 0.1, 0.01)); // 6 of strain in the first substep
        auto& method = scene.settings.method;
        method.substeps = 1;
        method.velocity_clamp = 1e6;
        method.gradient_clamp = clamp;
        scene.settings.material.friction = 0;
        scene.settings.material.young_modulus = 1e6;
        scene.fill(scene.fields.sand, [](double, double) { return 1.0; });
        scene.fill(scene.fields.sand_velocity_x, [](double x, double) { return x < 1.6 ? 30.0 : -30.0; });
        auto world = make_world(scene);
        for (int n = 0; n < 6; ++n) {
            step(*world, 1);
            const double stretch = cells_of(*world, "stretch_xx").at(15, 4);
            CHECK((clamp > 0 ? stretch < -0.3 : stretch == 0));
        }
        check_books(*world);
    }
}

TEST_CASE("cohesion cap: tough sand that spreads thins out smoothly; without it there is a checkerboard") {
    for (const double cohesion : {1e5, 1e8, 1e12}) {
        for (const double cap : {0.9, 0.0}) {
            auto scene = flat_scene(64, 64, 0.1, 0.009);
            scene.settings.method.cohesion_cap = cap;
            auto& m = scene.settings.material;
            m.friction = 0.1;
            m.young_modulus = 1e7;
            m.cohesion_dry = cohesion;
            m.bed_adhesion = 0; // it would not spread
            const auto inside = [](double x, double y) { return std::hypot(x - 3.2, y - 3.2) < 2; };
            scene.fill(scene.fields.sand, [&](double x, double y) {
                return inside(x, y) ? 0.2 + 0.004 * std::sin(57 * x + 23 * y) : 0.0; // weak spots
            });
            scene.fill(scene.fields.sand_velocity_x, [&](double x, double y) { return inside(x, y) ? 2 * (x - 3.25) : 0.0; });
            scene.fill(scene.fields.sand_velocity_y, [&](double x, double y) { return inside(x, y) ? 2 * (y - 3.25) : 0.0; });
            auto world = make_world(scene);
            step(*world, 240);
            check_books(*world);
            const double board = sand_checkerboard(*world);
            CHECK((cap > 0 ? board < 1e-3 : board > 0.1));
        }
    }
}
