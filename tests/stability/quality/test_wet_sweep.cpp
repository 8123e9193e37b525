// Saturation swept through phi_1, phi_2 and phi_3, in space and in time: strength comes and goes, what is left is smooth.
#include "tests/stability/quality.hpp"
#include <array>

using namespace wadi;
using namespace wadi::test;

namespace {

/// A long levee whose saturation runs from 0 in the west to 0.6 in the east.
Scene levee(int smoothing) {
    auto scene = flat_scene(64, 32, 0.1, 0.009);
    scene.settings.method.saturation_smoothing = smoothing;
    scene.settings.material.cohesion_wet = scene.settings.material.cohesion_capillary = 4.2e3;
    scene.settings.material.diffusion_rate = 0.002;
    const auto inside = [](double y) { return std::fabs(y - 1.6) < 0.7; };
    scene.fill(scene.fields.sand, [&](double, double y) { return inside(y) ? 1.0 : 0.0; });
    scene.fill(scene.fields.water, [&](double x, double y) {
        const double phi = 0.6 * x / 6.4;
        return inside(y) ? phi / (1 - phi) : 0.0;
    });
    return scene;
}

} // namespace

TEST_CASE("a levee from dry to soaked stands where it is damp and nowhere else, smooth; without the low-pass it is rough" *
          doctest::test_suite("long")) {
    auto rough = make_world(level_ground(levee(0)));
    step(*rough, 250);
    on_every_backend(levee(2), [](World& world) { step(world, 20); });
    // soaked: at 0.36, 0.45, 0.58; the more of the water runs free, the less the sand beneath it bears.
    const auto run = [](const Scene& scene, double dry, double damp, const std::array<double, 3>& soaked) {
        auto world = make_world(scene);
        step(*world, 250);
        check_books(*world);
        const auto sand = cells_of(*world, "sand_height");
        const auto crest = [&](double phi) { return sand.at(static_cast<int>(phi / 0.6 * 64), 15); };
        CHECK(crest(0.02) < dry);
        for (const double phi : {0.12, 0.2, 0.25}) CHECK(crest(phi) > damp);
        const std::array phis = {0.36, 0.45, 0.58};
        for (std::size_t n = 0; n < phis.size(); ++n) CHECK(crest(phis[n]) < soaked[n]);
        CHECK(checkerboard(sand) < 5e-5);
    };
    run(level_ground(levee(2)), 0.7, 0.9, {0.5, 0.5, 0.5});
    run(levee(2), 0.9, 0.98, {0.7, 0.6, 0.45}); // gravity along the slope pushes a bank less than its full weight
    CHECK(checkerboard(cells_of(*rough, "sand_height")) > 2e-4);
}

TEST_CASE("a damp column soaked by rain falls, and stays as it fell when it dries; smooth all the time" *
          doctest::test_suite("long")) {
    const auto soak = [](int smoothing) {
        auto scene = flat_scene(48, 48, 0.1, 0.009);
        scene.settings.method.saturation_smoothing = smoothing;
        scene.settings.material.cohesion_wet = scene.settings.material.cohesion_capillary = 4.2e3;
        const auto inside = [](double x, double y) { return std::hypot(x - 2.4, y - 2.4) < 1.2; };
        scene.fill(scene.fields.sand, [&](double x, double y) { return inside(x, y) ? 1.0 : 0.0; });
        scene.fill(scene.fields.water, [&](double x, double y) { return inside(x, y) ? 0.25 : 0.0; });
        scene.settings.rain = {{{0, 0.3}, {2, 0.3}, {2.01, 0}}};
        scene.settings.evaporation = {{{0, 0}, {2.5, 0}, {2.51, 0.5}, {6, 0.5}}};
        scene.settings.sides[SIDE_EAST].kind = scene.settings.sides[SIDE_WEST].kind = SideKind::outflow;
        return scene;
    };
    for (const bool level : {true, false}) {
        CAPTURE(level);
        auto world = make_world(level ? level_ground(soak(2)) : soak(2));
        step(*world, 100);
        CHECK(largest(cells_of(*world, "sand_height")) > 0.9); // still damp enough
        CHECK(roughness(cells_of(*world, "sand_height")) < 0.02);
        step(*world, 200);
        // Soaked: fallen. With slopes pushed less than their whole weight, and borne by what water the pores hold back.
        CHECK(largest(cells_of(*world, "sand_height")) < (level ? 0.6 : 0.85));
        step(*world, 200);
        CHECK(largest(cells_of(*world, "water_height")) == 0); // dry again
        CHECK(sand_speed(*world) == 0);
        CHECK(roughness(cells_of(*world, "sand_height")) < 0.01);
        check_books(*world);
    }
    auto rough = make_world(level_ground(soak(0))); // negative control
    step(*rough, 100);
    CHECK(roughness(cells_of(*rough, "sand_height")) > 0.05);
}
