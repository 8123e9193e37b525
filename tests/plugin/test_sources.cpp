// Sources that a host adds, moves, opens and closes while the world runs: the bits of a level that has them, replay, saves,
// roll-back, and what is refused.
#include "tests/plugin/abi_worlds.hpp"
#include <doctest/doctest.h>

namespace source_tests {

using namespace wadi::test;

namespace {

constexpr int nx = 40, ny = 32;

// A slope of dry ground with a heap of sand, cells of 0.25 m, with more entries.
AbiWorld slope(const std::string& backend, const std::string& more = "", bool with_sand = true) {
    std::vector<float> terrain, sand;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            terrain.push_back(0.02F * static_cast<float>(i + j));
            sand.push_back(with_sand && i > 20 && i < 30 && j > 5 && j < 20 ? 0.5F : 0.0F);
        }
    return world_of(backend,
                    "{'format_version': 1, 'name': 'slope', 'grid': {'nx': 40, 'ny': 32, 'dx': 0.25}, 'dt': 0.01" + more + "}",
                    nx, ny, terrain, sand, {});
}

struct Tap {
    wadi_source source = wadi_default_source();
    std::vector<wadi_sample> flow;
    explicit Tap(double x, double y, std::vector<wadi_sample> samples) : flow(std::move(samples)) {
        source.center[0] = x;
        source.center[1] = y;
    }
    void set(const AbiWorld& world, uint32_t index, uint64_t step = 0) {
        source.rate = flow.data();
        source.rate_count = static_cast<uint32_t>(flow.size());
        source.step = step;
        REQUIRE_MESSAGE(wadi_world_set_source(world.id, index, &source) == WADI_OK, std::string(wadi_get_last_error()));
    }
};

wadi_world_stats stats_of(const AbiWorld& world) {
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    return stats;
}

uint64_t sources_of(const AbiWorld& world) {
    auto info = wadi_default_world_info();
    REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
    return info.source_count;
}

constexpr uint32_t session_steps = 40;

// A tap that comes, moves, changes its flow, is joined by sand from a box, and closes.
void session(const AbiWorld& world) {
    Tap tap(3, 2, {{0, 0.5}});
    tap.set(world, 0, 5);
    step(world, 8);
    tap.source.center[0] = 6;
    tap.source.set_velocity = 1;
    tap.source.velocity[1] = 1;
    tap.set(world, 0); // ahead of step 8
    Tap belt(0, 0, {{0, 0.1}, {0.3, 0.3}});
    belt.source.shape = WADI_SOURCE_BOX;
    belt.source.sand = 1;
    belt.source.from[0] = 1, belt.source.from[1] = 4, belt.source.to[0] = 2, belt.source.to[1] = 6;
    belt.set(world, 2, 15); // 1 comes along, closed
    step(world, 12);
    tap.flow = {{0.2, 1}, {0.25, 0}};
    tap.set(world, 0);
    step(world, 1);
    belt.flow = {{0, 0}};
    belt.set(world, 2, 30);
    step(world, 19);
}

} // namespace

