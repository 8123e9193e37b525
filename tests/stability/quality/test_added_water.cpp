// What rain and a discharge bring: all of it, on time, with the momentum that it has.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

TEST_CASE("a discharge arrives on time to one quantum a face however small it is, and so does rain") {
    for (const double discharge : {0.0005, 0.02, 3.0}) {
        auto scene = flat_scene(20, 20, 1, 0.01);
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, discharge}}}};
        on_every_backend(scene, [&](World& world) {
            step(world, 500);
            const double wanted = discharge * 5, got = total(cells_of(world, "water_height"));
            const double quantum = height_quantum(world.settings().method);
            MESSAGE("discharge " << discharge << ": " << got << " m3 of " << wanted);
            CHECK(std::abs(got - wanted) <= 20 * quantum * 1.01);
        });
    }
    auto scene = flat_scene(20, 20, 1, 0.01);
    scene.settings.rain = {{{0, 1e-7}}};
    auto world = make_world(scene);
    step(*world, 5000);
    CHECK(std::abs(total(cells_of(*world, "water_height")) - 400 * 5e-6) <= 400 * height_quantum(scene.settings.method));
}

TEST_CASE("rain brings no velocity: a stream that it falls on keeps its momentum") {
    for (const int order : {1, 2}) {
        auto scene = flat_scene(200, 1, 0.5, 0.02);
        scene.settings.method.water_transport_order = order;
        scene.settings.rain = {{{0, 0.1}}};
        scene.fill(scene.fields.water, [](double, double) { return 1; });
        scene.fill(scene.fields.velocity_x, [](double, double) { return 1; });
        auto world = make_world(scene);
        step(*world, 200); // 0.4 m; what the ends do has run 20 m
        const double h = cells_of(*world, "water_height").at(100, 0), u = cells_of(*world, "water_velocity_x").at(100, 0);
        MESSAGE("order " << order << ": momentum " << h * u << " m2/s");
        CHECK(std::abs(h - 1.4) < 1e-3);
        CHECK(std::abs(h * u - 1) < 0.01);
    }
}

TEST_CASE("a film that brings less than a quantum a step is as deep as Manning's law says, and all of it arrives") {
    const auto over_manning = [](double dt) {
        const double q = 1e-5, slope = 0.05, manning = 0.03;
        auto scene = flat_scene(20, 1, 1, dt);
        scene.settings.material.manning = manning;
        scene.fill(scene.fields.terrain, [=](double x, double) { return slope * (20 - x); });
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, q}}}};
        scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        auto world = make_world(scene);
        step(*world, static_cast<int>(2000 / dt));
        const auto before = stats_of(*world);
        step(*world, static_cast<int>(500 / dt));
        const auto after = stats_of(*world);
        const double out = double(after.ledger.water_out - before.ledger.water_out) * after.quantum / 500; // m2/s
        const double depth = static_cast<double>(cells_of(*world, "water_height").at(10, 0));
        const double ratio = depth / std::pow(manning * q / std::sqrt(slope), 0.6);
        MESSAGE("dt " << dt << ": " << ratio << " of Manning's depth, " << out / q << " of the flow leaves");
        CHECK(std::abs(out / q - 1) < 0.05);
        return ratio;
    };
    for (const double dt : {0.01, 0.05, 0.2}) CHECK(std::abs(over_manning(dt) - 1) < 0.03); // 0.1, 0.5, 2.1 quanta a step
}

TEST_CASE("a discharge with a depth below critical comes in that deep and fast; without it, critical") {
    const auto middle = [](double depth) {
        auto scene = flat_scene(100, 1, 0.1, 0.005);
        scene.settings.sides[SIDE_WEST] = {SideKind::discharge, 0, 1e30, {{{0, 0.9 * 0.1}}}, depth};
        scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
        auto world = make_world(scene);
        step(*world, 3000);
        const auto h = cells_of(*world, "water_height");
        MESSAGE("depth " << depth << ": " << h.at(2, 0) << ", " << h.at(50, 0));
        return h.at(50, 0);
    };
    CHECK(std::abs(middle(0.25) - 0.25) < 0.005); // 3.6 m/s, Froude 2.3
    CHECK(middle(0) > 0.35);                      // critical: 0.435
}
