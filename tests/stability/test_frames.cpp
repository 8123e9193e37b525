// What an update submits, records and allocates, by what is asked for; and how fields published between two steps spread.
#include "tests/support/worlds.hpp"
#include <doctest/doctest.h>

using namespace wadi;

namespace {

constexpr std::uint64_t step_time = 10000000; // [ns]
constexpr int columns = 16, rows = 12;

std::unique_ptr<World> make(const std::string& backend) {
    auto scene = test::mixed_scene(columns, rows);
    scene.settings.dt = 0.01;
    return test::make_world(scene, {.backend = backend});
}

// What one update of one step adds to the device's counters, once everything was recorded.
compute::DeviceCounters cost_of_update(World& world, std::uint64_t nanoseconds = step_time) {
    Frame frame;
    std::vector<float> wait(columns * rows);
    for (int n = 0; n < 12; ++n) { // every parity with every set
        REQUIRE(world.update(step_time, frame));
        REQUIRE(world.reader().read("terrain", wait));
    }
    compute::DeviceCounters cost;
    for (int n = 0; n < 12; ++n) {
        REQUIRE(world.reader().read("terrain", wait));
        const auto before = world.device().counters();
        REQUIRE(world.update(nanoseconds, frame));
        const auto after = world.device().counters();
        cost.submits = after.submits - before.submits;
        cost.recordings += after.recordings - before.recordings;
        cost.allocations += after.allocations - before.allocations;
        cost.descriptor_writes += after.descriptor_writes - before.descriptor_writes;
    }
    return cost;
}

} // namespace

TEST_CASE("an update submits its steps, one publish, one copy, one interpolation: each only where asked for") {
    for (const auto& backend : test::available_backends()) {
        CAPTURE(backend);
        auto world = make(backend);
        const auto check = [&](std::uint64_t submits, std::uint64_t idle_submits) {
            const auto cost = cost_of_update(*world);
            CHECK(cost.submits == submits);
            CHECK(cost.recordings == 0);
            CHECK(cost.allocations == 0);
            CHECK(cost.descriptor_writes == 0);
            CHECK(cost_of_update(*world, 1).submits == idle_submits);
        };
        check(1, 0);
        REQUIRE(world->set_update_settings({.interpolate_outputs = true}));
        check(1, 0);
        REQUIRE(world->set_update_settings({}));
        REQUIRE(world->outputs().set_mask(bit(Output::foam) | bit(Output::normal)));
        check(2, 0);
        REQUIRE(world->outputs().set_host_mask(bit(Output::terrain)));
        check(3, 0);
        REQUIRE(world->set_update_settings({.interpolate_outputs = true}));
        check(4, 1);
        REQUIRE(world->outputs().set_mask(all_outputs | tiles_bit));
        check(4, 1);
        REQUIRE(world->outputs().set_mask(0));
        REQUIRE(world->outputs().set_host_mask(0));
        check(1, 0);
        CHECK(world->device().counters().validation_messages == 0); // counted with WADI_VALIDATE=1
    }
}

TEST_CASE("spread steps are submitted part by part as they fall due") {
    auto world = make("cpu");
    REQUIRE(world->set_update_settings({.spread = true}));
    const auto parts = static_cast<std::uint64_t>(world->stepper().parts());
    REQUIRE(parts == 1 + static_cast<std::uint64_t>(world->settings().method.substeps));
    const auto start = world->device().counters().submits;
    Frame frame;
    for (std::uint64_t n = 1; n < parts; ++n) {
        REQUIRE(world->update(step_time / parts + 1, frame));
        CHECK(world->device().counters().submits - start == n);
        CHECK(frame.steps == 0);
    }
    REQUIRE(world->update(step_time / parts + 1, frame));
    CHECK(world->device().counters().submits - start == parts);
    CHECK(frame.steps == 1);
}

TEST_CASE("a load in the middle of a spread step leaves the clock owing that step") {
    auto world = make("cpu");
    REQUIRE(world->set_update_settings({.spread = true}));
    std::vector<std::byte> saved(world->snapshots().bytes());
    REQUIRE(world->snapshots().save(saved));
    Frame frame;
    REQUIRE(world->update(step_time / 2, frame));
    const auto ahead = test::hash_of(*world); // finishes the step
    CHECK(world->steps() == 1);
    REQUIRE(world->snapshots().load(saved));
    CHECK(world->steps() == 0);
    REQUIRE(world->update(step_time / 2, frame));
    CHECK(frame.total_steps == 1);
    CHECK(test::hash_of(*world) == ahead);
}

TEST_CASE("outputs that cannot be had leave the old ones as they were, and a lost device is reported") {
    auto world = make("cpu");
    Frame frame;
    REQUIRE(world->outputs().set_mask(bit(Output::foam)));
    REQUIRE(world->update(step_time, frame));
    CHECK(world->outputs().published());
    REQUIRE(world->outputs().set_mask(bit(Output::foam))); // the same: nothing starts anew
    CHECK(world->outputs().published());
    world->device().inject_device_lost();
    CHECK(world->update(step_time, frame).code == Code::device_lost);
    CHECK(world->outputs().set_mask(0).code == Code::device_lost);
    CHECK(world->update(0, frame).code == Code::device_lost);
}
