// Lakes that levels describe start at rest: given as maps of depths on grids of any size, and round dunes whose pores they fill.
#include "tests/stability/quality.hpp"
#include "tests/unit/map_files.hpp"
#include <cmath>

using namespace wadi;
using namespace wadi::test;

namespace {

constexpr int MAP_NX = 48, MAP_NY = 36;
constexpr double MAP_DX = 0.25, LAKE_SURFACE = 0.9;

/// A rough basin with an island, 0.3 m deep in its middle.
double lake_bed(double x, double y) {
    return 0.3 + 0.12 * std::hypot(x - 6, y - 4.5) + 0.1 * std::sin(2.1 * x) * std::cos(1.7 * y) +
           0.5 * std::exp(-(x - 7) * (x - 7) - (y - 3.5) * (y - 3.5));
}

/// A low dune that stands out of the lake, on slopes that friction holds when they are drowned.
double low_dune(double x, double y) { return std::max(0.0, 0.95 - 0.1 * std::hypot(x - 5, y - 5)); }

std::vector<float> map_of(const std::function<double(double x, double y)>& value) {
    std::vector<float> values;
    for (int j = 0; j < MAP_NY; ++j)
        for (int i = 0; i < MAP_NX; ++i) values.push_back(static_cast<float>(value((i + 0.5) * MAP_DX, (j + 0.5) * MAP_DX)));
    return values;
}

void write_map(const map_files::Folder& folder, const std::string& name, const std::vector<float>& values) {
    const auto shape = "(" + std::to_string(MAP_NY) + ", " + std::to_string(MAP_NX) + ")";
    folder.write(name, map_files::npy(map_files::dictionary("<f4", shape), values));
}

Scene level_scene(const map_files::Folder& folder, const std::string& layers, const LevelOverrides& overrides) {
    const std::string text = R"({"format_version": 1, "name": "lake", "dt": 0.01, "grid": {"nx": 48, "ny": 36, "dx": 0.25},
        "material": {"young_modulus": 0}, )" +
                             layers + "}";
    const auto level = parse_level(text, folder.path(), overrides);
    REQUIRE_MESSAGE(level, level.status().message);
    return {level->settings, level->fields};
}

/// Of pure water, water in pores and sand, at its largest within two seconds [m/s].
double largest_speed(const Scene& scene) {
    auto world = make_world(scene);
    double largest = 0;
    for (int n = 0; n < 20; ++n) {
        step(*world, static_cast<int>(std::lround(0.1 / scene.settings.dt)));
        for (const char* field : {"water_velocity_x", "water_velocity_y", "mixed_velocity_x", "mixed_velocity_y"}) {
            const auto raw = world->reader().read_raw(field);
            if (!raw) continue; // no sand, no water in pores
            for (const float u : *raw) largest = std::max(largest, std::fabs(static_cast<double>(u)));
        }
    }
    return largest;
}

std::vector<LevelOverrides> grid_sizes() {
    std::vector<LevelOverrides> all(4);
    all[0].accuracy = "draft";
    all[1].accuracy = "balanced";
    all[2].accuracy = "accurate";
    all[3].size = {61, 40}; // stretched a little
    return all;
}

double volume_of(const Scene& scene) {
    double sum = 0;
    for (const float w : scene.fields.water) sum += static_cast<double>(w);
    return sum * scene.settings.grid.dx * scene.settings.grid.dx;
}

} // namespace

TEST_CASE("a lake given as a map of depths is at rest on grids of any size") {
    const map_files::Folder folder;
    Map depth;
    depth.nx = MAP_NX;
    depth.ny = MAP_NY;
    depth.values = map_of([](double x, double y) { return std::max(0.0, LAKE_SURFACE - lake_bed(x, y)); });
    write_map(folder, "terrain.npy", map_of(lake_bed));
    write_map(folder, "water.npy", depth.values);
    const std::string layers = R"("terrain": [{"file": "terrain.npy"}], "water": [{"file": "water.npy"}])";
    const double volume = volume_of(level_scene(folder, layers, {}));
    for (const auto& overrides : grid_sizes()) {
        auto scene = level_scene(folder, layers, overrides);
        CAPTURE(scene.settings.grid.nx);
        CHECK(largest_speed(scene) < 1e-3);
        if (!overrides.size) CHECK(volume_of(scene) == doctest::Approx(volume).epsilon(0.02));
        // The control: the depths themselves on the other grid.
        if (scene.settings.grid.nx == MAP_NX) continue;
        scene.fields.water = resample(depth, scene.settings.grid.nx, scene.settings.grid.ny);
        CHECK(largest_speed(scene) > 0.1);
    }
}

TEST_CASE("a dune in a lake starts in balance where the lake's level fills its pores, drawn or from maps on grids of any size") {
    const map_files::Folder folder;
    write_map(folder, "sand.npy", map_of(low_dune));
    write_map(folder, "water.npy", map_of([](double, double) { return LAKE_SURFACE - 0.2; }));
    const std::string ground = R"("terrain": [{"shape": "plane", "height": 0.2}], "sand": [{"file": "sand.npy"}], )";
    for (const auto& overrides : grid_sizes()) {
        CAPTURE(overrides.accuracy.value_or("size"));
        CHECK(largest_speed(level_scene(folder, ground + R"("water": [{"shape": "plane", "surface": 0.9, "inside_sand": true}])",
                                        overrides)) < 1e-3);
        CHECK(largest_speed(level_scene(folder, ground + R"("water": [{"file": "water.npy"}])", overrides)) < 1e-3);
        // The control: pores dry above the lake.
        CHECK(largest_speed(level_scene(folder, ground + R"("water": [{"shape": "plane", "surface": 0.9}])", overrides)) > 0.02);
    }
}

TEST_CASE("a map of depths that is no lake keeps its water on a finer grid: a front, a film on a slope, damp sand") {
    const map_files::Folder folder;
    LevelOverrides fine;
    fine.accuracy = "accurate";
    write_map(folder, "slope.npy", map_of([](double x, double) { return 0.2 * x; }));
    write_map(folder, "front.npy", map_of([](double x, double) { return x < 6 ? 2.0 : 0.0; }));
    write_map(folder, "film.npy", map_of([](double x, double y) { return x < 6 && y < 4 ? 0.01 : 0.0; }));
    write_map(folder, "pile.npy", map_of([](double x, double y) { return std::hypot(x - 6, y - 4) < 2 ? 1.0 : 0.0; }));
    write_map(folder, "damp.npy", map_of([](double x, double y) { return std::hypot(x - 6, y - 4) < 2 ? 0.2 : 0.0; }));
    for (const std::string layers :
         {R"("water": [{"file": "front.npy"}])", R"("terrain": [{"file": "slope.npy"}], "water": [{"file": "film.npy"}])",
          R"("sand": [{"file": "pile.npy"}], "water": [{"file": "damp.npy"}])"}) {
        CAPTURE(layers);
        CHECK(volume_of(level_scene(folder, layers, fine)) ==
              doctest::Approx(volume_of(level_scene(folder, layers, {}))).epsilon(1e-5));
    }
    const auto pile = level_scene(folder, R"("sand": [{"file": "pile.npy"}], "water": [{"file": "damp.npy"}])", fine);
    for (std::size_t cell = 0; cell < pile.fields.sand.size(); ++cell)
        CHECK(pile.fields.water[cell] == doctest::Approx(0.2 * static_cast<double>(pile.fields.sand[cell])).epsilon(1e-4));
}
