// Regions written from memory that is checked on the device: the bits and counts of wadi_world_write_region for every value that
// it takes, and what becomes of those that it refuses.
#include "tests/plugin/abi_worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace wadi::test;

namespace {

constexpr int N = 40;

// Sand that holds together beside water, `more` being further keys of the level.
AbiWorld bank(const std::string& backend, const std::string& more = "") {
    const std::string json = R"({"format_version": 1, "name": "bank", "dt": 0.01, "grid": {"nx": 40, "ny": 40, "dx": 0.25},
        "material": {"young_modulus": 1e5, "cohesion_dry": 500}, "sides": {"east": {"kind": "outflow"}})" +
                             more + "}";
    std::vector<float> terrain, sand, water;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            terrain.push_back(0.01F * static_cast<float>(i + j));
            sand.push_back(i > 15 ? 0.5F : 0.0F);
            water.push_back(i < 25 ? 0.3F : 0.0F);
        }
    }
    return world_of(backend, json, N, N, terrain, sand, water);
}

wadi_world_stats stats_of(const AbiWorld& world) {
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    return stats;
}

std::vector<float> field_of(const AbiWorld& world, wadi_field field, int nx = N, int ny = N) {
    std::vector<float> values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
    REQUIRE(wadi_world_read_field(world.id, field, values.data(), values.size()) == WADI_OK);
    return values;
}

// In host memory, rows further apart than they are long.
struct Rows {
    std::vector<float> memory;
    wadi_device_values values = wadi_default_device_values();
    Rows(const std::vector<float>& dense, int nx) : memory(3, -99.0F) {
        const auto row = static_cast<std::size_t>(nx);
        for (std::size_t at = 0; at < dense.size(); at += row) {
            memory.insert(memory.end(), dense.begin() + static_cast<std::ptrdiff_t>(at),
                          dense.begin() + static_cast<std::ptrdiff_t>(at + row));
            memory.insert(memory.end(), 5, -99.0F);
        }
        values.handle_kind = WADI_HANDLE_HOST_POINTER;
        values.handle = reinterpret_cast<std::uintptr_t>(memory.data());
        values.offset = 12;
        values.row_pitch = (row + 5) * 4;
    }
};

void write_from(const AbiWorld& world, wadi_field field, const wadi_region& region, const std::vector<float>& dense) {
    const Rows rows(dense, region.nx);
    REQUIRE_MESSAGE(wadi_world_write_region_from(world.id, field, &region, &rows.values) == WADI_OK,
                    std::string(wadi_get_last_error()));
}

// Heights between quanta and midway between two, some above and some below those there.
std::vector<float> heights(const wadi_region& region, double quantum, float base) {
    std::vector<float> values;
    for (int n = 0; n < region.nx * region.ny; ++n) {
        const double count = std::floor(static_cast<double>(base) / quantum) + 37 * (n % 11) - 29 * (n % 7);
        values.push_back(static_cast<float>(std::max(0.0, (count + 0.25 * (n % 5)) * quantum)));
    }
    return values;
}

} // namespace

TEST_CASE("values that are checked on the device give the bits and counts of those checked on the host") {
    const std::vector<std::string> methods = {"", R"(, "method": {"name": "published"})",
                                              R"(, "method": {"name": "published", "strain_transport": "direct"})",
                                              R"(, "method": {"prestress": false})", R"(, "active_tiles": 8)"};
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        for (const auto& method : methods) {
            CAPTURE(method);
            const AbiWorld world = bank(backend, method), twin = bank("cpu", method);
            const double quantum = stats_of(twin).quantum;
            const wadi_region whole{0, 0, N, N}, middle{12, 9, 17, 23}, corner{30, 30, 10, 10}, strip{3, 5, 1, 34};
            struct Write {
                wadi_field field;
                wadi_region region;
                float base;
            };
            for (const auto& [field, region, base] :
                 {Write{WADI_FIELD_SAND_DEPTH, middle, 0.4F}, Write{WADI_FIELD_TERRAIN, whole, 0.2F},
                  Write{WADI_FIELD_TOTAL_WATER_DEPTH, corner, 0.1F}, Write{WADI_FIELD_SAND_DEPTH, strip, 0.6F},
                  Write{WADI_FIELD_TERRAIN, corner, 0.5F}, Write{WADI_FIELD_TOTAL_WATER_DEPTH, whole, 0.3F},
                  Write{WADI_FIELD_SAND_DEPTH, whole, 0.3F}}) {
                const auto values = heights(region, quantum, base);
                write_from(world, field, region, values);
                REQUIRE_MESSAGE(wadi_world_write_region(twin.id, field, &region, values.data(), values.size()) == WADI_OK,
                                std::string(wadi_get_last_error()));
                CHECK(hash_of(world) == hash_of(twin));
                step(world, 3);
                step(twin, 3);
            }
            CHECK(field_of(world, WADI_FIELD_TERRAIN) == field_of(twin, WADI_FIELD_TERRAIN));
            const auto got = stats_of(world), expected = stats_of(twin);
            CHECK(got.hash == expected.hash);
            // Without a quantum amounts are rounded one by one.
            const bool exact = method.find("name") == std::string::npos;
            const auto same = [&](double a, double b) { return exact ? a == b : std::abs(a - b) <= 1e-4 * b; };
            CHECK(same(got.sand_in, expected.sand_in));
            CHECK(same(got.sand_out, expected.sand_out));
            CHECK(same(got.water_in, expected.water_in));
            CHECK(same(got.water_out, expected.water_out));
            CHECK(got.refused == expected.refused);
            CHECK(expected.sand_in > 0);
            CHECK(expected.sand_out > 0);
            if (exact) CHECK(got.sand_drift_quanta == 0);
            if (exact) CHECK(got.water_drift_quanta == 0);
        }
    }
}

