// Snapshots, queries and roll-back in the middle of a step that runs in parts, and on a lost device.
#include "tests/support/worlds.hpp"
#include <doctest/doctest.h>
#include <thread>

using namespace wadi;
using namespace wadi::test;

namespace {

Status fetch(World& world, std::uint64_t ticket, std::span<std::byte> to) {
    auto status = error(Code::not_ready, "");
    while (status.code == Code::not_ready) {
        status = world.snapshots().end_save(ticket, to);
        std::this_thread::yield();
    }
    return status;
}

} // namespace

TEST_CASE("asked for in the middle of a step, a save and a query are of the end of that step") {
    auto scene = mixed_scene(40, 33);
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(scene, {backend}), whole = make_world(scene, {backend});
        step(*world, 4);
        step(*whole, 5);
        REQUIRE(world->stepper().step_part());
        const auto save_ticket = world->snapshots().begin_save();
        REQUIRE(save_ticket);
        const float xy[] = {2, 3};
        const auto query_ticket = world->queries().ask(xy);
        REQUIRE(query_ticket);
        std::vector<std::byte> bytes(*world->snapshots().saved_bytes(*save_ticket));
        // Nothing can be there before the step is whole, however long one waits.
        std::byte byte[1];
        REQUIRE(world->device().read(world->state().device().memory().front().buffer, 0, byte));
        CHECK(world->snapshots().end_save(*save_ticket, bytes).code == Code::not_ready);
        CHECK(world->snapshots().begin_save().status().code == Code::not_ready);
        CHECK(world->queries().answer(*query_ticket).status().code == Code::not_ready);
        while (world->stepper().parts_done() > 0) REQUIRE(world->stepper().step_part());
        step(*world, 3);
        REQUIRE(fetch(*world, *save_ticket, bytes));
        CHECK(bytes == save(*whole));
        auto answer = world->queries().answer(*query_ticket);
        while (!answer && answer.status().code == Code::not_ready) answer = world->queries().answer(*query_ticket);
        REQUIRE(answer);
        CHECK(answer->step == 5);
    }
}

TEST_CASE("loading and rolling back in the middle of a step end between two steps") {
    auto scene = mixed_scene(40, 33);
    auto straight = make_world(scene);
    step(*straight, 30);
    const auto expected = hash_of(*straight);
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(scene, {backend});
        step(*world, 10);
        const auto saved = save(*world);
        REQUIRE(world->roll_back().set(2, 4));
        step(*world, 5);
        for (const bool back : {true, false}) {
            CAPTURE(back);
            REQUIRE(world->stepper().step_part());
            REQUIRE(world->stepper().step_part());
            if (back) {
                const auto reached = world->roll_back().go_back(11); // completing step 16 would have given this frame up
                REQUIRE(reached);
                CHECK(*reached == 10);
            } else {
                REQUIRE(world->snapshots().load(saved));
            }
            CHECK(world->stepper().parts_done() == 0);
            step(*world, 20);
            CHECK(hash_of(*world) == expected);
        }
    }
}

TEST_CASE("steps kept before an edit brought a material can be gone back to, and the edit made again") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(flat_scene(24, 20, 0.25, 0.01), {backend});
        REQUIRE(world->roll_back().set(4, 2));
        step(*world, 2);
        Edit edit;
        edit.kind = EditKind::brush;
        edit.layer = EditLayer::water;
        edit.x0 = edit.y0 = 2.5;
        edit.radius = 1;
        edit.amount = 0.5;
        std::uint64_t hashes[2] = {};
        for (auto& hash : hashes) {
            REQUIRE(world->commands().edit({&edit, 1}));
            step(*world, 3);
            auto stats = world->reader().stats();
            REQUIRE(stats);
            hash = stats->hash;
            CHECK(stats->water_quanta > 0);
            CHECK(stats->water_quanta == stats->water_initial + stats->ledger.water_in - stats->ledger.water_out);
            REQUIRE(world->commands().edit({&edit, 1})); // waits, and is forgotten
            REQUIRE(world->roll_back().go_back(3));
            CHECK(world->steps() == 2);
            stats = world->reader().stats();
            REQUIRE(stats);
            CHECK(stats->water_quanta == 0);
            CHECK(stats->ledger.water_in == 0);
        }
        CHECK(hashes[0] == hashes[1]);
        step(*world, 1);
        auto stats = world->reader().stats();
        REQUIRE(stats);
        CHECK(stats->water_quanta == 0);
    }
}

