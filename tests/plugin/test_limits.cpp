// Limits at work are told while a world runs: counted the same everywhere, once in the log, with a dt that ends them; and looking
// for them changes nothing.
#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <cstdio>
#include <doctest/doctest.h>
#include <string>
#include <tuple>
#include <vector>

using namespace wadi::test;

namespace {

struct LimitLog {
    std::vector<std::string> warnings;
    const std::string* with(const std::string& text) const {
        const auto found =
            std::find_if(warnings.begin(), warnings.end(), [&](const auto& w) { return w.find(text) != std::string::npos; });
        return found != warnings.end() ? &*found : nullptr;
    }
    std::ptrdiff_t count(const std::string& text) const {
        return std::count_if(warnings.begin(), warnings.end(), [&](const auto& w) { return w.find(text) != std::string::npos; });
    }
};

void hear_limits(void* user, wadi_log_level severity, const char* message) {
    if (severity == WADI_LOG_WARNING) static_cast<LimitLog*>(user)->warnings.emplace_back(message);
}

constexpr const char* held_at_clamp = "water is held at velocity_clamp";
constexpr const char* gravity_capped = "gravity of water is capped";

struct ChutePlace {
    std::string backend = "cpu";
    bool mirrored = false;
};

// 3 m2/s run down a plane of 1 in 4 that ends in a pool; the bed's friction would let them run at 7 m/s and more.
AbiWorld chute(double dt, LimitLog* heard, const ChutePlace& place = {}) {
    const int nx = 96, ny = 20;
    std::vector<float> terrain, water;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const int at = place.mirrored ? nx - 1 - i : i;
            terrain.push_back(at < 72 ? 0.125F * static_cast<float>(72 - at) : 0.0F);
            water.push_back(at >= 72 ? 1.0F : 0.0F);
        }
    const std::string x = place.mirrored ? R"([44, 0], "to": [46, 10])" : R"([2, 0], "to": [4, 10])";
    const std::string settings = R"({"format_version": 1, "name": "chute", "grid": {"nx": 96, "ny": 20, "dx": 0.5}, "dt": )" +
                                 std::to_string(dt) + R"(, "material": {"bed_friction": 0.03},
        "sources": [{"shape": "box", "from": )" +
                                 x + R"(, "material": "water", "rate": 1.5}]})";
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json = settings.c_str();
    arrays.nx = nx;
    arrays.ny = ny;
    arrays.terrain = terrain.data();
    arrays.water = water.data();
    auto options = wadi_default_device_options();
    options.backend = place.backend.c_str();
    if (heard != nullptr) {
        options.log = hear_limits;
        options.log_user = heard;
    }
    wadi_world_id world{};
    REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &world) == WADI_OK, std::string(wadi_get_last_error()));
    return AbiWorld(world);
}

wadi_world_stats limit_stats(const AbiWorld& world) {
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    return stats;
}

auto limit_counts(const wadi_world_stats& s) {
    return std::tuple{s.clamped_faces, s.capped_faces,        s.limited_cells,      s.high_columns,       s.wet_faces,
                      s.sand_faces,    s.clamped_water_faces, s.capped_water_faces, s.limited_water_cells};
}

/// Which guards hold each cell.
std::vector<int> held_cells(const AbiWorld& world) {
    std::vector<float> values(96 * 20);
    REQUIRE(wadi_world_read_field(world.id, WADI_FIELD_LIMITS, values.data(), values.size()) == WADI_OK);
    return {values.begin(), values.end()};
}

void run_chute(const AbiWorld& world, double seconds, double dt) {
    REQUIRE(wadi_world_step(world.id, static_cast<uint32_t>(seconds / dt + 0.5)) == WADI_OK);
}

} // namespace

TEST_CASE("water that the clamp holds is told once, with a dt at which nothing is") {
    LimitLog heard;
    const double dt = 0.05;
    const auto world = chute(dt, &heard);
    heard.warnings.clear(); // advice on the level
    run_chute(world, 8, dt);
    const auto stats = limit_stats(world);
    REQUIRE(heard.with(held_at_clamp) != nullptr);
    CHECK(heard.count(held_at_clamp) == 1);
    CHECK(stats.clamped_water_faces > stats.wet_faces / 50);
    CHECK(stats.clamped_water_faces == stats.clamped_faces);
    CHECK(stats.unlimited_dt < dt);
    const std::string& told = *heard.with(held_at_clamp);
    CHECK(told.starts_with("t = "));
    double end = 0;
    REQUIRE(std::sscanf(told.c_str() + told.find("dt <= "), "dt <= %lf", &end) == 1);
    CHECK(end < dt);
    CHECK(end > dt / 8);
    run_chute(world, 8, dt);
    CHECK(heard.count(held_at_clamp) == 1);

    LimitLog quiet;
    const auto other = chute(end, &quiet);
    quiet.warnings.clear();
    run_chute(other, 8, end);
    CHECK(limit_stats(other).clamped_faces == 0);
    CHECK(limit_stats(other).largest_water_speed > stats.largest_water_speed * 1.05);
    CHECK(quiet.warnings.empty());
}

