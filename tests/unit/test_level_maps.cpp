// engine/level: maps of every kind, velocities and roughness by shapes and maps, levels from a terrain map alone.
#include "engine/level/level.hpp"
#include "engine/settings/data/rain_map.hpp"
#include "tests/unit/level_text.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <doctest/doctest.h>

using namespace wadi;
using namespace level_text;
using map_files::Folder;

TEST_CASE("level: velocities by shape") {
    const Level level = must(parse(R"("velocities": [
        {"of": "water", "shape": "box", "from": [0, 0], "to": [5, 8], "velocity": [1, -2]},
        {"of": "sand", "shape": "cylinder", "center": [5, 4], "radius": 1, "velocity": [0, 3]}])"));
    CHECK(at(level, level.fields.velocity_x, 4, 4) == 1);
    CHECK(at(level, level.fields.velocity_y, 4, 4) == -2);
    CHECK(at(level, level.fields.velocity_x, 5, 4) == 0);
    CHECK(at(level, level.fields.sand_velocity_y, 5, 4) == 3);
    CHECK(at(level, level.fields.sand_velocity_x, 5, 4) == 0);
}

TEST_CASE("level: roughness by shapes and maps, added to that of the material and unrounded") {
    const Level level = must(parse(R"("material": {"manning": 0.02}, "roughness": [{"shape": "plane", "manning": 0.01},
        {"shape": "box", "from": [0, 0], "to": [5, 8], "manning": 0.05},
        {"shape": "cylinder", "center": [5, 4], "radius": 1, "manning": 0.1, "combine": "set"}])"));
    CHECK(at(level, level.settings.roughness, 8, 4) == doctest::Approx(0.01));
    CHECK(at(level, level.settings.roughness, 2, 2) == doctest::Approx(0.06));
    CHECK(at(level, level.settings.roughness, 4, 4) == doctest::Approx(0.1));
    CHECK(must(parse(R"("material": {"manning": 0.02})")).settings.roughness.empty());

    const Folder folder;
    folder.write("grey.png", map_files::png16(2, 2, {0, 65535, 65535, 0}));
    folder.write("n.npy", map_files::npy(map_files::dictionary("<f4", "(2, 2)"), std::vector<float>{0.03f, 0, 0.011f, 1}));
    const auto mapped = [&](const std::string& layer) {
        const auto text = level_text::level("\"roughness\": [" + layer + "]", R"({"nx": 2, "ny": 2, "dx": 1})");
        return must(parse_level(text, folder.path(), {})).settings.roughness;
    };
    CHECK(mapped(R"({"file": "n.npy"})") == std::vector<float>{0.03f, 0, 0.011f, 1});
    CHECK(mapped(R"({"file": "grey.png", "min": 0.25, "max": 0.5})") == std::vector<float>{0.5f, 0.25f, 0.25f, 0.5f});
    const auto refused = [&](const std::string& numbers) {
        const auto text =
            level_text::level(R"("roughness": [{"file": "n.npy", )" + numbers + "}]", R"({"nx": 2, "ny": 2, "dx": 1})");
        const auto parsed = parse_level(text, folder.path(), {});
        return parsed ? "" : parsed.status().message;
    };
    CHECK(refused(R"("scale": 1)").empty());
    CHECK_MESSAGE(says(refused(R"("offset": 0.5)"), "roughness[0]: manning: 1.5 is outside 0 ... 1 in cell (1, "),
                  refused(R"("offset": 0.5)"));
    CHECK_MESSAGE(says(refused(R"("offset": -0.25)"), "roughness[0]: manning: -0.2"), refused(R"("offset": -0.25)"));
}