TEST_CASE("a layer that is written promotes the world, and more writes than the queue has room for wait for it") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const AbiWorld world = pond(backend, 24, 20, 0.5, 0), twin = pond("cpu", 24, 20, 0.5, 0);
        for (int n = 0; n < 70; ++n) {
            const wadi_region region{n % 10, n % 7, 1 + n % 14, 1 + n % 13};
            const std::vector<float> values(static_cast<std::size_t>(region.nx * region.ny),
                                            0.25F + static_cast<float>(n % 9) / 16);
            const auto field = n % 2 == 0 ? WADI_FIELD_SAND_DEPTH : WADI_FIELD_TOTAL_WATER_DEPTH;
            write_from(world, field, region, values);
            REQUIRE(wadi_world_write_region(twin.id, field, &region, values.data(), values.size()) == WADI_OK);
            if (n % 16 == 0) {
                step(world, 1);
                step(twin, 1);
            }
        }
        step(world, 4);
        step(twin, 4);
        CHECK(hash_of(world) == hash_of(twin));
        CHECK(stats_of(world).sand_drift_quanta == 0);
        CHECK(stats_of(world).water_drift_quanta == 0);
        auto frame = wadi_default_frame();
        for (int n = 0; n < 70; ++n) write_from(world, WADI_FIELD_TERRAIN, {0, 0, 1, 1}, {0.5F});
        hash_of(world); // waits
        REQUIRE(wadi_world_update(world.id, 10'100'000, &frame) == WADI_OK);
        CHECK(frame.steps == 1);
    }
}

TEST_CASE("values that no cell can have are cut or left out, and counted") {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const AbiWorld world =
            world_of(backend, R"({"format_version": 1, "name": "low", "dt": 0.01, "gravity": 0,
            "grid": {"nx": 8, "ny": 6, "dx": 0.5}, "method": {"largest_height": 8}})",
                     8, 6, std::vector<float>(48, 1.0F), std::vector<float>(48, 2.0F), std::vector<float>(48, 0.5F));
        const wadi_region row{1, 2, 7, 1};
        auto refused = [&, last = 0.0](double depths) mutable {
            const auto stats = stats_of(world);
            CHECK(stats.refused - last == depths * 0.25); // of cells of 0.25 m2
            CHECK(stats.sand_drift_quanta == 0);
            CHECK(stats.water_drift_quanta == 0);
            CHECK(stats.not_finite == 0);
            last = stats.refused;
        };
        const auto part = [&](wadi_field field) {
            std::vector<float> values(7);
            REQUIRE(wadi_world_read_region(world.id, field, &row, values.data(), 7) == WADI_OK);
            return values;
        };
        write_from(world, WADI_FIELD_TOTAL_WATER_DEPTH, row, {nan, -infinite, -1.0F, 6.0F, 1e30F, 0.25F, 5.0F});
        CHECK(part(WADI_FIELD_TOTAL_WATER_DEPTH) == std::vector<float>{0.5F, 0.5F, 0, 5, 5, 0.25F, 5});
        refused(8 + 8 + 1 + 1 + 11); // 1e30 counts as 16
        write_from(world, WADI_FIELD_SAND_DEPTH, row, {infinite, 7.5F, -3e38F, 2, 2.5F, 1, 1});
        CHECK(part(WADI_FIELD_SAND_DEPTH) == std::vector<float>{2, 6.5F, 0, 2, 2, 1, 1});
        refused(8 + 1 + 16 + 0 + 0.5);
        write_from(world, WADI_FIELD_TERRAIN, row, {nan, -9, -8, 3, 1.5F, -20, 7});
        CHECK(part(WADI_FIELD_TERRAIN) == std::vector<float>{1, -8, -8, 1, 1, -8, 2});
        refused(8 + 1 + 0 + 2 + 0.5 + 8 + 5);
        step(world, 1);
        CHECK(stats_of(world).not_finite == 0);
    }
}

