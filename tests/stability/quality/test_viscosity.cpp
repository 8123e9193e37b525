// The two viscosities of method robust, each against the same scene without it: what they are for must go, and nothing blow up.
#include "tests/support/worlds.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace wadi;
using namespace wadi::test;

namespace {

std::vector<float> field_of(World& world, const std::string& name, int cells) {
    std::vector<float> values(static_cast<std::size_t>(cells));
    REQUIRE(world.reader().read(name, values));
    return values;
}

// A stream 0.62 m deep meets a wall: a bore runs back against it. Largest departure from the mean of two neighbours behind the
// bore.
double ripples_behind_bore(double shock_viscosity, bool along_y) {
    const int n = 100;
    auto scene = along_y ? flat_scene(4, n, 0.2, 0.009) : flat_scene(n, 4, 0.2, 0.009);
    scene.settings.method.shock_viscosity = shock_viscosity;
    scene.fill(scene.fields.water, [](double, double) { return 0.62; });
    auto& velocity = along_y ? scene.fields.velocity_y : scene.fields.velocity_x;
    velocity.assign(static_cast<std::size_t>(4 * n), 1.6F);
    auto world = make_world(scene);
    step(*world, 222);
    const auto water = field_of(*world, "water_height", 4 * n);
    const auto depth = [&](int k) { return double(water[static_cast<std::size_t>(along_y ? k * 4 + 1 : n + k)]); };
    CHECK(depth(90) > 1);   // the bore has passed
    CHECK(depth(70) < 0.7); // but not here
    double most = 0;
    for (int k = 84; k < n - 1; ++k) most = std::max(most, std::abs(depth(k) - 0.5 * (depth(k - 1) + depth(k + 1))));
    return most;
}

// A cylinder of damp sand that is let go, and the depth of its middle against that half way out.
struct Release {
    double middle = 0, speed = 0;
};

/// `damped`: with the laws of sand that are on by default.
Release let_go(double bulk_viscosity, double young_modulus, bool damped = false) {
    auto scene = flat_scene(64, 64, 0.1, 0.009);
    if (!damped) scene = level_ground(scene);
    scene.settings.method.bulk_viscosity = bulk_viscosity;
    auto& material = scene.settings.material;
    material.young_modulus = young_modulus;
    material.cohesion_wet = material.cohesion_capillary = damped ? 1.1e4 : 8.5e3;
    scene.fill(scene.fields.sand, [](double x, double y) { return std::hypot(x - 3.2, y - 3.2) < 2 ? 2 : 0; });
    scene.fill(scene.fields.water, [](double x, double y) { return std::hypot(x - 3.2, y - 3.2) < 2 ? 0.5 : 0; });
    auto world = make_world(scene);
    step(*world, 60);
    const auto sand = field_of(*world, "sand_height", 64 * 64);
    Release result;
    result.middle = double(sand[32 * 64 + 32]) / double(sand[32 * 64 + 42]);
    for (const float u : field_of(*world, "sand_velocity_x", 64 * 64)) result.speed = std::max(result.speed, std::abs(double(u)));
    return result;
}

} // namespace

TEST_CASE("shock viscosity removes the ripples behind a bore, along x and along y") {
    for (const bool along_y : {false, true}) {
        CAPTURE(along_y);
        CHECK(ripples_behind_bore(0.25, along_y) < 0.01);
        CHECK(ripples_behind_bore(0, along_y) > 0.05);
    }
}

TEST_CASE("a shock viscosity of 0 leaves no branch of it, and the bits of one that is next to nothing") {
    for (const bool sand : {false, true}) {
        const auto bits = [&](const std::string& backend, double viscosity, bool branch) {
            auto scene = sand ? mixed_scene(48, 40) : flat_scene(48, 40, 0.2, 0.01);
            if (!sand) scene.fill(scene.fields.water, [](double x, double y) { return x + y < 6 ? 1 : 0.4; });
            scene.settings.method.shock_viscosity = viscosity;
            auto world = make_world(scene, {.backend = backend});
            CHECK(((world->plan().effects & EFFECT_SHOCK_VISCOSITY) != 0) == branch);
            step(*world, 60);
            return hash_of(*world);
        };
        for (const auto& backend : available_backends()) {
            const auto none = bits(backend, 0, false);
            CHECK(bits(backend, 1e-30, true) == none);
            CHECK(bits(backend, 0.25, true) != none);
        }
    }
}

TEST_CASE("bulk viscosity keeps a released pile from tearing a pit in its middle") {
    CHECK(let_go(0.5, 2e5).middle > 0.9);
    CHECK(let_go(0, 2e5).middle < 0.75);
    const auto kept = let_go(0, 2e5, true); // as it was drawn
    CHECK(kept.middle == 1);
    CHECK(kept.speed == 0);
}

TEST_CASE("bulk viscosity is bounded where the time step could not follow it") {
    // Unbounded, 1 drives this pile to the clamp of 11.7 m/s; 1e9 Pa is as stiff as elastic_cap lets it be.
    for (const double modulus : {2e5, 1e9}) CHECK(let_go(1, modulus).speed < 1.5);
}