TEST_CASE("level: a rain map by shapes and maps, none where nothing is drawn, within what may rain") {
    const Level level = must(parse(R"("rain": 0.01, "rain_map": [{"shape": "plane", "times": 0.5},
        {"shape": "box", "from": [0, 0], "to": [5, 8], "times": 2}])"));
    CHECK(at(level, level.settings.rain_map, 8, 4) == doctest::Approx(0.5));
    CHECK(at(level, level.settings.rain_map, 2, 2) == doctest::Approx(2.5));
    CHECK(rain_peak(level.settings) == doctest::Approx(2.5));
    const Level part = must(parse(R"("rain": 0.01, "rain_map": [{"shape": "box", "from": [0, 0], "to": [5, 8], "times": 2}])"));
    CHECK(at(part, part.settings.rain_map, 8, 4) == 0);
    CHECK(must(parse(R"("rain": 0.01)")).settings.rain_map.empty());
    CHECK(rain_peak(must(parse(R"("rain": 0.01)")).settings) == 1);
    const Level off =
        must(parse(R"("rain": 0.01, "effects": {"rain_map": "off"}, "rain_map": [{"shape": "plane", "times": 3}])"));
    CHECK(rain_peak(off.settings) == 1);
    const Folder folder;
    folder.write("mm.npy", map_files::npy(map_files::dictionary("<f4", "(2, 2)"), std::vector<float>{36, 0, 3.6f, 18}));
    const auto text =
        level_text::level(R"("rain": 1, "rain_map": [{"file": "mm.npy", "scale": 2.5e-7}])", R"({"nx": 2, "ny": 2, "dx": 1})");
    const auto mapped = must(parse_level(text, folder.path(), {})).settings;
    CHECK(rain_peak(mapped) == doctest::Approx(9e-6));
    CHECK(*std::max_element(mapped.rain_map.begin(), mapped.rain_map.end()) == doctest::Approx(9e-6));
    const auto refused = parse(R"("rain": 0.5, "rain_map": [{"shape": "plane", "times": 3}])");
    REQUIRE(!refused);
    CHECK_MESSAGE(says(refused.status().message, "rain_map: 3 times rain, 0.5 m/s, is above 1 m/s"), refused.status().message);
}

TEST_CASE("level: velocities from maps, each of one component") {
    Folder folder;
    std::vector<double> wave;
    for (int n = 0; n < 80; ++n) wave.push_back(0.25 * n);
    folder.write("wave.npy", map_files::npy(map_files::dictionary("<f8", "(8, 10)"), wave));
    const std::string maps = R"("velocities": [
        {"of": "water", "shape": "plane", "velocity": [7, 8]},
        {"of": "water", "component": "x", "file": "wave.npy"},
        {"of": "sand", "component": "y", "file": "wave.npy", "scale": -2, "offset": 1},
        {"of": "water", "shape": "box", "from": [0, 0], "to": [1, 1], "velocity": [-1, -1]}])";
    const Level level = must(parse(maps, folder.path()));
    CHECK(at(level, level.fields.velocity_x, 3, 2) == 0.25 * 23);
    CHECK(at(level, level.fields.velocity_y, 3, 2) == 8); // the map is of x alone
    CHECK(at(level, level.fields.velocity_x, 0, 0) == -1);
    CHECK(at(level, level.fields.sand_velocity_x, 9, 7) == 0);
    CHECK(at(level, level.fields.sand_velocity_y, 9, 7) == 1 - 2 * 0.25 * 79);
    CHECK(level.warnings.empty());

    LevelOverrides half;
    half.size = {5, 4};
    const Level coarse = must(parse(maps, folder.path(), half));
    CHECK(at(coarse, coarse.fields.velocity_x, 1, 1) == 0.25 * (22 + 23 + 32 + 33) / 4);

    folder.write("fast.npy", map_files::npy(map_files::dictionary("<f8", "(1, 1)"), std::vector<double>{10001}));
    CHECK(says(message(parse(R"("velocities": [{"of": "water", "component": "x", "file": "fast.npy"}])", folder.path())),
               "velocities[0]: velocity: 10001 is outside -10000 ... 10000 in cell (0, 0)"));
    CHECK(says(message(parse(R"("velocities": [{"of": "water", "file": "wave.npy"}])", folder.path())),
               "velocities[0].component: missing"));
}

