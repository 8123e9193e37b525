// engine/level/crests.hpp: walls and dikes of maps on grids that are too coarse for them.
#include "engine/image/map.hpp"
#include "tests/unit/level_text.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <numbers>
#include <queue>

using namespace wadi;
using namespace level_text;
using map_files::Folder;

namespace {

using Ground = std::function<double(double x, double y)>;

constexpr int SIZE = 128; // samples of 1 m

std::vector<double> samples_of(const Ground& ground) {
    std::vector<double> values;
    for (int j = 0; j < SIZE; ++j)
        for (int i = 0; i < SIZE; ++i) values.push_back(ground(i + 0.5, j + 0.5));
    return values;
}

/// How high water must stand in the south-western cell to reach the north-eastern one, by the sides of cells.
template <class Values> double spill(const Values& heights, int nx, int ny) {
    std::vector<char> seen(heights.size());
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
    open.emplace(heights[0], 0);
    while (true) {
        const auto [level, at] = open.top();
        open.pop();
        if (at == nx * ny - 1) return level;
        if (seen[static_cast<std::size_t>(at)]++ != 0) continue;
        const auto to = [&, so_far = level](int next) {
            open.emplace(std::max(so_far, static_cast<double>(heights[static_cast<std::size_t>(next)])), next);
        };
        if (at % nx > 0) to(at - 1);
        if (at % nx + 1 < nx) to(at + 1);
        if (at >= nx) to(at - nx);
        if (at + nx < nx * ny) to(at + nx);
    }
}

/// Distance from a line through (63.3, 64.6) at an angle to the y axis, downwards to the south-east.
double from_line(double x, double y, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return std::fabs((x - 63.3) * std::cos(angle) + (y - 64.6) * std::sin(angle));
}

struct OnGrid {
    Level level;
    std::string warned; // of crests, empty if not
    double plain = 0;   // spill of the means alone
};

OnGrid on_grid(const Ground& ground, int nx, int ny, const std::string& keys = "") {
    const Folder folder;
    const auto values = samples_of(ground);
    folder.write("map.npy", map_files::npy(map_files::dictionary("<f8", "(128, 128)"), values));
    LevelOverrides overrides;
    overrides.size = {nx, ny};
    OnGrid drawn;
    drawn.level = must(parse_level(level(R"("method": {"largest_height": 256}, "terrain": [{"file": "map.npy")" + keys + "}]",
                                         R"({"nx": 128, "ny": 128, "dx": 1})"),
                                   folder.path(), overrides));
    for (const std::string& warning : drawn.level.warnings)
        if (says(warning, "crests that are narrower")) drawn.warned = warning;
    Map map;
    map.nx = map.ny = SIZE;
    map.values.assign(values.begin(), values.end());
    drawn.plain = spill(resample(map, nx, ny), nx, ny);
    return drawn;
}

} // namespace

TEST_CASE("maps on coarser grids: what walls and dikes hold back on the map they hold back there, at every angle") {
    struct Wall {
        std::string name;
        std::function<double(double from_middle)> height;
    };
    const Wall walls[] = {
        {"wall of 1.5 m", [](double d) { return d <= 0.75 ? 5.0 : 0.0; }},
        {"wall of 3 m", [](double d) { return d <= 1.5 ? 5.0 : 0.0; }},
        {"dike, crest of 1 m and slopes of 1 in 1", [](double d) { return std::clamp(5.5 - d, 0.0, 5.0); }},
    };
    for (const Wall& wall : walls)
        for (const double degrees : {0.0, 10.0, 22.5, 45.0, 70.0})
            for (const int cells : {100, 64, 51, 32, 20, 9}) {
                const Ground ground = [&](double x, double y) { return wall.height(from_line(x, y, degrees)) + 0.01 * y; };
                const double on_map = spill(samples_of(ground), SIZE, SIZE);
                const OnGrid drawn = on_grid(ground, cells, cells);
                const double kept = spill(drawn.level.fields.terrain, cells, cells);
                CAPTURE(wall.name);
                CAPTURE(degrees);
                CAPTURE(cells);
                INFO(wall.name << ", " << degrees << " degrees, " << cells << " cells: " << on_map << " m, here " << kept
                               << ", means " << drawn.plain);
                CHECK(on_map > 4.9);
                const bool upright = wall.height(3) == 0;
                // A wall as wide as cells is as high in most of them; a dike that cells resolve has means as any ridge.
                const double lower = !upright ? 1 : wall.height(1) > 0 ? 0.4 : 0.1;
                CHECK(kept > on_map - lower);
                if (SIZE / cells < (upright ? 6 : 12)) continue;
                CHECK(kept > on_map - 0.05);
                CHECK(drawn.plain < 0.75 * on_map); // control: means alone let it through
                CHECK(says(drawn.warned, "terrain[0].file: map.npy: "));
            }
}

