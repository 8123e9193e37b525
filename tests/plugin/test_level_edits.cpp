// Edits that a level brings along: what a host's own edits of the same steps do, once, however the steps come about.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <doctest/doctest.h>
#include <string>
#include <wadi/wadi.h>

using namespace wadi::test;

namespace {

constexpr unsigned STEPS = 40;

// A strip of sand that a moving brush lays, water poured on it at once, a push, ground that a later stroke raises.
const char* const EDITS = R"(, "edits": [
    {"time": 0.1, "until": 0.3, "every": 0.05, "layer": "sand", "shape": "disc", "center": [2, 3], "move": [10, 2], "radius": 1.2, "amount": 0.2},
    {"time": 0.2, "layer": "water", "shape": "disc", "center": [4, 3], "radius": 2, "softness": 0, "amount": 0.4},
    {"time": 0.5, "until": 0.6, "every": 0.02, "kind": "push", "shape": "disc", "center": [4, 3], "radius": 1.5, "strength": 0.5, "velocity": [3, 0]},
    {"time": 0, "layer": "terrain", "shape": "capsule", "from": [1, 1], "to": [8, 1], "radius": 1, "amount": 0.5}
])";

AbiWorld site_with(const std::string& backend, const std::string& more) {
    return world_of(backend,
                    R"({"format_version": 1, "name": "site", "grid": {"nx": 24, "ny": 20, "dx": 0.5}, "dt": 0.02)" + more + "}",
                    24, 20, {}, {}, {});
}

wadi_edit disc(uint64_t step, double x, double y, double radius) {
    auto e = wadi_default_edit();
    e.step = step;
    e.x0 = x;
    e.y0 = y;
    e.radius = radius;
    return e;
}

// EDITS as calls of a host, in the order of their steps.
void queue_by_hand(const AbiWorld& world) {
    std::vector<wadi_edit> edits;
    auto ridge = disc(0, 1, 1, 1);
    ridge.capsule = 1;
    ridge.x1 = 8;
    ridge.y1 = 1;
    ridge.amount = 0.5;
    edits.push_back(ridge);
    const uint64_t steps[] = {5, 8, 10, 13, 15}; // 0.15 / 0.02 and 0.25 / 0.02 round up
    for (int n = 0; n < 5; ++n) {
        const double since = n * 0.05;
        auto sand = disc(steps[n], 2 + 10 * since, 3 + 2 * since, 1.2);
        sand.layer = WADI_LAYER_SAND;
        sand.amount = 0.2;
        edits.push_back(sand);
        if (steps[n] != 10) continue;
        auto water = disc(10, 4, 3, 2);
        water.layer = WADI_LAYER_WATER;
        water.softness = 0;
        water.amount = 0.4;
        edits.push_back(water);
    }
    for (uint64_t n = 25; n <= 30; ++n) {
        auto push = disc(n, 4, 3, 1.5);
        push.kind = WADI_EDIT_PUSH;
        push.strength = 0.5;
        push.velocity_x = 3;
        edits.push_back(push);
    }
    REQUIRE_MESSAGE(wadi_world_edit(world.id, edits.data(), static_cast<uint32_t>(edits.size())) == WADI_OK,
                    std::string(wadi_get_last_error()));
}

} // namespace

