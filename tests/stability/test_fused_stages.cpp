// Fused stages run several stages in one pass over tiles. Every bit must be that of the stages one by one, on every backend, for
// every level, in parts, after edits that change the effects, and across snapshots.
#include "engine/settings/data/method_presets.hpp"
#include "tests/support/worlds.hpp"
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

/// The scene on the plain CPU, its stages one by one.
std::unique_ptr<World> apart(Scene scene) {
    scene.settings.fused_stages = FusedStages::never;
    return make_world(scene);
}

/// The scene with fused stages. Null where the device cannot run them or its floats are not exact.
std::unique_ptr<World> fused(Scene scene, const std::string& backend) {
    scene.settings.active_tiles = 0; // tested by themselves
    scene.settings.fused_stages = FusedStages::automatic;
    auto world = make_world(scene, {.backend = backend, .shared_device = true});
    const auto& device = world->device().capabilities();
    if (!device.fused_stages || !device.exact_float) return nullptr;
    scene.settings.fused_stages = FusedStages::always;
    return make_world(scene, {.backend = backend, .shared_device = true});
}

} // namespace

TEST_CASE("fused stages: every level gives the bits of its stages one by one") {
    int turn = 0;
    for (const auto& name : shipped_levels()) {
        if (few_steps && turn++ % 3 != 0) continue;
        CAPTURE(name);
        const auto scene = shipped_level(name, 70, 50); // several groups along both axes, the last ones cut
        auto expected = apart(scene);
        const int steps = few_steps ? 3 : 4;
        step(*expected, steps);
        for (const auto& backend : available_backends()) {
            CAPTURE(backend);
            auto world = fused(scene, backend);
            if (!world) continue;
            CHECK(describe_plan(world->state()).find("stages fused") != std::string::npos);
            step(*world, steps);
            CHECK(hash_of(*world) == hash_of(*expected));
        }
    }
}

TEST_CASE("fused stages: the method published has none that fit and runs as it is") {
    auto scene = mixed_scene(40, 30);
    choose_method(scene.settings, "published");
    auto expected = apart(scene), world = fused(scene, "cpu");
    REQUIRE(world);
    step(*expected, 10);
    step(*world, 10);
    CHECK(hash_of(*world) == hash_of(*expected));
}

TEST_CASE("fused stages: edits that bring sand or water, steps in parts, snapshots between the two") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto scene = flat_scene(70, 50, 0.2, 0.015);
        scene.fill(scene.fields.water, [](double x, double) { return x < 5 ? 0.6 : 0.0; });
        auto expected = apart(scene), world = fused(scene, backend);
        if (!world) continue;
        step(*expected, 7); // water alone
        step(*world, 7);
        CHECK(hash_of(*world) == hash_of(*expected));
        for (auto* w : {expected.get(), world.get()}) edit_world(*w, {brush(EditLayer::sand, 6, 5, 2, 0.8)});
        step(*expected, 9); // sand as well, and both together
        for (int n = 0; n < 9; ++n)
            for (int part = 0; part < world->stepper().parts() || part == 0; ++part) REQUIRE(world->stepper().step_part());
        CHECK(world->steps() == expected->steps());
        CHECK(hash_of(*world) == hash_of(*expected));
        auto back = apart(scene), again = fused(scene, backend);
        REQUIRE(back->snapshots().load(save(*world)));
        REQUIRE(again->snapshots().load(save(*expected)));
        for (auto* w : {expected.get(), world.get(), back.get(), again.get()}) step(*w, 8);
        CHECK(hash_of(*world) == hash_of(*expected));
        CHECK(hash_of(*back) == hash_of(*expected));
        CHECK(hash_of(*again) == hash_of(*expected));
        CHECK(world->device().counters().validation_messages == 0);
    }
}

TEST_CASE("fused stages: they move less than the stages one by one") {
    for (const auto& [scene, most] : {std::pair{level_ground(mixed_scene(40, 30)), 0.6}, std::pair{mixed_scene(40, 30), 0.7}}) {
        auto expected = apart(scene), world = fused(scene, "cpu");
        REQUIRE(world);
        CHECK(world->plan().traffic_per_cell() < most * expected->plan().traffic_per_cell());
        CHECK(world->plan().least_traffic_per_cell() == expected->plan().least_traffic_per_cell());
    }
}