TEST_CASE("nothing is allocated or recorded by saves, queries and roll-back after their first rounds") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(mixed_scene(16, 16), {backend});
        REQUIRE(world->roll_back().set(3, 1));
        std::vector<std::byte> bytes(world->snapshots().bytes());
        const float xy[] = {2, 3};
        const auto round = [&](int count) {
            for (int n = 0; n < count; ++n) {
                step(*world, 1);
                const auto asked = world->queries().ask(xy);
                REQUIRE(asked);
                const auto ticket = world->snapshots().begin_save();
                REQUIRE(ticket);
                REQUIRE(fetch(*world, *ticket, bytes));
                REQUIRE(world->queries().answer(*asked));
                if (n % 5 == 4) REQUIRE(world->roll_back().go_back(world->steps() - 1));
            }
        };
        round(120);
        const auto before = world->device().counters();
        round(40);
        const auto after = world->device().counters();
        CHECK(after.allocations == before.allocations);
        CHECK(after.recordings == before.recordings);
        CHECK(after.descriptor_writes == before.descriptor_writes);
    }
}

TEST_CASE("a lost device ends every call with its text, and the world remembers it") {
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(mixed_scene(16, 16), {backend});
        CHECK(world->state().lost());
        const auto saved = save(*world);
        REQUIRE(world->roll_back().set(2, 1));
        const auto save_ticket = world->snapshots().begin_save();
        const float xy[] = {1, 1};
        const auto query_ticket = world->queries().ask(xy);
        REQUIRE(save_ticket);
        REQUIRE(query_ticket);
        world->device().inject_device_lost();
        std::vector<std::byte> bytes(saved.size());
        const Code lost = Code::device_lost;
        CHECK(world->step(1).code == lost);
        CHECK(fetch(*world, *save_ticket, bytes).code == lost);
        CHECK(world->queries().answer(*query_ticket).status().code == lost);
        CHECK(world->queries().ask(xy).status().code == lost);
        CHECK(world->snapshots().begin_save().status().code == lost);
        CHECK(world->snapshots().load(saved).code == lost);
        CHECK(world->roll_back().go_back(0).status().code == lost);
        CHECK(world->roll_back().set(1, 1).code == lost);
        CHECK(world->reader().hash().status().code == lost);
        CHECK(world->state().lost().code == lost);
        CHECK_FALSE(world->state().lost().message.empty());
    }
}

TEST_CASE("a save that the worker has begun to write is finished, whatever becomes of the device or of calls that are refused") {
    auto scene = mixed_scene(300, 300);
    for (const auto& backend : available_backends()) {
        CAPTURE(backend);
        auto world = make_world(scene, {backend});
        step(*world, 2);
        const auto expected = save(*world);
        const auto ticket = world->snapshots().begin_save();
        REQUIRE(ticket);
        std::byte byte[1];
        REQUIRE(world->device().read(world->state().device().memory().front().buffer, 0, byte)); // the copies are made
        std::vector<std::byte> bytes(expected.size()), other(expected.size());
        REQUIRE(world->snapshots().end_save(*ticket, bytes).code == Code::not_ready); // the worker has them from here on
        CHECK(world->snapshots().end_save(*ticket, std::span(bytes).first(8)).code == Code::bad_argument);
        CHECK(world->snapshots().end_save(*ticket, other).code == Code::bad_argument);
        world->device().inject_device_lost();
        REQUIRE(world->step(1).code == Code::device_lost);
        CHECK(fetch(*world, *ticket, bytes));
        CHECK(bytes == expected);
        CHECK(other == std::vector<std::byte>(expected.size()));
    }
}