TEST_CASE("level: maps") {
    const Folder folder;
    folder.write("grey.png", map_files::png16(2, 2, {0, 65535, 65535, 0})); // north row first
    folder.write("grey.r16", map_files::words({0, 65535, 65535, 0}, false));
    folder.write("row.raw", map_files::words({0, 32768, 65535}, false));
    folder.write("heights.npy", map_files::npy(map_files::dictionary("<f8", "(1, 2)"), std::vector<double>{1.5, -2}));
    const auto terrain = [&](const std::string& layer) {
        const auto level =
            parse_level(level_text::level("\"terrain\": [{" + layer + "}]", R"({"nx": 2, "ny": 2, "dx": 1})"), folder.path(), {});
        return must(level).fields.terrain;
    };
    CHECK(terrain(R"("file": "grey.png", "max": 4)") == std::vector<float>{4, 0, 0, 4});
    CHECK(terrain(R"("file": "grey.png", "min": 5, "max": 1)") == std::vector<float>{1, 5, 5, 1});
    CHECK(terrain(R"("file": "grey.r16", "scale": 2, "offset": 1)") == std::vector<float>{3, 1, 1, 3});
    CHECK(terrain(R"("file": "heights.npy")") == std::vector<float>{1.5, -2, 1.5, -2});
    CHECK(terrain(R"("file": "heights.npy", "scale": 2, "offset": -1)") == std::vector<float>{2, -5, 2, -5});
    CHECK(terrain(R"("file": "row.raw", "size": [3, 1], "max": 4)").size() == 4);
    folder.write("heights.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\n1 2\n3 4\n");
    CHECK(terrain(R"("file": "heights.asc")") == std::vector<float>{3, 4, 1, 2});
    CHECK(terrain(R"("file": "heights.asc", "scale": 2, "offset": -1)") == std::vector<float>{5, 7, 1, 3});

    const auto level = parse_level(level_text::level(R"("terrain": [{"shape": "plane", "height": 1}],
        "water": [{"file": "grey.png", "max": 4, "absolute": true}])",
                                                     R"({"nx": 2, "ny": 2, "dx": 1})"),
                                   folder.path(), {});
    CHECK(must(level).fields.water == std::vector<float>{3, 0, 0, 3});
}

TEST_CASE("level: from a terrain map alone") {
    const Folder folder;
    std::vector<std::uint16_t> grey(32 * 16, 100);
    grey[5 * 32 + 20] = 300; // row 5 from the north
    const auto path = folder.write("hill.png", map_files::png16(32, 16, grey));
    const Level level = must(level_from_terrain(path, {}));
    CHECK(level.name == "hill");
    CHECK(level.settings.grid.nx == 32);
    CHECK(level.settings.grid.dx == 1);
    CHECK(at(level, level.fields.terrain, 20, 10) == 4); // an eighth of the longer side
    CHECK(at(level, level.fields.terrain, 0, 0) == 0);
    CHECK(level.settings.material.manning == 0.03);
    CHECK(level.settings.rain.at(0) * level.duration / 2 == doctest::Approx(0.15)); // then it stops
    CHECK(level.settings.rain.at(0.51 * level.duration) == 0);
    for (const Side& side : level.settings.sides) CHECK(side.kind == SideKind::outflow);
    CHECK(level.warnings.empty());

    LevelOverrides overrides;
    overrides.size = {16, 8};
    CHECK(must(level_from_terrain(path, overrides)).settings.grid.dx == 2);

    const auto heights =
        folder.write("h.npy", map_files::npy(map_files::dictionary("<f4", "(1, 3)"), std::vector<float>{-5, 700, 2}));
    const Level tall = must(level_from_terrain(heights, {}));
    CHECK(at(tall, tall.fields.terrain, 1, 0) == 700);
    CHECK(at(tall, tall.fields.terrain, 0, 0) == doctest::Approx(-5).epsilon(1e-4));
    CHECK(tall.settings.method.largest_height >= 1050);

    CHECK(level_from_terrain(folder.file("none.png"), {}).status().code == Code::not_found);
    // Real sizes: 30 m cells in projected coordinates, heights in metres.
    const std::string header = "NCOLS 3\nNROWS 2\nXLLCENTER 512345.5\nYLLCENTER 5400000\nCELLSIZE 30\n";
    const Level real = must(level_from_terrain(folder.write("real.asc", header + "1400 1500 1450\n1300 1350 1250.5\n"), {}));
    CHECK(real.settings.grid.dx == 30);
    CHECK(real.settings.dt == doctest::Approx(0.6));
    CHECK(real.duration == doctest::Approx(1800));
    CHECK(real.settings.method.largest_height == 4096);
    CHECK(at(real, real.fields.terrain, 1, 1) == 1500); // the file's first row is the north
    CHECK(at(real, real.fields.terrain, 2, 0) == 1250.5);
    CHECK(real.origin == std::array<double, 2>{512345.5 - 15, 5400000 - 15}); // of the corner
    CHECK(real.warnings.empty());
    const std::string grid = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize ";
    const Level hole = must(level_from_terrain(folder.write("hole.asc", grid + "1\n7 -9999\n"), {}));
    CHECK(at(hole, hole.fields.terrain, 0, 0) == 7);
    CHECK(at(hole, hole.fields.terrain, 1, 0) < 6); // outside
    REQUIRE(hole.warnings.size() == 1);
    CHECK(says(hole.warnings[0], "1 cells without a height reach the map's rim: taken for outside"));
    const Level degrees = must(level_from_terrain(folder.write("degrees.asc", grid + "0.000277\n7 8\n"), {}));
    CHECK_MESSAGE(says(degrees.warnings.back(), "0.000277 looks like degrees"), degrees.warnings.back());
    CHECK(says(message(level_from_terrain(folder.write("wide.asc", grid + "20000\n7 8\n"), {})),
               "cellsize: 20000 is outside 0.0001 ... 10000 m"));

    const auto huge = folder.write("huge.npy", map_files::npy(map_files::dictionary("<f4", "(1, 1)"), std::vector<float>{1e30f}));
    CHECK(says(message(level_from_terrain(huge, {})), "more than a world holds"));
}

