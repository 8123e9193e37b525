// Edits, regions and the command log through the C ABI: what a host may ask for, what it may not, and the same hash again.
#include "tests/plugin/abi_worlds.hpp"
#include <chrono>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <string>
#include <vector>
#include <wadi/wadi.h>

namespace {

std::string last_error() { return wadi_get_last_error(); }

// The settings of the site, with more entries.
std::string with(const char* more) {
    std::string text = R"({"format_version": 1, "name": "site", "grid": {"nx": 24, "ny": 20, "dx": 0.5}, "dt": 0.02)";
    text += more;
    text += "}";
    return text;
}

struct Site {
    wadi_world_id id{};
    explicit Site(const char* backend = "cpu", const std::string& level = with("")) {
        auto options = wadi_default_device_options();
        options.backend = backend;
        std::vector<float> terrain;
        for (int n = 0; n < 24 * 20; ++n)
            terrain.push_back(static_cast<float>(1 + 0.3 * std::sin(0.4 * (n % 24)) * std::cos(0.02 * n)));
        auto arrays = wadi_default_world_arrays();
        arrays.settings_json = level.c_str();
        arrays.nx = 24;
        arrays.ny = 20;
        arrays.terrain = terrain.data();
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, last_error());
    }
    ~Site() { wadi_destroy_world(id); }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    uint64_t hash() const {
        uint64_t value = 0;
        REQUIRE(wadi_world_get_hash(id, &value) == WADI_OK);
        return value;
    }
    wadi_world_stats stats() const {
        auto s = wadi_default_world_stats();
        REQUIRE(wadi_world_get_stats(id, &s) == WADI_OK);
        return s;
    }
    void step(uint32_t count) const { REQUIRE_MESSAGE(wadi_world_step(id, count) == WADI_OK, last_error()); }
    void edit(const wadi_edit& e) const { REQUIRE_MESSAGE(wadi_world_edit(id, &e, 1) == WADI_OK, last_error()); }
    std::vector<unsigned char> commands() const {
        size_t size = 0;
        REQUIRE(wadi_world_get_commands(id, nullptr, &size) == WADI_OK);
        std::vector<unsigned char> bytes(size);
        REQUIRE(wadi_world_get_commands(id, bytes.data(), &size) == WADI_OK);
        return bytes;
    }
};

wadi_edit brush(wadi_layer layer, double x, double y, double amount) {
    auto e = wadi_default_edit();
    e.layer = layer;
    e.x0 = x;
    e.y0 = y;
    e.radius = 2;
    e.amount = amount;
    return e;
}

wadi_region region(int i0, int j0, int nx, int ny) { return {i0, j0, nx, ny}; }

// A session of 41 steps with every kind of command in it.
void session(const Site& world) {
    std::mt19937 random(5);
    const float image[6] = {0, 1, 0.5F, 0.25F, -1, 1};
    uint32_t stamp = 0;
    REQUIRE(wadi_world_create_stamp(world.id, 3, 2, image, &stamp) == WADI_OK);
    const auto r = region(3, 4, 5, 6);
    std::vector<float> values(30, 0.25F);
    for (int n = 0; n < 40; ++n) {
        auto e = brush(static_cast<wadi_layer>(random() % 3), static_cast<double>(random() % 12),
                       static_cast<double>(random() % 10), 0.2);
        if (n % 5 == 1) {
            e.kind = WADI_EDIT_STAMP;
            e.x1 = e.x0 + 4;
            e.y1 = e.y0 + 3;
            e.stamp = stamp;
        }
        if (n % 7 == 3) {
            e.kind = WADI_EDIT_PUSH;
            e.velocity_x = 2;
        }
        if (n % 3 == 0) e.step = static_cast<uint64_t>(n) + 4;
        world.edit(e);
        if (n == 12) REQUIRE(wadi_world_write_region(world.id, WADI_FIELD_TOTAL_WATER_DEPTH, &r, values.data(), 30) == WADI_OK);
        if (n == 20) {
            auto dry = brush(WADI_LAYER_SAND, 6, 5, -10);
            dry.radius = 50;
            world.edit(dry);
        }
        world.step(1);
        if (n == 20) REQUIRE(wadi_world_trim(world.id) == WADI_OK);
    }
    auto dry = brush(WADI_LAYER_SAND, 6, 5, -10);
    dry.radius = 50;
    world.edit(dry);
    world.step(1);
    REQUIRE(wadi_world_write_region(world.id, WADI_FIELD_TERRAIN, &r, values.data(), 30) == WADI_OK);
    REQUIRE(wadi_world_trim(world.id) == WADI_OK); // leaves a world without sand: it shows in the hash
}

} // namespace

