// Method `published` against a reading of the paper's Algorithm 1 that shares no code with it (tests/reference/printed.hpp), in
// whole steps; what differs a little from the paper must show.
#include "engine/settings/data/method_presets.hpp"
#include "tests/reference/printed.hpp"
#include "tests/support/worlds.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <functional>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

// Damp and drowned sand in a bowl, a hump of water on it that sloshes; in the west ground without either.
Scene printed_scene() {
    Scene scene = flat_scene(28, 20, 0.1, 0.004);
    choose_method(scene.settings, "published");
    scene.settings.material.exchange_rate = 2e4;
    scene.settings.material.cohesion_wet = scene.settings.material.cohesion_capillary = 2e3;
    scene.settings.material.diffusion_rate = 0.02;
    scene.fill(scene.fields.terrain, [](double x, double y) { return 0.3 + 0.1 * std::cos(1.7 * x + 0.4 * y); });
    scene.fill(scene.fields.sand, [](double x, double y) {
        return std::max(0.0, 0.2 + 0.5 * std::sin(pi * x / 2.8) * (0.8 + 0.3 * std::cos(2.3 * y)) - 0.4 * std::exp(-4 * x));
    });
    scene.fill(scene.fields.water, [](double x, double y) { return std::max(0.0, 0.25 * x - 0.1 + 0.08 * std::sin(2 * y)); });
    return scene;
}

// Largest differences of a world from what is printed, over the largest value of the field.
struct Apart {
    double sand, water, sand_velocity, pure_velocity, mixed_velocity, stretch, rotation;
    double most() const { return std::max({sand, water, sand_velocity, pure_velocity, mixed_velocity, stretch, rotation}); }
};

Apart from_printed(const Scene& scene, const reference::Printed& printed, int steps) {
    auto world = make_world(scene);
    step(*world, steps);
    const int nx = scene.settings.grid.nx, ny = scene.settings.grid.ny;
    const FieldLayout layout{nx, ny};
    const auto apart = [&](const char* name, int columns, int rows, const std::function<double(std::size_t)>& right) {
        const auto got = world->reader().read_raw(name);
        REQUIRE_MESSAGE(got, name);
        double difference = 0, size = 0;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const double value = static_cast<double>((*got)[layout.index(i, j)]), expected = right(printed.at(i, j));
                difference = std::max(difference, std::isfinite(value) ? std::abs(value - expected) : 1e9);
                size = std::max(size, std::abs(expected));
            }
        return difference / size;
    };
    const auto velocity = [&](const std::string& name, const reference::Printed::Velocity& w) {
        return std::max(apart((name + "_x").c_str(), nx + 1, ny, [&](std::size_t c) { return w.u[c]; }),
                        apart((name + "_y").c_str(), nx, ny + 1, [&](std::size_t c) { return w.v[c]; }));
    };
    return {apart("sand_height", nx, ny, [&](std::size_t c) { return printed.hs[c]; }),
            apart("water_height", nx, ny, [&](std::size_t c) { return printed.hw[c] + printed.hm[c]; }),
            velocity("sand_velocity", printed.sand),
            velocity("water_velocity", printed.pure),
            velocity("mixed_velocity", printed.mixed),
            std::max({apart("stretch_xx", nx, ny, [&](std::size_t c) { return printed.F[c].xx - 1; }),
                      apart("stretch_xy", nx, ny, [&](std::size_t c) { return printed.F[c].xy; }),
                      apart("stretch_yy", nx, ny, [&](std::size_t c) { return printed.F[c].yy - 1; })}),
            apart("rotation", nx, ny, [&](std::size_t c) { return printed.F[c].theta; })};
}

} // namespace

TEST_CASE("published is the paper's Algorithm 1, and a little else is not") {
    const Scene scene = printed_scene();
    constexpr double tolerance = 1e-4;
    for (const int steps : {1, 4, 12}) {
        CAPTURE(steps);
        reference::Printed printed(scene.settings, scene.fields);
        for (int n = 0; n < steps; ++n) printed.step();
        const Apart same = from_printed(scene, printed, steps);
        MESSAGE(steps << " steps: sand " << same.sand << ", water " << same.water << ", us " << same.sand_velocity << ", uw "
                      << same.pure_velocity << ", um " << same.mixed_velocity << ", P " << same.stretch << ", theta "
                      << same.rotation);
        CHECK(same.most() < tolerance);
        if (steps == 1) continue;
        struct Control {
            std::string name;
            std::function<void(Settings&)> change;
        };
        const Control controls[] = {
            {"F moved as it is", [](Settings& other) { other.method.strain_transport = StrainTransport::direct; }},
            {"two substeps", [](Settings& other) { other.method.substeps = 2; }},
            {"a tenth more friction", [](Settings& other) { other.material.friction *= 1.1; }},
            {"a tenth less diffusion", [](Settings& other) { other.material.diffusion_rate *= 0.9; }},
        };
        for (const Control& control : controls) {
            CAPTURE(control.name);
            Scene other = scene;
            control.change(other.settings);
            const double apart = from_printed(other, printed, steps).most();
            MESSAGE(steps << " steps, " << control.name << ": " << apart);
            CHECK(apart > 10 * tolerance);
        }
    }
}