TEST_CASE("maps on coarser grids: ridges, hills, noise and passes stay what their means say") {
    const auto hash = [](double x, double y) {
        return std::fmod(std::fabs(std::sin(12.9898 * x + 78.233 * y)) * 43758.5453, 1.0);
    };
    const std::pair<const char*, Ground> grounds[] = {
        {"level", [](double, double) { return 100.1; }},
        {"roof", [](double x, double y) { return 50 - 0.5 * from_line(x, y, 0); }},
        {"roof at 22.5 degrees", [](double x, double y) { return 50 - 0.5 * from_line(x, y, 22.5); }},
        {"roof at 45 degrees", [](double x, double y) { return 50 - 0.5 * from_line(x, y, 45); }},
        {"hills", [](double x, double y) { return 10 * std::sin(0.07 * x) * std::cos(0.05 * y) + 0.1 * x; }},
        {"steep hills", [](double x, double y) { return 60 + 40 * std::sin(0.07 * x + 0.03 * y) + 0.5 * y; }},
        {"noise", [&](double x, double y) { return hash(x, y); }},
        {"noisy slope", [&](double x, double y) { return 0.1 * x + 0.1 * hash(x, y); }},
        {"step", [](double x, double y) { return x + 0.3 * y < 80 ? 0.0 : 5.0; }},
    };
    for (const auto& [title, ground] : grounds)
        for (const int cells : {100, 64, 32, 20, 9}) {
            const std::string name = title;
            CAPTURE(name);
            CAPTURE(cells);
            CHECK(on_grid(ground, cells, cells).warned == "");
        }
    // A gap in a wall stays one.
    const Ground gap = [](double x, double y) { return from_line(x, y, 22.5) <= 1 && std::fabs(y - 40) > 4 ? 5.0 : 0.0; };
    for (const int cells : {64, 32, 20}) {
        const OnGrid drawn = on_grid(gap, cells, cells);
        CHECK(says(drawn.warned, "crests"));
        CHECK(spill(drawn.level.fields.terrain, cells, cells) < 2.5);
    }
}

TEST_CASE("maps on coarser grids: crests by what the level makes of the map's values, and only of the ground's height") {
    const Ground wall = [](double x, double y) { return from_line(x, y, 22.5) <= 0.75 ? 1.0 : 0.0; };
    CHECK(spill(on_grid(wall, 32, 32, R"(, "scale": 3, "offset": 2)").level.fields.terrain, 32, 32) == 5);
    CHECK(on_grid(wall, 32, 32, R"(, "scale": -3)").warned.empty()); // a ditch
    CHECK(on_grid(wall, 32, 32, R"(, "combine": "subtract")").warned.empty());
    CHECK(on_grid(wall, 32, 32, R"(, "combine": "min")").warned.empty());
    CHECK(on_grid(wall, 128, 128).warned.empty());
    CHECK(on_grid(wall, 256, 256).warned.empty());
    const Folder folder;
    std::vector<double> rough = samples_of(wall);
    folder.write("n.npy", map_files::npy(map_files::dictionary("<f8", "(128, 128)"), rough));
    const Level drawn =
        must(parse_level(level(R"("roughness": [{"file": "n.npy"}])", R"({"nx": 32, "ny": 32, "dx": 1})"), folder.path(), {}));
    CHECK(*std::max_element(drawn.settings.roughness.begin(), drawn.settings.roughness.end()) < 0.9f);
}

TEST_CASE("walls of sand thinner than a cell are named with width and cells, others are not") {
    const auto warned = [](const std::string& layer, double dx) {
        const std::string grid = R"({"nx": 20, "ny": 20, "dx": )" + std::to_string(dx) + "}";
        const Level drawn = must(parse_level(level("\"sand\": [" + layer + "]", grid), "", {}));
        const auto names = [](const std::string& warning) { return says(warning, "is thin for cells"); };
        const auto found = std::find_if(drawn.warnings.begin(), drawn.warnings.end(), names);
        return found == drawn.warnings.end() ? std::string() : *found;
    };
    const std::string ridge = R"({"shape": "ridge", "points": [[2, 3], [17, 12]], "width": 0.6, "height": 1)";
    const std::string box = R"({"shape": "box", "from": [2, 3], "to": [2.25, 12], "height": 1)";
    CHECK(says(warned(ridge + "}", 1), "sand[0]: a width of 0.6 m is thin for cells of 1 m"));
    CHECK(warned(ridge + "}", 0.5).empty());
    CHECK(says(warned(box + "}", 1), "sand[0]: a width of 0.25 m is thin for cells of 1 m"));
    CHECK(warned(box + R"(, "side_slope": 1})", 1).empty());
    const Folder folder;
    folder.write("s.npy", map_files::npy(map_files::dictionary("<f8", "(128, 128)"),
                                         samples_of([](double x, double y) { return from_line(x, y, 22.5) <= 0.75 ? 2 : 0; })));
    const auto map = [&](int cells) {
        const std::string grid = R"({"nx": )" + std::to_string(cells) + R"(, "ny": )" + std::to_string(cells) + R"(, "dx": 2})";
        return must(parse_level(level(R"("sand": [{"file": "s.npy"}])", grid), folder.path(), {}));
    };
    const Level coarse = map(32), own = map(128);
    const auto names = [](const std::string& warning) {
        return says(warning, "sand[0].file: s.npy: ") && says(warning, "its sand stands as wide as its cells there");
    };
    CHECK(std::any_of(coarse.warnings.begin(), coarse.warnings.end(), names));
    CHECK(std::none_of(own.warnings.begin(), own.warnings.end(), names));
    double volume = 0;
    for (const auto* drawn : {&coarse, &own})
        for (const float depth : drawn->fields.sand) volume += (drawn == &own ? -1 : 16) * static_cast<double>(depth);
    CHECK(std::fabs(volume) < 1e-2); // its volume stays
    CHECK(warned(R"({"shape": "plane", "height": 1}, )" + box + R"(, "combine": "subtract"})", 1).empty());
}
