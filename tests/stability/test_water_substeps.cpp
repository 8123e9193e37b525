// method.water_substeps: the water's passes of a step run N times, each of dt/N, ahead of the sand's. Water alone gets every bit
// of so many shorter steps; whatever way a step is run, its bits are the same; and what is inside the sand does not outrun the
// step.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

/// At x [m], dry at `end` [s].
Source spring(double x, double end) {
    Source source;
    source.shape = SourceShape::disc;
    source.center = {x, 3};
    source.radius = 0.8;
    source.rate.samples = {{0, 0.05}, {end, 0}};
    return source;
}

/// Water alone that all inputs reach: a source and rain that change in time, a discharge, waves, an outflow, a held level.
Scene poured_on(int order) {
    auto scene = flat_scene(40, 24, 0.25, 1.0 / 64);
    scene.settings.material.manning = 0.02;
    scene.settings.method.water_transport_order = order;
    scene.fill(scene.fields.terrain, [](double x, double y) { return 0.3 + 0.02 * x + 0.1 * std::sin(x + y); });
    scene.fill(scene.fields.water, [](double x, double) { return x < 3 ? 0.7 : 0.0; });
    scene.settings.sources = {spring(6, 0.4)};
    scene.settings.rain.samples = {{0, 0}, {0.3, 0.002}};
    auto& sides = scene.settings.sides;
    sides[SIDE_NORTH].kind = SideKind::discharge;
    sides[SIDE_NORTH].value.samples = {{0, 0}, {0.5, 0.4}};
    sides[SIDE_SOUTH].kind = SideKind::outflow;
    sides[SIDE_WEST].kind = SideKind::waves;
    sides[SIDE_WEST].value.samples = {{0, 0.9}};
    sides[SIDE_WEST].wave.samples = {{0, 0}, {0.3, 0.1}, {0.6, -0.1}};
    sides[SIDE_EAST].kind = SideKind::level;
    sides[SIDE_EAST].value.samples = {{0, 0.9}, {1, 0.7}};
    return scene;
}

/// Everything meets, with a source and an open side; the water's N is 3.
Scene mixed() {
    auto scene = mixed_scene(70, 40);
    scene.settings.method.water_substeps = 3;
    scene.settings.sources = {spring(3, 0.2)};
    scene.settings.sides[SIDE_EAST].kind = SideKind::outflow;
    return scene;
}

std::vector<float> heights(World& world) { return cells_of(world, "water_height").values; }

} // namespace

TEST_CASE("water substeps: water alone has the bits of as many shorter steps, books included") {
    for (const int order : {1, 2}) {
        const auto scene = poured_on(order);
        auto shorter = scene, fewer = scene;
        shorter.settings.dt /= 4;
        const auto expected = make_world(shorter);
        step(*expected, 4 * 50);
        fewer.settings.method.water_substeps = 2; // negative control
        const auto other = make_world(fewer);
        step(*other, 50);
        CHECK(heights(*other) != heights(*expected));
        for (const auto& backend : available_backends()) {
            CAPTURE(order);
            CAPTURE(backend);
            auto quarters = scene;
            quarters.settings.method.water_substeps = 4;
            const auto world = make_world(quarters, {.backend = backend, .shared_device = true});
            if (!world->device().capabilities().exact_float) continue;
            step(*world, 50);
            CHECK(hash_of(*world) == hash_of(*expected));
            const auto stats = stats_of(*world), wanted = stats_of(*expected);
            CHECK(stats.ledger.water_in == wanted.ledger.water_in);
            CHECK(stats.ledger.water_out == wanted.ledger.water_out);
        }
    }
}

TEST_CASE("water substeps: the same bits on every backend, fused, over tiles, in parts, by one thread and after a load") {
    const auto scene = mixed();
    const auto expected = make_world(scene);
    CHECK(describe_plan(expected->state()).find("on run 3 times") != std::string::npos);
    step(*expected, 16);
    const auto hash = hash_of(*expected);
    auto once = scene;
    once.settings.method.water_substeps = 1; // negative control
    const auto other = make_world(once);
    step(*other, 16);
    CHECK(hash_of(*other) != hash);
    for (const auto& backend : available_backends()) {
        for (const bool fused : {false, true}) {
            for (const int tiles : {0, 8}) {
                // A software device compiles stages for minutes: there the plainest way and the one with most in it.
                if (backend != "cpu" && fused != (tiles > 0)) continue;
                CAPTURE(backend);
                CAPTURE(fused);
                CAPTURE(tiles);
                auto way = scene;
                way.settings.active_tiles = tiles;
                way.settings.fused_stages = FusedStages::never;
                auto world = make_world(way, {.backend = backend, .shared_device = true});
                const auto& device = world->device().capabilities();
                if (!device.exact_float || (fused && !device.fused_stages)) continue;
                if (fused) {
                    way.settings.fused_stages = FusedStages::always;
                    world = make_world(way, {.backend = backend, .shared_device = true});
                }
                step(*world, 8);
                const auto saved = save(*world);
                for (int n = 0; n < 8; ++n) {
                    do REQUIRE(world->stepper().step_part());
                    while (world->stepper().parts_done() > 0);
                }
                CHECK(hash_of(*world) == hash);
                REQUIRE(world->snapshots().load(saved));
                step(*world, 8);
                CHECK(hash_of(*world) == hash);
            }
        }
    }
    compute::DeviceOptions alone;
    alone.threads = 1;
    const auto single = make_world(scene, {.options = alone});
    step(*single, 16);
    CHECK(hash_of(*single) == hash);
}

TEST_CASE("water substeps: a step with N of them is N + T parts and one submission") {
    const auto world = make_world(mixed());
    const auto submits = [&] { return world->device().counters().submits; };
    auto before = submits();
    step(*world, 16);
    CHECK(submits() - before == 16);
    CHECK(world->stepper().parts() == 3 + world->settings().method.substeps);
    before = submits();
    do REQUIRE(world->stepper().step_part());
    while (world->stepper().parts_done() > 0);
    CHECK(submits() - before == static_cast<std::uint64_t>(world->stepper().parts()));
}

TEST_CASE("water substeps: water of 8 m falls onto dry ground past the clamp of the whole step, and as of as many steps") {
    auto scene = flat_scene(96, 12, 0.5, 0.045);
    scene.settings.method.largest_height = 16;
    scene.fill(scene.fields.water, [](double x, double) { return x < 20 ? 8.0 : 0.0; });
    const auto held = make_world(scene);
    step(*held, 30);
    CHECK(stats_of(*held).limits.water.clamped_faces > 0); // negative control
    scene.settings.method.water_substeps = 5;
    const auto free = make_world(scene);
    step(*free, 30);
    CHECK(stats_of(*free).limits.water.clamped_faces == 0);
    CHECK(stats_of(*free).limits.water.capped_faces == 0);
    CHECK(largest(cells_of(*free, "water_velocity_x")) > 2 * scene.settings.method.velocity_clamp * 0.5 / 0.045);
}

TEST_CASE("water substeps: waves in drenched sand without drag, faster than the step, stay smooth") {
    auto scene = flat_scene(40, 40, 0.5, 0.06);
    scene.settings.material.exchange_rate = 0;
    scene.settings.material.retention = 0;
    scene.settings.method.water_substeps = 5;
    scene.fill(scene.fields.sand, [](double, double) { return 6.0; });
    scene.fill(scene.fields.water, [](double x, double y) { return std::hypot(x - 10, y - 10) < 4 ? 5.5 : 5.0; });
    on_every_backend(scene, [](World& world) { CHECK(worst(world, 200, 10, water_checkerboard) < 1e-4); });
}