TEST_CASE("a frame has the newest look where the host has a log, and none where it has not") {
    for (const bool asks : {false, true}) {
        CAPTURE(asks);
        LimitLog heard;
        const auto world = chute(0.05, asks ? &heard : nullptr);
        auto settings = wadi_default_update_settings();
        settings.max_steps_per_update = 1024;
        settings.max_steps_in_flight = 0;
        REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
        auto frame = wadi_default_frame();
        REQUIRE(wadi_world_update(world.id, 10000000, &frame) == WADI_OK);
        CHECK(frame.limits_step == UINT64_MAX);
        for (int n = 0; n < 40; ++n) {
            REQUIRE(wadi_world_update(world.id, 200000000, &frame) == WADI_OK);
            std::vector<float> one(1);
            const wadi_region cell = {0, 0, 1, 1};
            REQUIRE(wadi_world_read_region(world.id, WADI_FIELD_TERRAIN, &cell, one.data(), 1) == WADI_OK); // the device is done
        }
        CHECK((frame.limits_step == UINT64_MAX) == !asks);
        uint32_t items = 0;
        REQUIRE(wadi_world_get_memory(world.id, nullptr, &items) == WADI_OK);
        std::vector<wadi_memory_item> memory(items);
        REQUIRE(wadi_world_get_memory(world.id, memory.data(), &items) == WADI_OK);
        CHECK(std::any_of(memory.begin(), memory.end(),
                          [](const auto& item) { return std::string(item.label).starts_with("limits"); }) == asks);
        if (!asks) continue;
        CHECK(frame.limits_step % 64 == 0);
        CHECK(frame.limits_step >= frame.total_steps - 64);
        CHECK(frame.clamped_water_faces > 0);
        CHECK(frame.wet_faces > frame.clamped_water_faces);
        CHECK(frame.unlimited_dt < 0.05);
        CHECK(heard.count(held_at_clamp) == 1); // without statistics
    }
}

TEST_CASE("looking for limits changes no bit, and counts are the same mirrored and on every backend") {
    LimitLog heard;
    const double dt = 0.05;
    const auto watched = chute(dt, &heard), plain = chute(dt, nullptr), mirrored = chute(dt, nullptr, {"cpu", true});
    for (const auto* world : {&watched, &plain, &mirrored}) run_chute(*world, 7, dt);
    const auto stats = limit_stats(plain);
    CHECK(limit_stats(watched).hash == stats.hash);
    CHECK(limit_counts(limit_stats(watched)) == limit_counts(stats));
    CHECK(limit_counts(limit_stats(mirrored)) == limit_counts(stats));
    CHECK(limit_stats(mirrored).unlimited_dt == stats.unlimited_dt);
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto other = chute(dt, nullptr, {backend});
        run_chute(other, 7, dt);
        CHECK(limit_counts(limit_stats(other)) == limit_counts(stats));
        CHECK(limit_stats(other).unlimited_dt == stats.unlimited_dt);
    }
}

TEST_CASE("the map of limits shows where: on the chute and not in the pool, mirrored, by regions, the same on every backend") {
    const double dt = 0.05;
    const auto world = chute(dt, nullptr), mirrored = chute(dt, nullptr, {"cpu", true});
    for (const auto* each : {&world, &mirrored}) run_chute(*each, 7, dt);
    const auto held = held_cells(world), other_way = held_cells(mirrored);
    const auto stats = limit_stats(world);
    std::uint64_t fast = 0, faces = 0;
    for (int j = 0; j < 20; ++j)
        for (int i = 0; i < 96; ++i) {
            const auto of = [&](int column, int row) { return held[static_cast<std::size_t>(row * 96 + column)]; };
            CHECK(of(i, j) == other_way[static_cast<std::size_t>(j * 96 + 95 - i)]);
            CHECK(of(i, j) < WADI_LIMIT_SAND_SPEED); // there is none
            if ((of(i, j) & WADI_LIMIT_WATER_SPEED) == 0) continue;
            CHECK(i > 8);
            CHECK(i < 90);
            ++fast;
            // A face at the clamp is one of both its cells.
            faces += i + 1 < 96 && (of(i + 1, j) & WADI_LIMIT_WATER_SPEED) != 0 ? 1u : 0u;
            faces += j + 1 < 20 && (of(i, j + 1) & WADI_LIMIT_WATER_SPEED) != 0 ? 1u : 0u;
        }
    CHECK(fast > 100);
    CHECK(faces >= stats.clamped_water_faces);
    CHECK(4 * stats.clamped_water_faces >= fast);
    const wadi_region part = {30, 5, 50, 7};
    std::vector<float> values(50 * 7);
    REQUIRE(wadi_world_read_region(world.id, WADI_FIELD_LIMITS, &part, values.data(), values.size()) == WADI_OK);
    for (int j = 0; j < 7; ++j)
        for (int i = 0; i < 50; ++i)
            CHECK(static_cast<int>(values[static_cast<std::size_t>(j * 50 + i)]) ==
                  held[static_cast<std::size_t>((5 + j) * 96 + 30 + i)]);
    CHECK(limit_counts(limit_stats(world)) == limit_counts(stats)); // a map spoils no count
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const auto other = chute(dt, nullptr, {backend});
        run_chute(other, 7, dt);
        CHECK(held_cells(other) == held);
    }
    const auto slower = chute(dt / 8, nullptr);
    run_chute(slower, 7, dt / 8);
    const auto free_cells = held_cells(slower);
    CHECK(std::count_if(free_cells.begin(), free_cells.end(), [](int of) { return (of & WADI_LIMIT_WATER_SPEED) != 0; }) == 0);
}

