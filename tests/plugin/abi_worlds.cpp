#include "tests/plugin/abi_worlds.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

namespace wadi::test {

wadi_device_options cpu_device() {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    return options;
}

std::vector<std::string> abi_backends() {
    std::uint32_t count = 0;
    REQUIRE(wadi_list_devices(nullptr, &count, nullptr, 0) == WADI_OK);
    std::vector<wadi_device_info> devices(count);
    for (auto& device : devices) device.struct_size = sizeof device;
    REQUIRE(wadi_list_devices(devices.data(), &count, nullptr, 0) == WADI_OK);
    std::vector<std::string> names;
    for (const auto& device : devices) {
        if (std::find(names.begin(), names.end(), device.backend) == names.end()) names.emplace_back(device.backend);
    }
    return names;
}

AbiWorld world_of(const std::string& backend, const std::string& json, int nx, int ny, const std::vector<float>& terrain,
                  const std::vector<float>& sand, const std::vector<float>& water) {
    auto options = wadi_default_device_options();
    options.backend = backend.c_str();
    auto arrays = wadi_default_world_arrays();
    const auto data = [](const std::vector<float>& field) { return field.empty() ? nullptr : field.data(); };
    arrays.settings_json = json.c_str();
    arrays.nx = nx;
    arrays.ny = ny;
    arrays.terrain = data(terrain);
    arrays.sand = data(sand);
    arrays.water = data(water);
    wadi_world_id id{};
    REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
    return AbiWorld(id);
}

AbiWorld mixed_world(const std::string& backend, int n, double rain) {
    const double size = n * 0.25;
    const std::string json =
        R"({"format_version": 1, "name": "mixed", "dt": 0.015, "grid": {"nx": )" + std::to_string(n) + R"(, "ny": )" +
        std::to_string(n) +
        R"(, "dx": 0.25}, "material": {"cohesion_dry": 500, "bed_friction": 0.01}, "sides": {"south": {"kind": "outflow"}}, )"
        R"("sources": [{"shape": "disc", "center": [)" +
        std::to_string(0.3 * size) + ", " + std::to_string(0.6 * size) +
        R"(], "radius": 0.6, "material": "water", "rate": 0.5}], "rain": )" + std::to_string(rain) + "}";
    std::vector<float> terrain, sand, water;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) / n, y = (j + 0.5) / n;
            terrain.push_back(static_cast<float>(0.5 + 0.4 * std::sin(7 * x) * std::cos(5 * y)));
            sand.push_back(static_cast<float>(std::max(0.0, 1 - 3 * std::hypot(x - 0.6, y - 0.5))));
            water.push_back(x < 0.3 ? 0.8F : 0.05F);
        }
    }
    return world_of(backend, json, n, n, terrain, sand, water);
}

AbiWorld pond(const std::string& backend, int nx, int ny, double dx, float depth) {
    const std::string json = R"({"format_version": 1, "name": "pond", "dt": 0.01, "grid": {"nx": )" + std::to_string(nx) +
                             R"(, "ny": )" + std::to_string(ny) + R"(, "dx": )" + std::to_string(dx) + "}}";
    return world_of(backend, json, nx, ny, {}, {},
                    std::vector<float>(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), depth));
}

void step(const AbiWorld& world, unsigned count) {
    REQUIRE_MESSAGE(wadi_world_step(world.id, count) == WADI_OK, std::string(wadi_get_last_error()));
}

std::uint64_t hash_of(const AbiWorld& world) {
    std::uint64_t hash = 0;
    REQUIRE_MESSAGE(wadi_world_get_hash(world.id, &hash) == WADI_OK, std::string(wadi_get_last_error()));
    return hash;
}

std::uint64_t steps_of(const AbiWorld& world) {
    std::uint64_t steps = 0;
    REQUIRE(wadi_world_get_time(world.id, nullptr, &steps) == WADI_OK);
    return steps;
}

std::uint64_t device_bytes(wadi_world_id world) {
    auto info = wadi_default_world_info();
    REQUIRE(wadi_world_get_info(world, &info) == WADI_OK);
    return info.device_bytes;
}

std::vector<unsigned char> saved(const AbiWorld& world) {
    std::size_t size = 0;
    REQUIRE(wadi_world_save(world.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> bytes(size);
    REQUIRE_MESSAGE(wadi_world_save(world.id, bytes.data(), &size) == WADI_OK, std::string(wadi_get_last_error()));
    REQUIRE(size == bytes.size());
    return bytes;
}

std::vector<unsigned char> log_of(const AbiWorld& world) {
    std::size_t size = 0;
    REQUIRE(wadi_world_get_commands(world.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> bytes(size);
    REQUIRE(wadi_world_get_commands(world.id, bytes.data(), &size) == WADI_OK);
    return bytes;
}

bool error_mentions(const std::string& text) { return std::string(wadi_get_last_error()).find(text) != std::string::npos; }

} // namespace wadi::test
