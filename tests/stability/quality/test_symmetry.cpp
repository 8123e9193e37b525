// Mirrored and transposed scenes give mirrored and transposed bits (the rule of paired sums: shaders/README.md).
#include "tests/stability/quality/wet_scenes.hpp"
#include <algorithm>
#include <doctest/doctest.h>
#include <tuple>

using namespace wadi;
using namespace wadi::test;

namespace {

std::vector<float> mapped(const std::vector<float>& field, int nx, int ny, bool transpose, bool mirror) {
    std::vector<float> result(field.size());
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const int x = mirror ? nx - 1 - i : i;
            const auto to = transpose ? static_cast<std::size_t>(x) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(j)
                                      : static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
            result[to] = field[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)];
        }
    }
    return result;
}

Scene mapped(const Scene& scene, bool transpose, bool mirror) {
    Scene result = scene;
    const auto& g = scene.settings.grid;
    for (auto* pair : {&result.fields.terrain, &result.fields.sand, &result.fields.water})
        *pair = mapped(*pair, g.nx, g.ny, transpose, mirror);
    if (transpose) std::swap(result.settings.grid.nx, result.settings.grid.ny);
    if (transpose) {
        std::swap(result.settings.sides[SIDE_WEST], result.settings.sides[SIDE_SOUTH]);
        std::swap(result.settings.sides[SIDE_EAST], result.settings.sides[SIDE_NORTH]);
    }
    if (mirror)
        std::swap(result.settings.sides[transpose ? SIDE_SOUTH : SIDE_WEST],
                  result.settings.sides[transpose ? SIDE_NORTH : SIDE_EAST]);
    return result;
}

std::vector<float> cells(World& world, const char* field) {
    const auto& g = world.settings().grid;
    std::vector<float> values(static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny));
    REQUIRE(world.reader().read(field, values));
    return values;
}

void check_symmetric(Scene scene, bool transpose, bool mirror) {
    const auto& g = scene.settings.grid;
    auto plain = make_world(scene), other = make_world(mapped(scene, transpose, mirror));
    step(*plain, 120);
    step(*other, 120);
    for (const char* field : {"sand_height", "water_height", "stretch_xy"}) {
        CAPTURE(field);
        auto expected = mapped(cells(*plain, field), g.nx, g.ny, transpose, mirror);
        // A mirrored shear changes its sign.
        if (std::string(field) == "stretch_xy" && mirror)
            std::transform(expected.begin(), expected.end(), expected.begin(), [](float x) { return -x; });
        CHECK(cells(*other, field) == expected);
    }
    const auto vx = mapped(cells(*plain, "sand_velocity_x"), g.nx, g.ny, transpose, mirror);
    CHECK(*std::max_element(vx.begin(), vx.end()) > 0.0F);
}

} // namespace

TEST_CASE("transposed, mirrored and both, with all coupled effects and open sides") {
    for (const auto& [quantum, porosity, conductivity] :
         {std::tuple(-1.0, 1.0, 0.0), std::tuple(0.0, 1.0, 0.0), std::tuple(-1.0, 0.4, 0.0), std::tuple(0.0, 0.4, 0.0),
          std::tuple(-1.0, 0.4, 1e-3), std::tuple(0.0, 0.4, 1e-3)}) {
        CAPTURE(quantum);
        CAPTURE(porosity);
        CAPTURE(conductivity);
        auto scene = mixed_scene_with_sides(40, 31);
        scene.settings.method.quantum = quantum;
        scene.settings.material.porosity = porosity;
        scene.settings.material.conductivity = conductivity;
        check_symmetric(scene, true, false);
        check_symmetric(scene, false, true);
        check_symmetric(scene, true, true);
    }
}

TEST_CASE("negative control: a scene that is not the mirror image differs") {
    const auto scene = mixed_scene(40, 31);
    auto shifted = mapped(scene, false, true);
    shifted.fields.water[5 * 40 + 30] += 0.01F;
    auto a = make_world(mapped(scene, false, true)), b = make_world(shifted);
    step(*a, 20);
    step(*b, 20);
    CHECK(cells(*a, "water_height") != cells(*b, "water_height"));
}