TEST_CASE("a command log replays to the same hash on every backend, in steps of any number") {
    const Site first;
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    session(first);
    const auto hash = first.hash();
    const auto log = first.commands();
    CHECK(log.size() > 40 * 100);
    for (const auto& name : wadi::test::abi_backends()) {
        const char* const backend = name.c_str();
        for (const uint32_t at_once : {1u, 7u, 41u}) {
            const Site again(backend);
            REQUIRE_MESSAGE(wadi_world_play_commands(again.id, log.data(), log.size()) == WADI_OK, last_error());
            for (uint32_t done = 0; done < 41; done += at_once) again.step(std::min(at_once, 41 - done));
            CHECK(again.hash() == hash);
            CHECK(again.stats().water_drift_quanta == 0);
            CHECK(again.stats().sand_drift_quanta == 0);
        }
        const Site live(backend); // and so does the session itself
        REQUIRE(wadi_world_set_command_log(live.id, 1) == WADI_OK);
        session(live);
        CHECK(live.hash() == hash);
        CHECK(live.commands() == log);
    }
}

TEST_CASE("a log that was played is remembered as if it had been called") {
    const Site first;
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    session(first);
    const auto log = first.commands();
    const Site second;
    REQUIRE(wadi_world_set_command_log(second.id, 1) == WADI_OK);
    REQUIRE(wadi_world_play_commands(second.id, log.data(), log.size()) == WADI_OK);
    CHECK(second.commands() == log); // before any of it has run
    second.step(41);
    const auto copy = second.commands();
    CHECK(copy == log);
    const Site third;
    REQUIRE(wadi_world_play_commands(third.id, copy.data(), copy.size()) == WADI_OK);
    third.step(41);
    CHECK(third.hash() == first.hash());
}