TEST_CASE("a level's edits are a host's edits of the same steps, in every bit, on every backend and in any rhythm") {
    const auto by_hand = site_with("cpu", "");
    queue_by_hand(by_hand);
    step(by_hand, STEPS);
    const auto hash = hash_of(by_hand);
    const auto bare = site_with("cpu", ""); // the control: the edits do show
    step(bare, STEPS);
    CHECK(hash_of(bare) != hash);
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        for (const unsigned at_once : {1u, 7u, STEPS}) {
            const auto world = site_with(backend, EDITS);
            for (unsigned done = 0; done < STEPS; done += at_once) step(world, std::min(at_once, STEPS - done));
            CHECK(hash_of(world) == hash);
        }
        const auto framed = site_with(backend, EDITS); // by host time, each step in parts
        auto settings = wadi_default_update_settings();
        settings.spread = 1;
        settings.max_steps_in_flight = 0;
        REQUIRE(wadi_world_set_update_settings(framed.id, &settings) == WADI_OK);
        while (steps_of(framed) < STEPS) {
            auto frame = wadi_default_frame();
            REQUIRE(wadi_world_update(framed.id, 8000000, &frame) == WADI_OK);
        }
        CHECK(hash_of(framed) == hash);
    }
}

TEST_CASE("a level's edits act ahead of a host's edits of their step") {
    const std::string level =
        R"(, "edits": [{"time": 0, "layer": "sand", "shape": "disc", "center": [5, 5], "radius": 2, "amount": 0.5}])";
    const auto world = site_with("cpu", level);
    auto dig = disc(0, 5, 5, 3);
    dig.layer = WADI_LAYER_SAND;
    dig.softness = 0;
    dig.amount = -1;
    REQUIRE(wadi_world_edit(world.id, &dig, 1) == WADI_OK);
    step(world, 1);
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    CHECK(stats.sand_in > 0.1);
    CHECK(stats.sand_out == stats.sand_in); // dug away again at once
    CHECK(stats.sand_drift_quanta == 0);
}

TEST_CASE("the command log leaves a level's edits out, and replays to the same hash") {
    const auto first = site_with("cpu", EDITS);
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    auto rain = disc(0, 6, 6, 3);
    rain.layer = WADI_LAYER_WATER;
    rain.amount = 0.1;
    for (unsigned n = 0; n < STEPS; ++n) {
        if (n % 9 == 0) REQUIRE(wadi_world_edit(first.id, &rain, 1) == WADI_OK);
        step(first, 1);
    }
    size_t size = 0;
    REQUIRE(wadi_world_get_commands(first.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> log(size);
    REQUIRE(wadi_world_get_commands(first.id, log.data(), &size) == WADI_OK);
    CHECK(size == 48 + 5 * 112); // the host's five commands
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto again = site_with(backend, EDITS);
        REQUIRE(wadi_world_play_commands(again.id, log.data(), log.size()) == WADI_OK);
        step(again, STEPS);
        CHECK(hash_of(again) == hash_of(first));
    }
    // Of a level with other edits it would not be the same: refused.
    const auto other = site_with("cpu", "");
    CHECK(wadi_world_play_commands(other.id, log.data(), log.size()) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("other settings"));
}

TEST_CASE("after going back in time a level's edits are due again, each once") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto straight = site_with(backend, EDITS);
        step(straight, 12); // sand and water are there, more is to come
        const auto early = saved(straight);
        step(straight, STEPS - 12);
        const auto hash = hash_of(straight);
        REQUIRE(wadi_world_load(straight.id, early.data(), early.size()) == WADI_OK);
        step(straight, STEPS - 12);
        CHECK(hash_of(straight) == hash);
        if (backend == "cpu") {
            const auto fresh = site_with(backend, EDITS);
            REQUIRE_MESSAGE(wadi_world_load(fresh.id, early.data(), early.size()) == WADI_OK, std::string(wadi_get_last_error()));
            step(fresh, STEPS - 12);
            CHECK(hash_of(fresh) == hash);
        }
        const auto world = site_with(backend, EDITS);
        REQUIRE(wadi_world_set_rollback(world.id, 4, 4) == WADI_OK);
        step(world, 17);
        uint64_t reached = 0;
        REQUIRE(wadi_world_roll_back(world.id, 12, &reached) == WADI_OK);
        CHECK(reached == 12); // strokes of sand fall ahead of steps 13 and 15
        step(world, STEPS - 12);
        CHECK(hash_of(world) == hash);
    }
}
