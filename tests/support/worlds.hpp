// Worlds for tests: small scenes as settings and fields, and the backends of this build.
#pragma once
#include "engine/level/level.hpp"
#include "engine/world.hpp"
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace wadi::test {

/// Sanitizers look at memory, which a few steps use as many do.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool few_steps = true;
#else
constexpr bool few_steps = false;
#endif

/// A scene: settings and fields to change before the world is made.
struct Scene {
    Settings settings;
    InitialFields fields;
    /// Fills a field from a function of the cell's centre [m].
    void fill(std::vector<float>& field, const std::function<double(double x, double y)>& value);
};

/// nx x ny cells of dx metres, flat ground, no sand, no water, robust method.
Scene flat_scene(int nx, int ny, double dx, double dt);
/// The scene with sand's laws of level ground, as method `published` has them: gravity along the horizontal, no friction or
/// viscosity in the plane, pores that hold nothing back, sand drawn without stress. For guards and weaknesses that the laws which
/// are on by default hide or cure.
Scene level_ground(Scene scene);
/// Sand, water, wet sand, a slope and a bump: everything meets. Fits any grid of at least 1 x 1.
Scene mixed_scene(int nx, int ny);
/// Names of all shipped levels, sorted.
std::vector<std::string> shipped_levels();
/// A shipped level at a test's size.
Scene shipped_level(const std::string& name, int nx, int ny);

struct Target {
    std::string backend = "cpu";
    compute::DeviceOptions options = {};
    compute::GroupSize group = {};
    /// On a GPU the world is made on a device that all worlds made so share and that lives until the program ends: its pipelines
    /// are built once, its counters count for all. `options` are those of the first one.
    bool shared_device = false;
};

/// Fails the running test when the world cannot be made.
std::unique_ptr<World> make_world(const Scene& scene, const Target& target = {});
/// True when the build and machine have a device of this backend (lavapipe counts).
bool has_backend(const std::string& name);
/// Every backend that has a device here, the CPU first.
std::vector<std::string> available_backends();

/// All state fields of a world, raw, by name.
std::vector<std::pair<std::string, std::vector<float>>> state_of(World& world);
std::uint64_t hash_of(World& world);
void step(World& world, int count);
std::vector<std::byte> save(World& world);

/// A round brush.
Edit brush(EditLayer layer, double x, double y, double radius, double amount, double softness = 0.5);
/// Queues edits for their steps. Fails the running test when they are refused.
void edit_world(World& world, const std::vector<Edit>& edits);

} // namespace wadi::test
