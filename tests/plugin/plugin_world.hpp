// Worlds behind the C ABI for tests: sand and water on a slope, on every backend that has a device here.
#pragma once
#include "tests/plugin/abi_worlds.hpp"
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <vector>
#include <wadi/wadi.h>

namespace plugin_test {

using wadi::test::device_bytes;
using wadi::test::error_mentions;

/// Backends with a device here, the CPU first.
inline std::vector<std::string> backends() { return wadi::test::abi_backends(); }

constexpr uint64_t step_time = 10000000; // of the worlds here [ns]

/// nx * ny cells of 0.5 m, dt [s], sand and water of that depth [m] that meet; destroyed at the end. `more`: of its settings,
/// each after a comma.
struct World {
    wadi_world_id id{};
    int nx, ny;
    explicit World(const std::string& backend, int columns = 40, int rows = 36, double dt = 0.01, int threads = 0,
                   float depth = 1.5F, const std::string& more = "")
        : nx(columns), ny(rows) {
        std::vector<float> terrain, sand, water;
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                terrain.push_back(0.02F * static_cast<float>(i));
                sand.push_back(i > nx / 3 && i < nx / 2 ? 1.0F : 0.0F);
                water.push_back(i < nx / 3 ? depth : 0.0F);
            }
        }
        const std::string settings = R"({"format_version": 1, "name": "slope", "grid": {"nx": )" + std::to_string(nx) +
                                     R"(, "ny": )" + std::to_string(ny) + R"(, "dx": 0.5}, "dt": )" + std::to_string(dt) + more +
                                     "}";
        auto arrays = wadi_default_world_arrays();
        arrays.settings_json = settings.c_str();
        arrays.nx = nx;
        arrays.ny = ny;
        arrays.terrain = terrain.data();
        arrays.sand = sand.data();
        arrays.water = water.data();
        auto options = wadi_default_device_options();
        options.backend = backend.c_str();
        options.threads = threads;
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
    }
    ~World() { wadi_destroy_world(id); }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    wadi_frame update(uint64_t nanoseconds) const {
        auto frame = wadi_default_frame();
        REQUIRE_MESSAGE(wadi_world_update(id, nanoseconds, &frame) == WADI_OK, std::string(wadi_get_last_error()));
        return frame;
    }
    wadi_world_stats stats() const {
        auto stats = wadi_default_world_stats();
        REQUIRE(wadi_world_get_stats(id, &stats) == WADI_OK);
        return stats;
    }
    std::vector<float> read(wadi_field field) const {
        std::vector<float> values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
        REQUIRE(wadi_world_read_field(id, field, values.data(), values.size()) == WADI_OK);
        return values;
    }
    /// Steps are never dropped because the device is behind: update may wait for it.
    void keep_all_steps() const {
        auto settings = wadi_default_update_settings();
        settings.max_steps_in_flight = 0;
        REQUIRE(wadi_world_set_update_settings(id, &settings) == WADI_OK);
    }
    /// Returns once the device has done all that was submitted.
    void wait() const { read(WADI_FIELD_TERRAIN); }
};

} // namespace plugin_test
