// Scenes of water in sand that several tests measure.
#pragma once
#include "tests/stability/quality.hpp"

namespace wadi::test {

/// Everything meets, between a lake in the west and an open side in the east.
inline Scene mixed_scene_with_sides(int nx, int ny) {
    auto scene = mixed_scene(nx, ny);
    scene.settings.sides[SIDE_WEST] = {SideKind::level, 0, 1e30, {{{0, 1.5}}}};
    scene.settings.sides[SIDE_EAST] = {SideKind::outflow, 0, 1e30, {}};
    return scene;
}

/// Water that has entered a dry wall of sand, which stands whatever happens, from a lake 1 m deep beside it after `seconds` [m2].
/// choose(material) says what else the sand is.
template <class Choose> double seeped_into_wall(double dx, double seconds, Choose choose) {
    const int n = static_cast<int>(std::lround(24 / dx));
    auto scene = flat_scene(n, 2, dx, 0.09 * dx);
    auto& material = scene.settings.material;
    material.friction = 1.5;
    material.young_modulus = 2e6;
    material.cohesion_dry = material.cohesion_wet = material.cohesion_capillary = 2e5;
    material.exchange_rate = 1e5;
    material.diffusion_rate = material.retention = 0;
    choose(material);
    scene.settings.method.substeps = 3;
    scene.fill(scene.fields.sand, [](double x, double) { return x > 12 ? 6.0 : 0.0; });
    scene.fill(scene.fields.water, [](double x, double) { return x > 12 ? 0.0 : 1.0; });
    auto world = make_world(scene);
    step(*world, static_cast<int>(std::lround(seconds / scene.settings.dt)));
    check_books(*world);
    const auto water = cells_of(*world, "water_height").values;
    double sum = 0;
    for (int i = n / 2; i < n; ++i) sum += static_cast<double>(water[static_cast<std::size_t>(i)]) * dx;
    return sum;
}

/// What Boussinesq's equation lets in, n h_t = K (h h_x)_x behind h = 1 m: n times its similarity solution's volume [m2].
inline double seeped_by_boussinesq(double seconds, double porosity) {
    return 0.8875 * std::sqrt(porosity * 1000 * 9.81 / 1e5 * seconds);
}

} // namespace wadi::test
