// Queries: linear fields come back exactly, batches overlap, the same bits on every backend, bad input is refused.
#include "tests/plugin/abi_worlds.hpp"
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <thread>

using namespace wadi::test;

namespace {

std::vector<wadi_query_result> answers(const AbiWorld& world, uint64_t ticket, uint64_t* step = nullptr) {
    uint32_t count = 0;
    wadi_result result = WADI_NOT_READY;
    while (result == WADI_NOT_READY) {
        result = wadi_world_get_query(world.id, ticket, nullptr, 0, &count, step);
        std::this_thread::yield();
    }
    REQUIRE_MESSAGE(result == WADI_OK, std::string(wadi_get_last_error()));
    std::vector<wadi_query_result> results(count);
    REQUIRE(wadi_world_get_query(world.id, ticket, results.data(), count, nullptr, nullptr) == WADI_OK);
    return results;
}

uint64_t ask(const AbiWorld& world, const std::vector<float>& xy) {
    uint64_t ticket = 0;
    REQUIRE_MESSAGE(wadi_world_query(world.id, xy.data(), static_cast<uint32_t>(xy.size() / 2), &ticket) == WADI_OK,
                    std::string(wadi_get_last_error()));
    return ticket;
}

// x and y across the whole of a world of that size and a little beyond.
std::vector<float> lattice(int n, double size) {
    std::vector<float> xy;
    for (int k = 0; k < n; ++k) {
        xy.push_back(static_cast<float>(size * (1.1 * std::fmod(0.7548776662 * k, 1.0) - 0.05)));
        xy.push_back(static_cast<float>(size * (1.1 * std::fmod(0.5698402910 * k, 1.0) - 0.05)));
    }
    return xy;
}

} // namespace

TEST_CASE("a sloping ground under a level pond: heights, depth, normal and inside as drawn") {
    // Ground rising 1 in 4 to the east, water level 1 over its lower half, sand 0.5 deep in the north.
    const int n = 32;
    std::vector<float> terrain, sand, water;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const float ground = 0.25F * 0.5F * (static_cast<float>(i) + 0.5F), bed = j >= 16 ? 0.5F : 0.0F;
            terrain.push_back(ground);
            sand.push_back(bed);
            water.push_back(std::max(0.0F, 2 - ground));
        }
    }
    const std::string json = R"({"format_version": 1, "name": "slope", "dt": 0.01, "grid": {"nx": 32, "ny": 32, "dx": 0.5}})";
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = world_of(backend, json, n, n, terrain, sand, water);
        uint64_t step = 99;
        const auto r =
            answers(world, ask(world, {3.1F, 2.3F, 3.1F, 13.3F, 15.0F, 2.0F, -0.1F, 4, 5, 16.2F, 0, 0, 16, 16}), &step);
        REQUIRE(r.size() == 7);
        CHECK(step == 0);
        CHECK(r[0].inside == 1);
        CHECK(r[0].terrain == doctest::Approx(0.775));
        CHECK(r[0].sand_depth == 0);
        CHECK(r[0].surface == doctest::Approx(2));
        CHECK(r[0].water_depth == doctest::Approx(2 - 0.775));
        CHECK(r[0].normal[2] == doctest::Approx(1));
        CHECK(r[0].saturation == 0);
        CHECK(r[1].sand_depth == doctest::Approx(0.5));
        CHECK(r[1].water_depth == doctest::Approx(2 - 0.775 - 0.5));
        CHECK(r[1].saturation == doctest::Approx(1.225 / 1.725));
        CHECK(r[2].water_depth == 0);
        CHECK(r[2].surface == doctest::Approx(3.75));
        CHECK(r[2].normal[0] == doctest::Approx(-0.25 / std::sqrt(1 + 0.0625)));
        CHECK(r[2].normal[1] == 0);
        CHECK(r[2].normal[2] == doctest::Approx(1 / std::sqrt(1 + 0.0625)));
        const wadi_query_result nothing{};
        CHECK(std::memcmp(&r[3], &nothing, sizeof nothing) == 0);
        CHECK(std::memcmp(&r[4], &nothing, sizeof nothing) == 0);
        CHECK(r[5].inside == 1);
        CHECK(r[5].terrain == terrain[0]); // the outer half cell repeats the outermost
        CHECK(r[6].inside == 1);
    }
}

TEST_CASE("the velocity is that of the faces, in between and on them") {
    const std::string json = R"({"format_version": 1, "name": "flow", "dt": 0.01, "grid": {"nx": 16, "ny": 8, "dx": 0.5}})";
    auto world = world_of("cpu", json, 16, 8, {}, {}, [] {
        std::vector<float> water(16 * 8, 1.0F);
        for (std::size_t c = 0; c < water.size(); ++c) water[c] = c % 16 < 8 ? 2.0F : 1.0F;
        return water;
    }());
    step(world, 20);
    std::vector<float> u(16 * 8);
    REQUIRE(wadi_world_read_field(world.id, WADI_FIELD_WATER_VELOCITY_X, u.data(), u.size()) == WADI_OK);
    std::vector<float> xy;
    for (int k = 0; k < 16; ++k) xy.insert(xy.end(), {0.5F * static_cast<float>(k) + 0.25F, 1.75F});
    const auto r = answers(world, ask(world, xy));
    bool moves = false;
    for (std::size_t k = 0; k < 16; ++k) {
        CHECK(r[k].velocity[0] == doctest::Approx(u[3 * 16 + k])); // read at cell centres: the mean of both faces
        moves |= r[k].velocity[0] > 0.1F;
    }
    CHECK(moves);
}