TEST_CASE("a source that a host adds ahead of the first step gives the bits of a level that has it, on every backend") {
    struct Row {
        const char* json;
        wadi_source source;
        std::vector<wadi_sample> rate, discharge, level;
    };
    std::vector<Row> rows;
    const auto add = [&](const char* json) -> Row& {
        rows.push_back({json, wadi_default_source(), {}, {}, {}});
        return rows.back();
    };
    Row& disc = add("{'shape': 'disc', 'center': [4, 3], 'radius': 0.8, 'material': 'water', 'rate': [[0, 0.5], [0.2, 0]], "
                    "'velocity': [1, -0.5]}");
    disc.source.center[0] = 4, disc.source.center[1] = 3, disc.source.radius = 0.8, disc.source.set_velocity = 1;
    disc.source.velocity[0] = 1, disc.source.velocity[1] = -0.5;
    disc.rate = {{0, 0.5}, {0.2, 0}};
    Row& box = add("{'shape': 'box', 'from': [2, 2], 'to': [4, 5], 'material': 'sand', 'discharge': 2}");
    box.source.shape = WADI_SOURCE_BOX, box.source.sand = 1;
    box.source.from[0] = 2, box.source.from[1] = 2, box.source.to[0] = 4, box.source.to[1] = 5;
    box.discharge = {{0, 2}};
    Row& point = add("{'shape': 'point', 'center': [1, 1], 'material': 'water', 'level': [[0, 0.4], [0.3, 0.2]], 'drain': true, "
                     "'rate': 4}");
    point.source.shape = WADI_SOURCE_POINT, point.source.center[0] = 1, point.source.center[1] = 1, point.source.drain = 1;
    point.level = {{0, 0.4}, {0.3, 0.2}};
    point.rate = {{0, 4}};
    for (auto& row : rows) {
        row.source.rate = row.rate.data(), row.source.rate_count = static_cast<uint32_t>(row.rate.size());
        row.source.discharge = row.discharge.data(), row.source.discharge_count = static_cast<uint32_t>(row.discharge.size());
        row.source.level = row.level.data(), row.source.level_count = static_cast<uint32_t>(row.level.size());
        CAPTURE(row.json);
        const auto level = slope("cpu", std::string(", 'sources': [") + row.json + "]");
        step(level, session_steps);
        const uint64_t hash = hash_of(level);
        const auto idle = slope("cpu");
        step(idle, session_steps);
        CHECK(hash_of(idle) != hash); // control: the source does something
        for (const auto& backend : abi_backends()) {
            CAPTURE(backend);
            const auto world = slope(backend);
            REQUIRE_MESSAGE(wadi_world_set_source(world.id, 0, &row.source) == WADI_OK, std::string(wadi_get_last_error()));
            CHECK(sources_of(world) == 0); // it waits for its step
            step(world, session_steps);
            CHECK(sources_of(world) == 1);
            CHECK(hash_of(world) == hash);
            CHECK(stats_of(world).water_drift_quanta == 0);
            CHECK(stats_of(world).sand_drift_quanta == 0);
        }
        auto found = wadi_default_source();
        REQUIRE(wadi_world_get_source(level.id, 0, &found) == WADI_OK);
        CHECK(found.shape == row.source.shape);
        CHECK(found.sand == row.source.sand);
        CHECK(found.drain == row.source.drain);
        CHECK(found.rate_count == row.source.rate_count);
        CHECK(found.discharge_count == row.source.discharge_count);
        REQUIRE(found.level_count == row.source.level_count);
        if (found.level_count > 0) CHECK(found.level[1].value == row.level[1].value);
    }
}

TEST_CASE("sources that come, move and close replay to the same hash on every backend, in steps of any number") {
    const auto first = slope("cpu");
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    session(first);
    const uint64_t hash = hash_of(first);
    CHECK(sources_of(first) == 3);
    CHECK(stats_of(first).water_in > 0.3);
    CHECK(stats_of(first).sand_in > 0.05);
    const auto log = log_of(first);
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        for (const uint32_t at_once : {1u, 7u, session_steps}) {
            CAPTURE(at_once);
            const auto again = slope(backend);
            REQUIRE_MESSAGE(wadi_world_play_commands(again.id, log.data(), log.size()) == WADI_OK,
                            std::string(wadi_get_last_error()));
            for (uint32_t done = 0; done < session_steps; done += at_once) step(again, std::min(at_once, session_steps - done));
            CHECK(hash_of(again) == hash);
            CHECK(stats_of(again).water_drift_quanta == 0);
        }
        const auto live = slope(backend, ", 'active_tiles': 8");
        session(live);
        CHECK(hash_of(live) == hash);
    }
}

TEST_CASE("snapshots hold the sources of their moment and bring them to a world of the same level, as going back does") {
    const auto first = slope("cpu", ", 'sources': [{'shape': 'point', 'center': [1, 1], 'material': 'water', 'rate': 0.1}]");
    Tap tap(6, 5, {{0, 0.5}});
    tap.set(first, 0);
    step(first, 10);
    const auto saved_then = saved(first);
    REQUIRE(wadi_world_set_rollback(first.id, 4, 5) == WADI_OK);
    step(first, 10);
    const uint64_t hash = hash_of(first);
    tap.flow = {{0, 0}};
    tap.set(first, 0);
    tap.source.center[0] = 2;
    tap.flow = {{0, 1}};
    tap.set(first, 1);
    step(first, 5);
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto other =
            slope(backend, ", 'sources': [{'shape': 'point', 'center': [1, 1], 'material': 'water', 'rate': 0.1}]");
        step(other, 3);
        REQUIRE_MESSAGE(wadi_world_load(other.id, saved_then.data(), saved_then.size()) == WADI_OK,
                        std::string(wadi_get_last_error()));
        auto found = wadi_default_source();
        REQUIRE(wadi_world_get_source(other.id, 0, &found) == WADI_OK);
        CHECK(found.center[0] == 6);
        step(other, 10);
        CHECK(hash_of(other) == hash);
    }
    uint64_t reached = 0;
    REQUIRE(wadi_world_roll_back(first.id, 10, &reached) == WADI_OK);
    CHECK(reached == 10);
    CHECK(sources_of(first) == 1);
    CHECK(saved(first) == saved_then);
    step(first, 10);
    CHECK(hash_of(first) == hash);
    // Beside the host's thread, with a changed source.
    uint64_t ticket = 0;
    REQUIRE(wadi_world_begin_save(first.id, &ticket) == WADI_OK);
    std::vector<unsigned char> beside(saved(first).size());
    size_t size = beside.size();
    wadi_result result = WADI_NOT_READY;
    while (result == WADI_NOT_READY) result = wadi_world_end_save(first.id, ticket, beside.data(), &size);
    REQUIRE(result == WADI_OK);
    CHECK(beside == saved(first));
}