TEST_CASE("deep water on too long a step is told to be slow, and how high columns stand") {
    const char* settings = R"({ "format_version": 1, "name": "deep pond", "grid": { "nx": 16, "ny": 8, "dx": 0.5 }, "dt": 0.1,
        "water": [ { "shape": "plane", "height": 40 } ], "method": { "largest_height": 64 } })";
    LimitLog heard;
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.log = hear_limits;
    options.log_user = &heard;
    wadi_world_id id{};
    REQUIRE(wadi_create_world_from_level_text(settings, nullptr, nullptr, nullptr, &options, &id) == WADI_OK);
    const AbiWorld world(id);
    const auto stats = limit_stats(world);
    CHECK(stats.wet_faces == 15 * 8 + 16 * 7); // all inner ones
    CHECK(stats.capped_water_faces == stats.wet_faces);
    CHECK(stats.clamped_faces == 0);
    CHECK(stats.high_columns == 0);
    // 0.55 dx over sqrt(g 40 m)
    CHECK(stats.unlimited_dt == doctest::Approx(0.55 * 0.5 / 19.809).epsilon(0.01));
    REQUIRE(heard.with(gravity_capped) != nullptr);
    CHECK(heard.with(gravity_capped)->find("232 of 232 wet faces (100 %)") != std::string::npos);
    CHECK(heard.with(gravity_capped)->find("around (4, 2) m") != std::string::npos);
    CHECK(heard.with("largest_height") == nullptr);
    std::vector<float> held(16 * 8);
    REQUIRE(wadi_world_read_field(id, WADI_FIELD_LIMITS, held.data(), held.size()) == WADI_OK);
    CHECK(std::count(held.begin(), held.end(), static_cast<float>(WADI_LIMIT_WATER_GRAVITY)) == 16 * 8);
}

TEST_CASE("the map of limits shows each column above the largest height, of water alone and on sand, and no other") {
    const auto level = [](double largest, const std::string& more) {
        return R"({ "format_version": 1, "name": "surge", "grid": { "nx": 33, "ny": 9, "dx": 0.5 }, "dt": 0.02,
            "terrain": [ { "shape": "plane", "height": 0.25 } ], )" +
               more + R"("water": [ { "shape": "plane", "height": 0.5 } ],
            "velocities": [ { "shape": "plane", "of": "water", "velocity": [-4, 0] } ], "method": { "largest_height": )" +
               std::to_string(largest) + " } }";
    };
    for (const std::string& more : {std::string(), std::string(R"("sand": [ { "shape": "plane", "height": 0.125 } ], )")}) {
        for (const double largest : {1.0, 4.0}) { // 4: control
            for (const auto& backend : abi_backends()) {
                CAPTURE(more);
                CAPTURE(largest);
                CAPTURE(backend);
                auto options = wadi_default_device_options();
                options.backend = backend.c_str();
                wadi_world_id id{};
                REQUIRE_MESSAGE(wadi_create_world_from_level_text(level(largest, more).c_str(), nullptr, nullptr, nullptr,
                                                                  &options, &id) == WADI_OK,
                                std::string(wadi_get_last_error()));
                const AbiWorld world(id);
                REQUIRE(wadi_world_step(id, 12) == WADI_OK);
                const std::size_t cells = 33 * 9;
                std::vector<float> held(cells), water(cells), sand(cells);
                REQUIRE(wadi_world_read_field(id, WADI_FIELD_LIMITS, held.data(), cells) == WADI_OK);
                REQUIRE(wadi_world_read_field(id, WADI_FIELD_TOTAL_WATER_DEPTH, water.data(), cells) == WADI_OK);
                REQUIRE(wadi_world_read_field(id, WADI_FIELD_SAND_DEPTH, sand.data(), cells) == WADI_OK);
                std::uint64_t high = 0;
                for (std::size_t n = 0; n < cells; ++n) {
                    const bool above = 0.25F + sand[n] + water[n] > static_cast<float>(largest);
                    CHECK(((static_cast<int>(held[n]) & WADI_LIMIT_HEIGHT) != 0) == above);
                    high += above ? 1 : 0;
                }
                CHECK(high == limit_stats(world).high_columns);
                CHECK((high > 0) == (largest == 1.0));
            }
        }
    }
}