TEST_CASE("edits of one step act by rising player, whoever was queued first, on every backend") {
    auto dig = brush(WADI_LAYER_SAND, 6, 5, -1.5), heap = brush(WADI_LAYER_SAND, 6, 5, 0.5);
    dig.step = heap.step = 3;
    const auto run = [&](const char* backend, bool dig_first) {
        const Site world(backend);
        world.edit(dig_first ? dig : heap);
        world.edit(dig_first ? heap : dig);
        world.step(6);
        return world.hash();
    };
    CHECK(run("cpu", true) != run("cpu", false)); // control: without players the order of the calls decides
    dig.player = 2;
    heap.player = 1;
    const auto hash = run("cpu", false);
    for (const auto& backend : wadi::test::abi_backends()) {
        CAPTURE(backend);
        CHECK(run(backend.c_str(), true) == hash);
        CHECK(run(backend.c_str(), false) == hash);
    }
    dig.player = 0; // now it comes first
    CHECK(run("cpu", false) != hash);
    CHECK(run("cpu", false) == run("cpu", true));
    // Edits of one player keep the order of the calls, also those of a log.
    const Site first, again;
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    for (auto e : {heap, dig, heap, dig}) {
        e.player = 4294967295;
        first.edit(e);
    }
    const auto log = first.commands();
    REQUIRE(wadi_world_play_commands(again.id, log.data(), log.size()) == WADI_OK);
    first.step(6);
    again.step(6);
    CHECK(first.hash() == again.hash());
    heap.player = uint64_t{1} << 32;
    CHECK(wadi_world_edit(first.id, &heap, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(last_error().find("player: 4294967296 is outside 0 ... 4294967295") != std::string::npos);
}

TEST_CASE("commands since a step are those of later ones and of the player asked for, with the stamps that they use") {
    const auto since = [](const Site& world, uint64_t step, uint64_t player) {
        size_t size = 0;
        REQUIRE(wadi_world_get_commands_since(world.id, step, player, nullptr, &size) == WADI_OK);
        std::vector<unsigned char> bytes(size);
        REQUIRE(wadi_world_get_commands_since(world.id, step, player, bytes.data(), &size) == WADI_OK);
        return bytes;
    };
    const Site first, second;
    for (const Site* each : {&first, &second}) REQUIRE(wadi_world_set_command_log(each->id, 1) == WADI_OK);
    std::vector<float> large(4096, 0.5F);
    uint32_t unused = 0, stamp = 0;
    REQUIRE(wadi_world_create_stamp(first.id, 64, 64, large.data(), &unused) == WADI_OK);
    const float image[2] = {0.5F, 0.25F};
    REQUIRE(wadi_world_create_stamp(first.id, 2, 1, image, &stamp) == WADI_OK);
    const auto queue = [&](const Site& world, uint64_t player, uint64_t step) {
        auto e = brush(WADI_LAYER_SAND, 4 + static_cast<double>(player), 5, 0.3);
        e.player = player;
        e.step = step;
        if (player == 1) {
            e.kind = WADI_EDIT_STAMP;
            e.x1 = e.x0 + 2;
            e.y1 = e.y0 + 2;
            e.stamp = stamp;
        }
        world.edit(e);
    };
    for (uint64_t turn = 1; turn <= 4; ++turn) { // two players, turns of 5 steps
        queue(first, 1, 5 * turn);
        queue(second, 2, 5 * turn);
        const auto of_first = since(first, 5 * turn, 1), of_second = since(second, 5 * turn, 2);
        CHECK(of_first.size() < 500); // not the large stamp
        REQUIRE_MESSAGE(wadi_world_play_commands(first.id, of_second.data(), of_second.size()) == WADI_OK, last_error());
        REQUIRE_MESSAGE(wadi_world_play_commands(second.id, of_first.data(), of_first.size()) == WADI_OK, last_error());
        first.step(5);
        second.step(5);
    }
    first.step(1);
    second.step(1);
    CHECK(first.hash() == second.hash());
    CHECK(first.stats().sand_in > 2);
    uint32_t next = 0; // four logs with one stamp made one
    REQUIRE(wadi_world_create_stamp(second.id, 2, 1, image, &next) == WADI_OK);
    CHECK(next == 2);
    CHECK(since(first, 0, WADI_EVERY_PLAYER).size() < first.commands().size());
    CHECK(since(first, 0, 1).size() < since(first, 0, WADI_EVERY_PLAYER).size());
    CHECK(since(first, 16, WADI_EVERY_PLAYER).size() < since(first, 15, WADI_EVERY_PLAYER).size());
    CHECK(since(first, 21, WADI_EVERY_PLAYER).size() == since(first, 0, 3).size()); // none
    size_t size = 10;
    std::vector<unsigned char> small(10);
    CHECK(wadi_world_get_commands_since(first.id, 0, 1, small.data(), &size) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(size == since(first, 0, 1).size());
    CHECK(wadi_world_get_commands_since(first.id, 0, uint64_t{1} << 32, nullptr, &size) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_get_commands_since(first.id, 0, 1, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
}

TEST_CASE("going back drops what waits and what the log has of later steps") {
    const Site world;
    REQUIRE(wadi_world_set_command_log(world.id, 1) == WADI_OK);
    world.edit(brush(WADI_LAYER_WATER, 5, 5, 0.4));
    world.step(5);
    size_t size = 0;
    REQUIRE(wadi_world_save(world.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> saved(size);
    REQUIRE(wadi_world_save(world.id, saved.data(), &size) == WADI_OK);
    const auto then = world.commands();
    auto later = brush(WADI_LAYER_SAND, 5, 5, 0.4);
    world.edit(later);
    later.step = 9;
    world.edit(later);
    world.step(2);
    REQUIRE(wadi_world_load(world.id, saved.data(), saved.size()) == WADI_OK);
    CHECK(world.commands() == then);
    world.step(10);
    CHECK(world.stats().sand_in == 0);
    const Site replay;
    REQUIRE(wadi_world_play_commands(replay.id, then.data(), then.size()) == WADI_OK);
    replay.step(15);
    CHECK(replay.stats().water_in == world.stats().water_in);
}

TEST_CASE("a log with any byte changed, cut off, of a newer version or of another level is refused, the world unchanged") {
    const Site first;
    REQUIRE(wadi_world_set_command_log(first.id, 1) == WADI_OK);
    const float image[2] = {0, 1};
    uint32_t stamp = 0;
    REQUIRE(wadi_world_create_stamp(first.id, 2, 1, image, &stamp) == WADI_OK);
    first.edit(brush(WADI_LAYER_WATER, 5, 5, 0.4));
    const auto r = region(1, 1, 2, 1);
    const float values[2] = {0.5F, 0.25F};
    REQUIRE(wadi_world_write_region(first.id, WADI_FIELD_SAND_DEPTH, &r, values, 2) == WADI_OK);
    REQUIRE(wadi_world_trim(first.id) == WADI_OK);
    const auto log = first.commands();
    const Site world;
    world.edit(brush(WADI_LAYER_TERRAIN, 5, 5, 0.4));
    world.step(1);
    world.step(1);
    const Site twin;
    twin.edit(brush(WADI_LAYER_TERRAIN, 5, 5, 0.4));
    twin.step(2);
    for (size_t at = 0; at < log.size(); ++at) {
        for (const int bit : {0, 3, 7}) {
            auto bad = log;
            bad[at] = static_cast<unsigned char>(bad[at] ^ (1 << bit));
            CHECK_MESSAGE(wadi_world_play_commands(world.id, bad.data(), bad.size()) == WADI_ERROR_BAD_FILE, std::to_string(at));
        }
    }
    for (size_t size = 0; size < log.size(); ++size)
        CHECK(wadi_world_play_commands(world.id, log.data(), size) == WADI_ERROR_BAD_FILE);
    auto newer = log;
    newer[8] = 255;
    CHECK(wadi_world_play_commands(world.id, newer.data(), newer.size()) == WADI_ERROR_BAD_FILE);
    CHECK(last_error().find("newer") != std::string::npos);
    CHECK(wadi_world_play_commands(world.id, nullptr, 8) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_play_commands(world.id, log.data(), log.size()) == WADI_ERROR_BAD_ARGUMENT); // its steps are over
    CHECK(last_error().find("next step is 2") != std::string::npos);
    const Site other("cpu", with(R"(, "gravity": 1.62)"));
    CHECK(wadi_world_play_commands(other.id, log.data(), log.size()) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(last_error().find("other settings") != std::string::npos);
    world.step(5);
    twin.step(5);
    CHECK(world.hash() == twin.hash());
    size_t size = 10;
    std::vector<unsigned char> small(10);
    CHECK(wadi_world_get_commands(first.id, small.data(), &size) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(size == log.size());
    CHECK(wadi_world_get_commands(first.id, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    REQUIRE(wadi_world_set_command_log(first.id, 0) == WADI_OK);
    CHECK(first.commands().size() < log.size());
}

TEST_CASE("bad edits and regions get a code and a text and change nothing") {
    const Site world("cpu", with(R"(, "effects": {"sand": "off"})"));
    const Site twin("cpu", with(R"(, "effects": {"sand": "off"})"));
    const auto refused = [&](auto change, const char* text) {
        wadi_edit edits[2] = {brush(WADI_LAYER_WATER, 5, 5, 0.3), brush(WADI_LAYER_WATER, 5, 5, 0.3)};
        change(edits[1]);
        CHECK(wadi_world_edit(world.id, edits, 2) == WADI_ERROR_BAD_ARGUMENT);
        CHECK_MESSAGE(last_error().find(std::string("edits[1].") + text) != std::string::npos, last_error());
    };
    refused([](wadi_edit& e) { e.struct_size = 8; }, "struct_size");
    refused([](wadi_edit& e) { e.kind = static_cast<wadi_edit_kind>(3); }, "kind: 3");
    refused([](wadi_edit& e) { e.kind = static_cast<wadi_edit_kind>(-1); }, "kind: -1");
    refused([](wadi_edit& e) { e.layer = static_cast<wadi_layer>(77); }, "layer: 77");
    refused([](wadi_edit& e) { e.layer = WADI_LAYER_SAND; }, "layer: effects.sand");
    refused([](wadi_edit& e) { e.x0 = std::nan(""); }, "x0");
    refused([](wadi_edit& e) { e.radius = -2; }, "radius");
    refused([](wadi_edit& e) { e.amount = INFINITY; }, "amount");
    refused([](wadi_edit& e) { e.kind = WADI_EDIT_STAMP, e.x1 = e.y1 = 9; }, "stamp: 0");
    CHECK(wadi_world_edit(world.id, nullptr, 1) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_edit(world.id, nullptr, 0) == WADI_OK);
    auto removal = brush(WADI_LAYER_SAND, 5, 5, -1); // takes nothing where there is none
    CHECK(wadi_world_edit(world.id, &removal, 1) == WADI_OK);
    uint32_t stamp = 0;
    const float image[1] = {1};
    CHECK(wadi_world_create_stamp(world.id, 1, 1, nullptr, &stamp) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_create_stamp(world.id, 1, 1, image, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_create_stamp(world.id, -1, 1, image, &stamp) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_create_stamp(world.id, 1, 4097, image, &stamp) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(last_error().find("ny") != std::string::npos);
    std::vector<float> values(6, 0.5F);
    const auto r = region(1, 2, 3, 2);
    CHECK(wadi_world_write_region(world.id, WADI_FIELD_SAND_DEPTH, &r, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(last_error().find("effects.sand") != std::string::npos);
    CHECK(wadi_world_write_region(world.id, WADI_FIELD_SATURATION, &r, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_write_region(world.id, WADI_FIELD_TERRAIN, nullptr, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_write_region(world.id, WADI_FIELD_TERRAIN, &r, nullptr, 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_write_region(world.id, WADI_FIELD_TERRAIN, &r, values.data(), 5) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_read_region(world.id, WADI_FIELD_TERRAIN, &r, values.data(), 5) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_read_region(world.id, WADI_FIELD_TERRAIN, nullptr, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_read_region(world.id, WADI_FIELD_COUNT, &r, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    const auto outside = region(22, 2, 3, 2);
    CHECK(wadi_world_read_region(world.id, WADI_FIELD_TERRAIN, &outside, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(last_error().find("24 x 20") != std::string::npos);
    world.step(3);
    twin.step(3);
    CHECK(world.hash() == twin.hash());
    size_t size = 0;
    for (const auto id : {wadi_world_id{0, 0}, wadi_world_id{1000, 1}}) {
        CHECK(wadi_world_edit(id, nullptr, 0) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_trim(id) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_create_stamp(id, 1, 1, image, &stamp) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_read_region(id, WADI_FIELD_TERRAIN, &r, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_write_region(id, WADI_FIELD_TERRAIN, &r, values.data(), 6) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_set_command_log(id, 1) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_get_commands(id, nullptr, &size) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_play_commands(id, image, 4) == WADI_ERROR_BAD_ARGUMENT);
    }
}

TEST_CASE("a region read back is the field's part, and promotion shows in the effects") {
    for (const auto& name : wadi::test::abi_backends()) {
        const char* const backend = name.c_str();
        const Site world(backend);
        auto info = wadi_default_world_info();
        REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
        CHECK(info.passes_per_water_step == 0);
        world.edit(brush(WADI_LAYER_WATER, 5, 5, 0.4));
        world.step(4);
        REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
        CHECK(info.passes_per_water_step == 4);
        std::vector<float> all(24 * 20), part(7 * 9);
        const auto r = region(4, 6, 7, 9);
        for (int field = 0; field < WADI_FIELD_COUNT; ++field) {
            REQUIRE(wadi_world_read_field(world.id, static_cast<wadi_field>(field), all.data(), all.size()) == WADI_OK);
            REQUIRE(wadi_world_read_region(world.id, static_cast<wadi_field>(field), &r, part.data(), part.size()) == WADI_OK);
            for (size_t j = 0; j < 9; ++j)
                for (size_t i = 0; i < 7; ++i) CHECK(part[j * 7 + i] == all[(j + 6) * 24 + i + 4]);
        }
    }
}

TEST_CASE("edits queued in falling order of their steps take no longer than n log n, and those of one step keep their order") {
    const Site falling("cpu"), rising("cpu");
    constexpr uint64_t count = 60000;
    std::vector<wadi_edit> edits;
    for (uint64_t n = 0; n < count; ++n) {
        // Two of each step, which do not commute: what takes water away ends at dry ground.
        auto edit = brush(WADI_LAYER_WATER, 2 + static_cast<double>(n % 7), 5, n % 2 == 0 ? 0.05 : -0.04);
        edit.step = 1 + n / 2;
        edits.push_back(edit);
    }
    const auto seconds_of = [](const auto& call) {
        const auto start = std::chrono::steady_clock::now();
        call();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const double in_order = seconds_of([&] { REQUIRE(wadi_world_edit(rising.id, edits.data(), count) == WADI_OK); });
    std::vector<wadi_edit> backwards;
    for (uint64_t n = count; n > 0; n -= 2) backwards.insert(backwards.end(), {edits[n - 2], edits[n - 1]});
    const double in_reverse = seconds_of([&] { REQUIRE(wadi_world_edit(falling.id, backwards.data(), count) == WADI_OK); });
    CHECK(in_reverse < 5 * in_order + 1); // inserting into a sorted list: 5 s and more
    rising.step(8);
    falling.step(8);
    CHECK(rising.hash() == falling.hash());
    const Site swapped("cpu");
    for (uint64_t n = 0; n < 16; n += 2) std::swap(edits[n], edits[n + 1]);
    REQUIRE(wadi_world_edit(swapped.id, edits.data(), 16) == WADI_OK);
    swapped.step(8);
    CHECK(swapped.hash() != rising.hash());
}
