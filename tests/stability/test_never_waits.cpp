// What a game calls every frame does not wait for the device: not after a promotion or a change of the material either, when
// programs are recorded anew.
#include "engine/settings/rules/material_keys.hpp"
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

void wait_until_done(World& world) {
    std::byte byte[1];
    REQUIRE(world.device().read(world.state().device().memory().front().buffer, 0, byte));
}

/// How many steps are work for 100 milliseconds, 24 at most: a software device takes that long for one.
int steps_of_some_work(World& world) {
    wait_until_done(world);
    const auto begin = std::chrono::steady_clock::now();
    step(world, 2);
    wait_until_done(world);
    const auto seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 2;
    return static_cast<int>(std::clamp(std::ceil(0.1 / seconds), 2.0, 24.0));
}

/// Its last ticket.
compute::Ticket queue_steps(World& world, int steps) {
    step(world, steps);
    return world.stepper().ticket();
}

void ask_points(World& world, int times) {
    const float xy[] = {3, 3, 5, 5};
    for (int n = 0; n < times; ++n) {
        const auto ticket = world.queries().ask(xy);
        REQUIRE_MESSAGE(ticket, ticket.status().message);
    }
}

void fetch_save(World& world, std::uint64_t ticket) {
    std::vector<std::byte> bytes(*world.snapshots().saved_bytes(ticket));
    while (world.snapshots().end_save(ticket, bytes).code == Code::not_ready) wait_until_done(world);
}

} // namespace

TEST_CASE("queries, saves, changes of the material and promotions do not wait for steps that were asked for") {
    for (const auto& backend : available_backends()) {
        auto scene = mixed_scene(256, 256);
        scene.fields.water.clear();
        scene.settings.sources.clear();
        compute::DeviceOptions options;
        options.threads = 1;
        auto world = make_world(scene, {backend, options});
        REQUIRE(world->stepper().prepare()); // compilers of drivers are not meant here
        ask_points(*world, 8);
        fetch_save(*world, *world->snapshots().begin_save());
        edit_world(*world, {brush(EditLayer::sand, 3, 3, 2, 0.1)});
        step(*world, 2);
        const int work = steps_of_some_work(*world);
        for (const std::string moment : {"at rest", "material", "promotion"}) {
            CAPTURE(backend);
            CAPTURE(moment);
            wait_until_done(*world);
            auto last = queue_steps(*world, work);
            if (moment == "material") {
                const int key = find_material_key("cohesion_dry");
                REQUIRE(world->commands().set_material(key, 0.5 * material_value(world->settings().material, key) + 1));
            } else if (moment == "promotion") {
                const auto before = world->plan().effects;
                edit_world(*world, {brush(EditLayer::water, 3, 3, 2, 0.5)});
                step(*world, 1);
                CHECK(world->plan().effects != before);
            }
            CHECK_FALSE(world->device().finished(last));
            // Where a stage meets new effects its first query has it compiled.
            ask_points(*world, 1);
            wait_until_done(*world);
            last = queue_steps(*world, work);
            ask_points(*world, 7);
            const auto save = world->snapshots().begin_save();
            REQUIRE(save);
            CHECK_FALSE(world->device().finished(last));
            fetch_save(*world, *save); // waits
            CHECK(world->device().finished(last));
        }
    }
}
