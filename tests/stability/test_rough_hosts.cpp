// What a host may do to a running world: pour sand into water and water onto sand in every frame, raise ground through a lake.
// While it lasts the ledger holds; once it ends, what was stirred comes to rest.
#include "tests/stability/quality.hpp"

using namespace wadi;
using namespace wadi::test;

namespace {

/// A pond on uneven ground, with a pile of sand in it.
Scene pond() {
    auto scene = flat_scene(40, 32, 0.25, 0.02);
    scene.settings.material.bed_friction = 0.02;
    scene.fill(scene.fields.terrain, [](double x, double y) { return 0.1 + 0.05 * std::sin(2 * x) * std::cos(1.5 * y); });
    scene.fill(scene.fields.water, [](double, double) { return 0.6; });
    scene.fill(scene.fields.sand, [](double x, double y) { return std::max(0.0, 0.8 - 0.4 * std::hypot(x - 7, y - 4)); });
    return scene;
}

} // namespace

TEST_CASE("sand into water and water onto sand in every step: no checkerboard; afterwards both calm down") {
    on_every_backend(pond(), [](World& world) {
        for (int n = 0; n < 60; ++n) {
            edit_world(world, {brush(EditLayer::sand, 3 + 0.02 * n, 4, 0.8, n % 2 == 0 ? 0.3 : -0.28)});
            edit_world(world, {brush(EditLayer::water, 7, 4, 0.6, n % 3 == 0 ? 0.3 : -0.1)});
            step(world, 1);
        }
        CHECK(checkerboard(cells_of(world, "sand_height")) < 1e-3);
        CHECK(water_checkerboard(world) < 1e-4);
        const double stirred = kinetic_energy(world);
        step(world, 200);
        CHECK(kinetic_energy(world) < 0.4 * stirred);
        CHECK(sand_speed(world) < 0.05);
        CHECK(checkerboard(cells_of(world, "sand_height")) < 2e-4);
    });
}

TEST_CASE("ground raised through a lake sheds its water, and the lake calms down; no checkerboard at any time") {
    on_every_backend(pond(), [](World& world) {
        for (int n = 0; n < 60; ++n) {
            edit_world(world, {brush(EditLayer::terrain, 3, 4, 1.5, 0.03)});
            step(world, 1);
        }
        CHECK(largest(cells_of(world, "terrain")) > 1.5);
        const double stirred = kinetic_energy(world);
        CHECK(worst(world, 200, 50, water_checkerboard) < 1e-3);
        CHECK(kinetic_energy(world) < 0.6 * stirred);
        const auto h = cells_of(world, "water_height"), ground = cells_of(world, "terrain");
        CHECK(sum_over(h, [&](int i, int j) { return ground.at(i, j) > 1.2 ? h.at(i, j) : 0.0; }) < 0.2); // was 0.6 m in each
    });
    // Negative control: at steps of 0.3 s without the gravity cap the same lake is full of it.
    auto bare = pond();
    bare.settings.dt = 0.3;
    bare.settings.method.gravity_cap = 0;
    auto world = make_world(bare);
    edit_world(*world, {brush(EditLayer::terrain, 3, 4, 1.5, 0.5)});
    CHECK(worst(*world, 100, 20, water_checkerboard) > 0.02);
}

TEST_CASE("a field that the effects lack reads as zero, one of another name is refused") {
    auto scene = flat_scene(8, 8, 1, 0.01);
    scene.fill(scene.fields.water, [](double, double) { return 0.5; });
    auto world = make_world(scene);
    std::vector<float> values(64, 1);
    REQUIRE(world->reader().read("sand_height", values));
    CHECK(values == std::vector<float>(64, 0));
    const auto status = world->reader().read("sand_hieght", values);
    CHECK(status.code == Code::bad_argument);
    CHECK(status.message == "read: no field is called 'sand_hieght'");
}
