// Worlds for tests of the C ABI.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>
#include <wadi/wadi.h>

namespace wadi::test {

/// Destroys its world at the end.
class AbiWorld {
  public:
    explicit AbiWorld(wadi_world_id made) : id(made) {}
    AbiWorld(AbiWorld&& from) noexcept : id(std::exchange(from.id, {})) {}
    AbiWorld& operator=(AbiWorld&&) = delete;
    ~AbiWorld() { wadi_destroy_world(id); }
    wadi_world_id id;
};

wadi_device_options cpu_device();
/// Backends with a device here, the CPU first.
std::vector<std::string> abi_backends();
/// Every effect: sand, water, wet sand, a source, rain, an open side. n x n cells of 0.25 m.
AbiWorld mixed_world(const std::string& backend, int n, double rain = 1e-4);
/// Still water of a depth over flat ground at height 0, or neither sand nor water for depth 0; cells of dx metres.
AbiWorld pond(const std::string& backend, int nx, int ny, double dx, float depth);
/// Settings as JSON and fields of nx * ny floats, empty for zero.
AbiWorld world_of(const std::string& backend, const std::string& json, int nx, int ny, const std::vector<float>& terrain,
                  const std::vector<float>& sand, const std::vector<float>& water);

void step(const AbiWorld& world, unsigned count);
std::uint64_t hash_of(const AbiWorld& world);
std::uint64_t steps_of(const AbiWorld& world);
std::uint64_t device_bytes(wadi_world_id world);
/// By wadi_world_save.
std::vector<unsigned char> saved(const AbiWorld& world);
/// By wadi_world_get_commands.
std::vector<unsigned char> log_of(const AbiWorld& world);
bool error_mentions(const std::string& text);

} // namespace wadi::test
