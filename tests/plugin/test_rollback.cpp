// Earlier states: going back and on again gives the same bits, memory is counted and given back.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <map>

using namespace wadi::test;

namespace {

std::vector<uint64_t> kept_steps(const AbiWorld& world) {
    uint32_t count = 0;
    REQUIRE(wadi_world_get_rollback_steps(world.id, nullptr, &count) == WADI_OK);
    std::vector<uint64_t> steps(count);
    REQUIRE(wadi_world_get_rollback_steps(world.id, steps.data(), &count) == WADI_OK);
    return steps;
}

using Steps = std::vector<uint64_t>;

// Depths of a cone off the middle, so that something moves at once.
std::vector<float> heap(int nx, int ny) {
    std::vector<float> depths;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
            depths.push_back(
                std::max(0.0F, 1.0F - 0.15F * std::hypot(static_cast<float>(i - nx / 3), static_cast<float>(j - ny / 2))));
    return depths;
}

} // namespace

TEST_CASE("rolled back and stepped again: the same hash at every step, the ledger included") {
    std::map<uint64_t, uint64_t> hashes;
    auto straight = mixed_world("cpu", 32);
    for (uint64_t n = 0; n <= 40; ++n) {
        hashes[n] = hash_of(straight);
        step(straight, 1);
    }
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = mixed_world(backend, 32);
        step(world, 3);
        REQUIRE(wadi_world_set_rollback(world.id, 4, 5) == WADI_OK);
        CHECK(kept_steps(world) == Steps{3});
        step(world, 9);
        CHECK(kept_steps(world) == Steps{3, 5, 10});
        step(world, 15);
        CHECK(kept_steps(world) == Steps{10, 15, 20, 25});
        uint64_t reached = 99;
        CHECK(wadi_world_roll_back(world.id, 9, &reached) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("the oldest is 10"));
        CHECK(reached == 99);
        CHECK(hash_of(world) == hashes[27]);
        REQUIRE(wadi_world_roll_back(world.id, 19, &reached) == WADI_OK);
        CHECK(reached == 15);
        CHECK(steps_of(world) == 15);
        CHECK(kept_steps(world) == Steps{10, 15});
        for (uint64_t n = 15; n < 38; ++n) {
            CHECK(hash_of(world) == hashes[n]);
            step(world, 1);
        }
        REQUIRE(wadi_world_roll_back(world.id, 1000, nullptr) == WADI_OK);
        CHECK(hash_of(world) == hashes[35]);
        auto stats = wadi_default_world_stats();
        REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
        CHECK(stats.water_drift_quanta == 0);
        CHECK(stats.sand_drift_quanta == 0);
        CHECK(stats.water_in > 0);
        // A load begins another past.
        const auto bytes = saved(straight);
        REQUIRE(wadi_world_load(world.id, bytes.data(), bytes.size()) == WADI_OK);
        CHECK(kept_steps(world) == Steps{41});
    }
}

TEST_CASE("frames cost memory while they are kept, and bad arguments change nothing") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = mixed_world(backend, 16);
        step(world, 2);
        const auto hash = hash_of(world), bytes = device_bytes(world.id);
        uint64_t reached = 0;
        CHECK(wadi_world_roll_back(world.id, 2, &reached) == WADI_ERROR_BAD_ARGUMENT);
        REQUIRE(wadi_world_set_rollback(world.id, 2, 1) == WADI_OK);
        const auto two = device_bytes(world.id);
        REQUIRE(wadi_world_set_rollback(world.id, 4, 1) == WADI_OK);
        CHECK(device_bytes(world.id) - bytes == 2 * (two - bytes));
        CHECK(two > bytes);
        CHECK(wadi_world_set_rollback(world.id, 4, 0) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("interval_steps is 0"));
        CHECK(wadi_world_set_rollback(world.id, 257, 1) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("256"));
        CHECK(wadi_world_get_rollback_steps(world.id, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(kept_steps(world) == Steps{2});
        CHECK(hash_of(world) == hash);
        REQUIRE(wadi_world_set_rollback(world.id, 0, 0) == WADI_OK);
        CHECK(device_bytes(world.id) == bytes);
        CHECK(kept_steps(world).empty());
        step(world, 3);
        CHECK(kept_steps(world).empty());
    }
}

TEST_CASE("rolled back to before a material appeared, the same edit gives the same hashes again") {
    for (const auto& backend : abi_backends()) {
        for (const auto layer : {WADI_LAYER_SAND, WADI_LAYER_WATER}) {
            CAPTURE(backend);
            CAPTURE(static_cast<int>(layer));
            // Sand first or water first, then the other.
            const bool sandy = layer == WADI_LAYER_WATER;
            const auto world =
                world_of(backend, R"({"format_version": 1, "name": "roll", "grid": {"nx": 24, "ny": 20, "dx": 0.25},
                                                     "dt": 0.01, "material": {"exchange_rate": 3e4}})",
                         24, 20, {}, sandy ? heap(24, 20) : std::vector<float>(), sandy ? std::vector<float>() : heap(24, 20));
            REQUIRE(wadi_world_set_rollback(world.id, 4, 5) == WADI_OK);
            auto edit = wadi_default_edit();
            edit.layer = layer;
            edit.x0 = 3;
            edit.y0 = 2.5;
            edit.amount = 0.4;
            std::vector<uint64_t> hashes[2];
            for (auto& seen : hashes) {
                step(world, 8 - static_cast<unsigned>(steps_of(world)));
                REQUIRE(wadi_world_edit(world.id, &edit, 1) == WADI_OK);
                for (int n = 0; n < 9; ++n) {
                    step(world, 1);
                    seen.push_back(hash_of(world));
                }
                REQUIRE(wadi_world_roll_back(world.id, 5, nullptr) == WADI_OK);
            }
            CHECK(hashes[0] == hashes[1]);
            CHECK(hashes[0].front() != hashes[0].back());
        }
    }
}