TEST_CASE("level maps: samples at corners, as said or guessed for 2^n + 1, keep a slope to its rims") {
    const Folder folder;
    std::vector<std::uint16_t> samples;
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 65; ++i) samples.push_back(static_cast<std::uint16_t>(i * 1000));
    folder.write("z.r16", map_files::words(samples, false));
    const auto ground = [&](const std::string& more, int nx, const LevelOverrides& overrides = {}) {
        const std::string size = std::to_string(nx);
        return must(parse_level(level(R"("terrain": [{"file": "z.r16", "max": 8.1919375)" + more + "}]",
                                      R"({"nx": )" + size + R"(, "ny": )" + size + R"(, "dx": 1})"),
                                folder.path(), overrides));
    };
    const Level guessed = ground("", 64);
    for (const int i : {0, 31, 63})
        CHECK(at(guessed, guessed.fields.terrain, i, 5) == doctest::Approx(0.125 * (i + 0.5)).epsilon(1e-5));
    REQUIRE(guessed.warnings.size() == 1);
    CHECK(says(guessed.warnings[0], "terrain[0].file: z.r16: 65 x 65 samples are taken for the corners of cells"));
    const Level said = ground(R"(, "samples": "corners")", 64);
    CHECK(said.fields.terrain == guessed.fields.terrain);
    CHECK(said.warnings.empty());
    const Level cells = ground(R"(, "samples": "cells")", 64);
    CHECK(at(cells, cells.fields.terrain, 0, 5) < 0.9 * 0.0625); // negative control
    CHECK(cells.warnings.empty());
    const Level own = ground("", 65); // a map of the level's own grid
    CHECK(at(own, own.fields.terrain, 64, 5) == doctest::Approx(8));
    CHECK(own.warnings.empty());
    LevelOverrides coarse;
    coarse.size = {13, 13};
    CHECK(ground("", 65, coarse).warnings.empty());
    CHECK(
        says(message(parse_level(level(R"("terrain": [{"file": "z.r16", "max": 1, "samples": "vertices"}])"), folder.path(), {})),
             "terrain[0].samples: \"vertices\" is not known"));
}