TEST_CASE("answers are the same bits on every backend, whatever the batch, and stamped with their step") {
    const auto many = lattice(3000, 10);
    auto reference = mixed_world("cpu", 40);
    step(reference, 12);
    const auto expected = answers(reference, ask(reference, many));
    int inside = 0;
    for (const auto& r : expected) inside += r.inside;
    CHECK(inside > 2000);
    CHECK(inside < 3000);
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = mixed_world(backend, 40);
        // Small batches first, so that the room grows; all in flight together, the world stepping on meanwhile.
        std::vector<uint64_t> tickets;
        for (unsigned n = 0; n < 4; ++n) {
            tickets.push_back(ask(world, lattice(10, 10)));
            step(world, 3);
        }
        const auto last = ask(world, many);
        step(world, 5);
        for (std::size_t n = 0; n < tickets.size(); ++n) {
            uint64_t at = 0;
            CHECK(answers(world, tickets[n], &at).size() == 10);
            CHECK(at == 3 * n);
        }
        uint64_t at = 0;
        const auto got = answers(world, last, &at);
        CHECK(at == 12);
        REQUIRE(got.size() == expected.size());
        CHECK(std::memcmp(got.data(), expected.data(), got.size() * sizeof got[0]) == 0);
        // After the state changed parity and place.
        const auto bytes = saved(reference);
        REQUIRE(wadi_world_load(world.id, bytes.data(), bytes.size()) == WADI_OK);
        const auto again = answers(world, ask(world, many), &at);
        CHECK(at == 12);
        CHECK(std::memcmp(again.data(), expected.data(), again.size() * sizeof again[0]) == 0);
    }
}

TEST_CASE("eight batches are kept; a ninth gives up the first; a full list of batches says so") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        auto world = mixed_world(backend, 128);
        std::vector<uint64_t> tickets;
        for (int n = 0; n < 8; ++n) tickets.push_back(ask(world, {1, 1}));
        for (const auto ticket : tickets) CHECK(answers(world, ticket).size() == 1);
        step(world, 30); // keeps the device busy
        unsigned taken = 0;
        wadi_result result = WADI_OK;
        const float xy[] = {1, 1};
        uint64_t ticket = 0;
        while (taken < 20 && (result = wadi_world_query(world.id, xy, 1, &ticket)) == WADI_OK) ++taken;
        CHECK(taken == 8);
        CHECK(result == WADI_NOT_READY);
        CHECK(error_mentions("8 batches"));
        CHECK(wadi_world_get_query(world.id, ticket, nullptr, 0, nullptr, nullptr) == WADI_NOT_READY);
        CHECK(answers(world, ticket).size() == 1);
        CHECK(wadi_world_get_query(world.id, tickets[0], nullptr, 0, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("gave way"));
        CHECK(ask(world, {1, 1}) == ticket + 1);
    }
}

TEST_CASE("bad queries are refused and change nothing") {
    auto world = pond("cpu", 8, 8, 1, 1);
    const auto hash = hash_of(world);
    uint64_t ticket = 7;
    const float good[] = {1, 2, 3, 4};
    CHECK(wadi_world_query(world.id, nullptr, 2, &ticket) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_query(world.id, good, 2, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_query(world.id, good, 0, &ticket) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("65536"));
    CHECK(wadi_world_query(world.id, good, 65537, &ticket) == WADI_ERROR_BAD_ARGUMENT);
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        const float xy[] = {1, 2, 3, bad};
        CHECK(wadi_world_query(world.id, xy, 2, &ticket) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("point 1"));
    }
    CHECK(ticket == 7);
    for (const uint64_t unknown : {0, 1, 8, 100})
        CHECK(wadi_world_get_query(world.id, unknown, nullptr, 0, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    const float far = std::numeric_limits<float>::max();
    ticket = ask(world, {far, -far, 1, 1});
    const auto r = answers(world, ticket);
    CHECK(r[0].inside == 0);
    CHECK(r[1].inside == 1);
    wadi_query_result one{};
    CHECK(wadi_world_get_query(world.id, ticket, &one, 1, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("2 points"));
    CHECK(hash_of(world) == hash);
}

TEST_CASE("a thousand points: the longest call on the host's thread") {
    for (const auto& backend : abi_backends()) {
        auto world = mixed_world(backend, 256);
        const auto xy = lattice(1000, 64);
        for (int n = 0; n < 8; ++n) answers(world, ask(world, xy)); // allocates, records
        step(world, 1);
        for (int n = 0; n < 8; ++n) answers(world, ask(world, xy)); // records for the other parity
        double least = 1e9;
        for (int n = 0; n < 8; ++n) {
            const auto start = std::chrono::steady_clock::now();
            const auto ticket = ask(world, xy);
            least = std::min(least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
            answers(world, ticket);
        }
        std::printf("%s: asking at 1000 points takes the host %.1f us\n", backend.c_str(), least);
        CHECK(least < 1000);
    }
}
