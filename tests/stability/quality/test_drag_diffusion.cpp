// Explicit drag ahead of friction and Laplacian diffusion (NUMERICS 2.14, 2.15) beside our forms: a lake over saturated sand
// shows both of the paper's faults, and explicit drag its bound.
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

// A lake of surface 2 m over a dune of uneven height, all of it under water and at rest by friction.
Scene drowned_dune() {
    auto scene = flat_scene(48, 32, 0.25, 0.02);
    const auto dune = [](double x, double y) { return 0.5 + 0.3 * std::exp(-((x - 6) * (x - 6) + (y - 4) * (y - 4)) / 4); };
    scene.fill(scene.fields.sand, dune);
    scene.fill(scene.fields.water, [](double, double) { return 2.0; });
    scene.settings.material.friction = 0.9;
    scene.settings.material.young_modulus = 0;
    return scene;
}

double speed_after(const Scene& scene, int steps) {
    auto world = make_world(scene);
    step(*world, steps);
    const auto stats = world->reader().stats();
    REQUIRE(stats);
    CHECK(stats->not_finite == 0);
    return stats->largest_water_speed;
}

// Sand and the water in it start with 0.4 and -0.2 m/s on frictionless ground; the largest water speed after some steps [m/s].
double speed_of_pair(DragFriction form, double exchange) {
    auto scene = flat_scene(24, 16, 0.5, 0.03);
    scene.fill(scene.fields.sand, [](double, double) { return 1; });
    scene.fill(scene.fields.water, [](double, double) { return 1; });
    scene.fill(scene.fields.velocity_x, [](double, double) { return -0.2; });
    scene.fill(scene.fields.sand_velocity_x, [](double, double) { return 0.4; });
    scene.settings.gravity = 0;
    auto& material = scene.settings.material;
    material.friction = 0;
    material.young_modulus = 0;
    material.diffusion_rate = 0;
    material.exchange_rate = exchange;
    scene.settings.method.drag_friction = form;
    auto world = make_world(scene);
    step(*world, 4);
    const auto raw = world->reader().read_raw("mixed_velocity_x");
    REQUIRE(raw);
    return static_cast<double>(std::abs((*raw)[FieldLayout{24, 16}.index(12, 8)]));
}

} // namespace

TEST_CASE("Laplacian diffusion stirs a lake at rest, the limited flux leaves every bit") {
    auto scene = drowned_dune();
    CHECK(speed_after(scene, 100) == 0);
    scene.settings.method.diffusion = Diffusion::laplacian;
    const double stirred = speed_after(scene, 100);
    MESSAGE("lake at rest over a drowned dune, Laplacian diffusion: " << stirred << " m/s");
    CHECK(stirred > 1e-3);
}

TEST_CASE("explicit drag holds below its bound c_e dts (1/rho_w + 1/rho_s) = 2 and blows up above it; the joint solve never") {
    const double dts = 0.03 / 3, bound = 2 / (dts * (1.0 / 1000 + 1.0 / 2000)); // h_m = h_s
    CHECK(speed_of_pair(DragFriction::sequence, 0.5 * bound) < 0.45);
    CHECK(speed_of_pair(DragFriction::sequence, 1.5 * bound) > 2);
    CHECK(speed_of_pair(DragFriction::joint, 1.5 * bound) < 0.45);
    CHECK(speed_of_pair(DragFriction::joint, 1000 * bound) < 0.45);
}

TEST_CASE("explicit drag and Laplacian diffusion, velocities in flux form or traced back: the same bits on every backend") {
    for (const auto transport : {VelocityTransport::flux_form, VelocityTransport::semi_lagrangian}) {
        std::uint64_t hash = 0;
        auto scene = mixed_scene(48, 40);
        scene.settings.method.velocity_transport = transport;
        auto plain = make_world(scene);
        step(*plain, 60);
        scene.settings.method.drag_friction = DragFriction::sequence;
        scene.settings.method.diffusion = Diffusion::laplacian;
        for (const auto& backend : available_backends()) {
            CAPTURE(backend);
            auto world = make_world(scene, {.backend = backend, .shared_device = true});
            step(*world, 60);
            const auto stats = world->reader().stats();
            REQUIRE(stats);
            CHECK(stats->water_quanta == stats->water_initial);
            if (hash == 0) hash = hash_of(*world);
            CHECK(hash == hash_of(*world));
        }
        CHECK(hash != hash_of(*plain));
    }
}