TEST_CASE("level maps: a shape that is thinner than its cells is named with its width, on the grid that it is drawn on") {
    const auto warned = [](const std::string& shape, std::optional<std::pair<int, int>> size = {}) {
        LevelOverrides overrides;
        overrides.size = size;
        const auto made = must(parse_level(level(R"("terrain": [{"height": 2, )" + shape + "}]"), "", overrides));
        return std::any_of(made.warnings.begin(), made.warnings.end(),
                           [](const auto& w) { return says(w, "is thin for cells of"); });
    };
    const std::string slanting = R"("shape": "ridge", "points": [[0, 2], [10, 6]], "width": )";
    CHECK(!warned(slanting + "1.5"));
    CHECK(warned(slanting + "1.3"));
    CHECK(warned(slanting + "1.5", std::pair{5, 4}));
    CHECK(!warned(R"("shape": "ridge", "points": [[0, 2], [10, 2]], "width": 1)"));
    CHECK(warned(R"("shape": "box", "from": [2, 0], "to": [2.9, 8])"));
    CHECK(warned(R"("shape": "box", "from": [2, 0], "to": [2.9, 8], "combine": "subtract")"));
    CHECK(!warned(R"("shape": "ridge", "points": [[0, 2], [10, 6]], "width": 0.5, "side_slope": 1)"));
}

namespace {

/// Cells below 1 m that can be reached from one of them over sides, or over corners as well.
std::size_t reached(const std::vector<float>& ground, int nx, int ny, std::size_t start, bool corners_too) {
    std::vector<char> seen(ground.size());
    std::vector<int> front{static_cast<int>(start)};
    seen[start] = 1;
    std::size_t count = 0;
    while (!front.empty()) {
        const int cell = front.back(), i = cell % nx, j = cell / nx;
        front.pop_back();
        ++count;
        for (int y = std::max(j - 1, 0); y <= std::min(j + 1, ny - 1); ++y)
            for (int x = std::max(i - 1, 0); x <= std::min(i + 1, nx - 1); ++x) {
                const auto next = static_cast<std::size_t>(y * nx + x);
                if ((x != i && y != j && !corners_too) || seen[next] != 0 || ground[next] > 1) continue;
                seen[next] = 1;
                front.push_back(y * nx + x);
            }
    }
    return count;
}

} // namespace

TEST_CASE("level maps: a wall of any width holds on every grid, and a ditch runs through") {
    const std::string from_rim_to_rim[] = {R"("points": [[-1, 1.3], [4.1, 2.2], [6.6, 6.9], [11, 7.1]])",
                                           R"("points": [[4.7, -1], [4.7, 9]])", R"("points": [[11, 1], [4.5, 9]])",
                                           R"("points": [[-1e9, 3.3], [1e9, 3.3]])"};
    for (const std::string& points : from_rim_to_rim)
        for (const char* width : {"0.01", "0.3", "1", "1.41"})
            for (const auto& [nx, ny] : {std::pair{10, 8}, {5, 4}, {33, 26}, {7, 20}, {6, 6}}) {
                CAPTURE(points + width);
                CAPTURE(nx);
                LevelOverrides overrides;
                overrides.size = {nx, ny};
                const auto drawn = [&](const std::string& before, const std::string& height) {
                    const std::string layers = "\"terrain\": [" + before + "{\"combine\": \"set\", \"height\": " + height +
                                               R"(, "shape": "ridge", )" + points + ", \"width\": " + width + "}]";
                    return must(parse_level(level(layers), "", overrides)).fields.terrain;
                };
                const auto wall = drawn("", "2"), ditch = drawn(R"({"shape": "plane", "height": 2}, )", "0");
                const auto low = [](const auto& field) {
                    return static_cast<std::size_t>(std::count(field.begin(), field.end(), 0.0f));
                };
                CHECK(reached(wall, nx, ny, 0, true) < low(wall)); // not over corners either
                const auto in_ditch = static_cast<std::size_t>(std::find(ditch.begin(), ditch.end(), 0.0f) - ditch.begin());
                CHECK(reached(ditch, nx, ny, in_ditch, false) == low(ditch));
            }
}