TEST_CASE("memory that is none of the world's is refused by field, and nothing is written") {
    for (const auto& backend : abi_backends()) {
        CAPTURE(backend);
        const AbiWorld world = bank(backend), twin = bank(backend);
        const wadi_region region{2, 3, 4, 5}, outside{38, 0, 3, 1};
        const Rows good(std::vector<float>(20, 0.5F), 4);
        const auto refused = [&](const char* named, auto change, wadi_result result = WADI_ERROR_BAD_ARGUMENT) {
            auto values = good.values;
            change(values);
            CHECK(wadi_world_write_region_from(world.id, WADI_FIELD_SAND_DEPTH, &region, &values) == result);
            CHECK_MESSAGE(error_mentions(named), std::string(wadi_get_last_error()));
            CHECK(error_mentions("wadi_world_write_region_from: "));
        };
        refused("values.struct_size is 3", [](auto& v) { v.struct_size = 3; });
        refused("values.handle_kind: 9 is outside 0 ... 2", [](auto& v) { v.handle_kind = static_cast<wadi_handle_kind>(9); });
        refused("values.handle is 0", [](auto& v) { v.handle = 0; });
        refused("values.offset: 6 is no multiple of 4", [](auto& v) { v.offset = 6; });
        refused("values.row_pitch: 12 is no multiple of 4 from 16", [](auto& v) { v.row_pitch = 12; });
        refused("values.row_pitch: 18 is no multiple", [](auto& v) { v.row_pitch = 18; });
        if (backend != "vulkan")
            refused("values.handle_kind is VULKAN_BUFFER; a world of the backend ",
                    [](auto& v) { v.handle_kind = WADI_HANDLE_VULKAN_BUFFER; });
        else // on a device of its own
            refused(
                "knows no device memory of a host", [](auto& v) { v.handle_kind = WADI_HANDLE_VULKAN_BUFFER; },
                WADI_ERROR_NOT_SUPPORTED);
        if (backend != "cuda")
            refused("values.handle_kind is CUDA_POINTER; a world of the backend ",
                    [](auto& v) { v.handle_kind = WADI_HANDLE_CUDA_POINTER; });
        CHECK(wadi_world_write_region_from(world.id, WADI_FIELD_SATURATION, &region, &good.values) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("is not TERRAIN, SAND_DEPTH or TOTAL_WATER_DEPTH"));
        CHECK(wadi_world_write_region_from(world.id, WADI_FIELD_SAND_DEPTH, &outside, &good.values) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("region of 3 x 1 cells at (38, 0)"));
        CHECK(wadi_world_write_region_from(world.id, WADI_FIELD_SAND_DEPTH, nullptr, &good.values) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_write_region_from(world.id, WADI_FIELD_SAND_DEPTH, &region, nullptr) == WADI_ERROR_BAD_ARGUMENT);
        REQUIRE(wadi_world_set_command_log(world.id, 1) == WADI_OK);
        refused(
            "the command log is on", [](auto&) {}, WADI_ERROR_NOT_SUPPORTED);
        REQUIRE(wadi_world_set_command_log(world.id, 0) == WADI_OK);
        step(world, 2);
        step(twin, 2);
        CHECK(hash_of(world) == hash_of(twin));
        const AbiWorld dry = world_of(backend, R"({"format_version": 1, "name": "dry", "dt": 0.01,
            "grid": {"nx": 8, "ny": 8, "dx": 0.5}, "effects": {"sand": "off"}})",
                                      8, 8, {}, {}, {});
        CHECK(wadi_world_write_region_from(dry.id, WADI_FIELD_SAND_DEPTH, &region, &good.values) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("wadi_world_write_region_from: effects.sand is forced off"));
    }
}