TEST_CASE("what a source brought stays when it closes, and drops no effect") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto world = slope(backend,
                                 ", 'sources': [{'shape': 'disc', 'center': [4, 4], 'radius': 1, 'material': 'water', "
                                 "'rate': 0.5}]",
                                 false);
        step(world, 10);
        const double water = stats_of(world).water_volume;
        CHECK(water > 0.1);
        Tap closed(4, 4, {{0, 0}});
        closed.set(world, 0);
        step(world, 10);
        CHECK(stats_of(world).water_volume == water);
        CHECK(stats_of(world).water_drift_quanta == 0);
    }
}

TEST_CASE("sources of two players in one step: the higher one's holds, whoever was queued first") {
    uint64_t hashes[2];
    for (const bool swapped : {false, true}) {
        const auto world = slope("cpu");
        Tap a(3, 3, {{0, 0.5}}), b(7, 4, {{0, 0.2}});
        a.source.player = 1;
        b.source.player = 2;
        (swapped ? b : a).set(world, 0, 4);
        (swapped ? a : b).set(world, 0, 4);
        step(world, 10);
        hashes[swapped ? 1 : 0] = hash_of(world);
        auto found = wadi_default_source();
        REQUIRE(wadi_world_get_source(world.id, 0, &found) == WADI_OK);
        CHECK(found.center[0] == 7);
    }
    CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("sources that cannot be are refused by field, and change nothing") {
    const auto world = slope("cpu");
    const auto refused = [&](uint32_t index, const wadi_source& source, const char* text) {
        CHECK(wadi_world_set_source(world.id, index, &source) == WADI_ERROR_BAD_ARGUMENT);
        CHECK_MESSAGE(error_mentions(text), std::string(wadi_get_last_error()));
    };
    const wadi_sample one{0, 1}, falling[] = {{1, 0}, {0.5, 0}}, fast{0, 1e9};
    auto good = wadi_default_source();
    good.center[0] = good.center[1] = 4;
    good.rate = &one;
    good.rate_count = 1;
    refused(32, good, "index: 32 is outside 0 ... 31");
    const auto with = [&](auto change) {
        auto bad = good;
        change(bad);
        return bad;
    };
    refused(0, with([](auto& s) { s.shape = static_cast<wadi_source_shape>(3); }), "source.shape: 3");
    refused(0, with([](auto& s) { s.sand = 2; }), "source.sand: 2");
    refused(0, with([](auto& s) { s.radius = 0; }), "source.radius: 0");
    refused(0, with([](auto& s) { s.center[0] = 99; }), "outside the grid");
    refused(0, with([](auto& s) { s.rate_count = 0; }), "source.rate: missing");
    refused(0, with([](auto& s) { s.rate = nullptr; }), "source.rate is NULL");
    refused(0, with([](auto& s) { s.rate_count = 5000; }), "source.rate_count: 5000 is outside 0 ... 4096");
    refused(0, with([&](auto& s) { s.rate = falling, s.rate_count = 2; }), "does not come after");
    refused(0, with([&](auto& s) { s.rate = &fast; }), "source.rate: 1e+09 is outside");
    refused(0, with([&](auto& s) { s.discharge = &one, s.discharge_count = 1; }), "only one of rate and discharge");
    refused(0, with([](auto& s) { s.drain = 1; }), "source.drain");
    refused(0, with([](auto& s) { s.player = uint64_t{1} << 32; }), "player: 4294967296 is outside 0 ... 4294967295");
    step(world, 3);
    refused(0, with([](auto& s) { s.step = 2; }), "source.step: 2 has been simulated");
    auto found = wadi_default_source();
    CHECK(wadi_world_get_source(world.id, 0, &found) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("the world has 0 sources"));
    CHECK(wadi_world_get_source(world.id, 0, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    const auto dry = slope("cpu", ", 'effects': {'water': 'off'}");
    CHECK(wadi_world_set_source(dry.id, 0, &good) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("effects.water is forced off"));
    const auto none = slope("cpu", ", 'effects': {'sources': 'off'}");
    CHECK(wadi_world_set_source(none.id, 0, &good) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("effects.sources is forced off"));
    const auto twin = slope("cpu");
    step(twin, 13);
    step(world, 10);
    CHECK(hash_of(world) == hash_of(twin));
}

} // namespace source_tests
