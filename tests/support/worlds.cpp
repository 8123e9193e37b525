#include "tests/support/worlds.hpp"
#include "backends/registry.hpp"
#include "tests/support/borrowed_device.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <map>

namespace wadi::test {

void Scene::fill(std::vector<float>& field, const std::function<double(double, double)>& value) {
    const auto& g = settings.grid;
    field.assign(static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny), 0.0F);
    for (int j = 0; j < g.ny; ++j) {
        for (int i = 0; i < g.nx; ++i) {
            field[static_cast<std::size_t>(j) * static_cast<std::size_t>(g.nx) + static_cast<std::size_t>(i)] =
                static_cast<float>(value((i + 0.5) * g.dx, (j + 0.5) * g.dx));
        }
    }
}

Scene flat_scene(int nx, int ny, double dx, double dt) {
    Scene scene;
    scene.settings.grid = {nx, ny, dx};
    scene.settings.dt = dt;
    return scene;
}

Scene level_ground(Scene scene) {
    auto& material = scene.settings.material;
    material.slope_normal = material.internal_friction = material.sand_viscosity = material.retention = 0;
    scene.settings.method.prestress = false;
    return scene;
}

Scene mixed_scene(int nx, int ny) {
    auto scene = flat_scene(nx, ny, 0.2, 0.015);
    auto& material = scene.settings.material;
    material.friction = 0.35;
    material.young_modulus = 5e5;
    material.cohesion_dry = 500;
    material.cohesion_wet = material.cohesion_capillary = 1e4;
    material.exchange_rate = 3e4;
    material.bed_friction = 0.01;
    const double lx = nx * 0.2, ly = ny * 0.2;
    scene.fill(scene.fields.terrain,
               [&](double x, double y) { return 0.4 + 0.3 * std::sin(3 * x / lx + 1) * std::cos(2 * y / ly); });
    const auto bump = [](double x, double y, double cx, double cy, double r) {
        return std::max(0.0, 1 - std::hypot(x - cx, y - cy) / r);
    };
    scene.fill(scene.fields.sand, [&](double x, double y) {
        return 1.2 * bump(x, y, 0.4 * lx, 0.45 * ly, 0.3 * lx) + (std::hypot(x - 0.7 * lx, y - 0.6 * ly) < 0.12 * lx ? 0.9 : 0.0);
    });
    scene.fill(scene.fields.water,
               [&](double x, double y) { return x < 0.3 * lx ? 1.1 : 0.25 * bump(x, y, 0.45 * lx, 0.5 * ly, 0.25 * lx); });
    return scene;
}

std::vector<std::string> shipped_levels() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(WADI_SOURCE_DIR "/samples/levels"))
        if (std::filesystem::exists(entry.path() / "level.json")) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

Scene shipped_level(const std::string& name, int nx, int ny) {
    LevelOverrides overrides;
    overrides.size = {nx, ny};
    auto level = load_level(std::string(WADI_SOURCE_DIR) + "/samples/levels/" + name + "/level.json", overrides);
    REQUIRE_MESSAGE(level, level.status().message);
    return {level->settings, level->fields};
}

namespace {

// Left open: a driver may be gone by the time that static objects are destroyed.
compute::Device& shared_device(const Target& target) {
    static auto& devices = *new std::map<std::string, std::unique_ptr<compute::Device>>;
    auto& device = devices[target.backend];
    if (!device) {
        auto opened = backends::open_device(target.backend, -1, target.options);
        REQUIRE_MESSAGE(opened, opened.status().message);
        device = std::move(*opened);
    }
    return *device;
}

std::unique_ptr<compute::Device> device_for(const Target& target) {
    if (target.shared_device && target.backend != "cpu") return std::make_unique<BorrowedDevice>(shared_device(target));
    auto device = backends::open_device(target.backend, -1, target.options);
    REQUIRE_MESSAGE(device, device.status().message);
    return std::move(*device);
}

} // namespace

std::unique_ptr<World> make_world(const Scene& scene, const Target& target) {
    auto world = World::create(scene.settings, scene.fields, device_for(target), target.group);
    REQUIRE_MESSAGE(world, world.status().message);
    return std::move(*world);
}

bool has_backend(const std::string& name) {
    std::string why;
    for (const auto& backend : backends::all()) {
        if (name == backend.name) return !backends::list_devices(backend, why).empty();
    }
    return false;
}

std::vector<std::string> available_backends() {
    std::vector<std::string> names;
    for (const auto& backend : backends::all()) {
        if (has_backend(backend.name)) names.emplace_back(backend.name);
    }
    return names;
}

std::vector<std::pair<std::string, std::vector<float>>> state_of(World& world) {
    std::vector<std::pair<std::string, std::vector<float>>> state;
    for (const auto& field : world.plan().fields) {
        if (field.role != FieldRole::state) continue;
        auto raw = world.reader().read_raw(field.name);
        REQUIRE_MESSAGE(raw, raw.status().message);
        state.emplace_back(field.name, *raw);
    }
    return state;
}

std::uint64_t hash_of(World& world) {
    auto stats = world.reader().stats();
    REQUIRE_MESSAGE(stats, stats.status().message);
    return stats->hash;
}

std::vector<std::byte> save(World& world) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(world.snapshots().bytes()));
    const auto status = world.snapshots().save(bytes);
    REQUIRE_MESSAGE(status, status.message);
    return bytes;
}

void step(World& world, int count) {
    const auto status = world.step(static_cast<std::uint32_t>(count));
    REQUIRE_MESSAGE(status, status.message);
}

Edit brush(EditLayer layer, double x, double y, double radius, double amount, double softness) {
    Edit edit;
    edit.layer = layer;
    edit.x0 = x;
    edit.y0 = y;
    edit.radius = radius;
    edit.amount = amount;
    edit.softness = softness;
    return edit;
}

void edit_world(World& world, const std::vector<Edit>& edits) {
    const auto status = world.commands().edit(edits);
    REQUIRE_MESSAGE(status, status.message);
}

} // namespace wadi::test
