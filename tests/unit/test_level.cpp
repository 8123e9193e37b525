// engine/level: shapes, maps, settings, series and overrides of level files.
#include "engine/level/level.hpp"
#include "engine/level/shapes.hpp"
#include "tests/unit/level_text.hpp"
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace wadi;
using namespace level_text;
using map_files::Folder;

namespace {

constexpr double STEP = 1.0 / (1 << 20); // the quantum of 16 m

} // namespace

TEST_CASE("level: a level without layers is empty ground") {
    const Level level = must(parse(""));
    CHECK(level.name == "test");
    CHECK(level.duration == 10);
    CHECK(level.fields.terrain.empty());
    CHECK(level.fields.velocity_x.empty());
    CHECK(level.warnings.empty());
    CHECK(level.settings.method.name == "robust");
}

TEST_CASE("level: comments are allowed") {
    CHECK(parse_level("// a level\n" + level_text::level("/* none */ \"gravity\": 1.62"), "", {}));
}

TEST_CASE("level: layers of water draw how deep it stands, pores hold their share of that") {
    const auto water = [](const std::string& layer, const std::string& more) {
        const Level level =
            must(parse(R"("sand": [{"shape": "plane", "height": 1}], "water": [{"shape": "plane", )" + layer + "}]" + more));
        return at(level, level.fields.water, 3, 3);
    };
    struct Drawn {
        std::string layer;
        double porous, whole; // water for a porosity of 0.4 and of 1 [m]
    };
    for (const Drawn& drawn : {Drawn{R"("wet": 0.5)", 0.2, 0.5}, Drawn{R"("wet": 1)", 0.4, 1},
                               Drawn{R"("surface": 0.5, "inside_sand": true)", 0.2, 0.5}, Drawn{R"("surface": 1.5)", 0.9, 1.5},
                               Drawn{R"("surface": 1.5, "inside_sand": true)", 0.9, 1.5}}) {
        CAPTURE(drawn.layer);
        const std::string porous = R"(, "material": {"porosity": 0.4})";
        CHECK(water(drawn.layer, porous) == doctest::Approx(drawn.porous).epsilon(1e-6));
        CHECK(water(drawn.layer, "") == doctest::Approx(drawn.whole).epsilon(1e-6));
        // One layer of water, and the paper, know no pores.
        CHECK(water(drawn.layer, porous + R"(, "effects": {"mixture": "off"})") == doctest::Approx(drawn.whole).epsilon(1e-6));
        CHECK(water(drawn.layer, porous + R"(, "method": {"name": "published"})") == doctest::Approx(drawn.whole).epsilon(1e-6));
    }
}

TEST_CASE("level: plane") {
    const Level level = must(parse(R"("terrain": [{"shape": "plane", "height": 2, "slope_x": 0.1, "slope_y": -0.2}])"));
    CHECK(at(level, level.fields.terrain, 0, 0) == doctest::Approx(2 + 0.05 - 0.1).epsilon(1e-6));
    CHECK(at(level, level.fields.terrain, 9, 7) == doctest::Approx(2 + 0.95 - 1.5).epsilon(1e-6));
}

TEST_CASE("level: box with vertical and with sloping sides") {
    const Level level = must(parse(R"("terrain": [{"shape": "box", "from": [2, 2], "to": [4, 3], "height": -3}],
        "sand": [{"shape": "box", "from": [2, 2], "to": [4, 4], "height": 1, "side_slope": 0.5}])"));
    CHECK(at(level, level.fields.terrain, 2, 2) == -3);
    CHECK(at(level, level.fields.terrain, 3, 2) == -3);
    CHECK(at(level, level.fields.terrain, 4, 2) == 0);
    CHECK(at(level, level.fields.terrain, 2, 3) == 0);
    CHECK(at(level, level.fields.sand, 3, 3) == 1);
    CHECK(at(level, level.fields.sand, 4, 3) == 0.75); // 0.5 m outside
    CHECK(at(level, level.fields.sand, 5, 3) == 0.25);
    CHECK(at(level, level.fields.sand, 6, 3) == 0);
    // Round the corner, the mean over the cell: the mean distance from the corner of a unit square is 0.765196 m.
    CHECK(at(level, level.fields.sand, 4, 4) == doctest::Approx(1 - 0.5 * 0.765196).epsilon(0.002));
}

TEST_CASE("level: cylinder and cone") {
    const Level level = must(parse(R"("sand": [{"shape": "cylinder", "center": [3.5, 3.5], "radius": 1.2, "height": 2}],
        "terrain": [{"shape": "cone", "center": [6.5, 3.5], "radius": 2, "height": 4}])"));
    CHECK(at(level, level.fields.sand, 3, 3) == 2);
    // Of the cell beside it the disc covers 0.5 sqrt(R^2 - 1/4) + R^2 asin(1/(2 R)) - 1/2.
    CHECK(at(level, level.fields.sand, 4, 3) ==
          doctest::Approx(2 * (0.5 * std::sqrt(1.19) + 1.44 * std::asin(0.5 / 1.2) - 0.5)).epsilon(0.002));
    CHECK(at(level, level.fields.sand, 5, 3) == 0);
    CHECK(at(level, level.fields.terrain, 6, 3) == 4);
    CHECK(at(level, level.fields.terrain, 7, 3) == 2);
    CHECK(at(level, level.fields.terrain, 8, 3) == 0);
    const Level sloped = must(parse(R"("sand": [{"shape": "cone", "center": [6.5, 3.5], "side_slope": 2, "surface": 4}])"));
    CHECK(at(sloped, sloped.fields.sand, 7, 3) == 2);
    CHECK(at(sloped, sloped.fields.sand, 8, 3) == 0);
    const Level steep = must(parse(R"("sand": [{"shape": "cone", "center": [6.5, 3.5], "side_slope": 2, "height": 4}])"));
    CHECK(at(steep, steep.fields.sand, 7, 3) == 2);
    CHECK(at(steep, steep.fields.sand, 6, 3) == at(sloped, sloped.fields.sand, 6, 3));
    CHECK(at(steep, steep.fields.sand, 6, 3) ==
          doctest::Approx(4 - 2 * 0.382598).epsilon(0.002)); // mean distance from its middle
}

TEST_CASE("level: ridge along a line") {
    const Level level = must(parse(R"("terrain": [{"shape": "ridge", "points": [[1.5, 2.5], [5.5, 2.5], [5.5, 6.5]],
        "width": 1, "height": 2, "side_slope": 1}])"));
    CHECK(at(level, level.fields.terrain, 1, 2) == 2);
    CHECK(at(level, level.fields.terrain, 4, 2) == 2);
    CHECK(at(level, level.fields.terrain, 5, 6) == 2);
    CHECK(at(level, level.fields.terrain, 3, 3) == 1.5);
    CHECK(at(level, level.fields.terrain, 3, 0) == 0.5);
    CHECK(at(level, level.fields.terrain, 8, 5) == 0);
    CHECK(at(level, level.fields.terrain, 0, 2) == 1.5); // the end is round
}

TEST_CASE("level: noise is bounded, seeded and repeatable") {
    const auto noise = [](const std::string& more) {
        return must(parse(R"("terrain": [{"shape": "noise", "amplitude": 0.5, "wavelength": 3, "octaves": 4)" + more + "}]"))
            .fields.terrain;
    };
    const auto first = noise("");
    CHECK(first == noise(R"(, "seed": 0)"));
    CHECK(first != noise(R"(, "seed": 1)"));
    const auto [low, high] = std::minmax_element(first.begin(), first.end());
    CHECK(*low >= -0.5f);
    CHECK(*high <= 0.5f);
    CHECK(*high - *low > 0.1f);
    // From a second implementation in Python: a level must look the same in every build.
    CHECK(value_noise(0, 0, 1) == doctest::Approx(0.6748656141));
    CHECK(value_noise(-3.25, 7.5, 42) == doctest::Approx(-0.2082546954));
    // Continuous across lattice lines.
    CHECK(value_noise(2 - 1e-9, 0.3, 5) == doctest::Approx(value_noise(2 + 1e-9, 0.3, 5)).epsilon(1e-6));
}

TEST_CASE("level: a ridge's segments near a place give the bits of all its segments") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-5, 25);
    std::size_t near_ones = 0, all = 0;
    for (int n = 0; n < 300; ++n) {
        Shape ridge;
        ridge.kind = ShapeKind::ridge;
        ridge.width = 0.5;
        ridge.side_slope = 1;
        for (int k = 0; k < 1 + n % 12; ++k) ridge.points.push_back({std::round(place(random)), std::round(place(random))});
        const double reach = n % 3 == 0 ? 4 : 0.3;
        const Point middle = {place(random), place(random)};
        const auto segments = segments_near(ridge, middle, reach);
        near_ones += segments.size();
        all += ridge.points.size() - 1;
        std::vector<double> x, heights(50);
        for (int k = 0; k < 50; ++k) {
            const double along = reach * (k / 24.5 - 1), across = std::sqrt(std::max(reach * reach - along * along, 0.0));
            x.push_back(middle[0] + along);
            for (const double y : {middle[1], middle[1] - across, middle[1] + across})
                REQUIRE(rim_distance(ridge, x.back(), y, segments) == rim_distance(ridge, x.back(), y));
        }
        relative_heights(ridge, x, middle[1], heights);
        for (std::size_t k = 0; k < x.size(); ++k) REQUIRE(heights[k] == std::min(-rim_distance(ridge, x[k], middle[1]), 0.0));
    }
    CHECK(near_ones < all / 2);
}

TEST_CASE("level: a row of noise has the bits of its places") {
    Shape noise;
    noise.kind = ShapeKind::noise;
    noise.amplitude = 2;
    noise.wavelength = 0.7;
    noise.octaves = 3;
    noise.seed = 9;
    std::vector<double> x, row(200);
    for (int k = 0; k < 200; ++k) x.push_back(-1 + 0.013 * k);
    relative_heights(noise, x, 3.3, row);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double by_octave = value_noise(x[k] * (1 / 0.7), 3.3 * (1 / 0.7), 9) +
                                 0.5 * value_noise(x[k] * (1 / 0.7 * 2), 3.3 * (1 / 0.7 * 2), 10) +
                                 0.25 * value_noise(x[k] * (1 / 0.7 * 4), 3.3 * (1 / 0.7 * 4), 11);
        REQUIRE(row[k] == 2 * by_octave / 1.75);
        REQUIRE(row[k] == relative_height(noise, x[k], 3.3, {}));
    }
}

TEST_CASE("level: layers combine in order and sand never goes below zero") {
    const auto cell = [](const std::string& combine, const std::string& field) {
        const Level level = must(parse("\"" + field + R"(": [{"shape": "plane", "height": 2}, {"shape": "box", "from": [0, 0],
            "to": [5, 8], "height": 3, "combine": ")" +
                                       combine + "\"}]"));
        const auto& values = field == "sand" ? level.fields.sand : level.fields.terrain;
        CHECK(at(level, values, 7, 3) == 2);
        return at(level, values, 2, 3);
    };
    CHECK(cell("add", "terrain") == 5);
    CHECK(cell("set", "terrain") == 3);
    CHECK(cell("max", "terrain") == 3);
    CHECK(cell("subtract", "terrain") == -1);
    CHECK(cell("subtract", "sand") == 0);
    const Level level = must(parse(R"("terrain": [{"shape": "plane", "height": 2},
        {"shape": "plane", "height": 1, "combine": "min"}])"));
    CHECK(at(level, level.fields.terrain, 0, 0) == 1);
}

TEST_CASE("level: where present") {
    const Level level = must(parse(R"("sand": [{"shape": "box", "from": [0, 0], "to": [5, 8], "height": 1},
        {"shape": "plane", "height": 0.5, "where": "present"}])"));
    CHECK(at(level, level.fields.sand, 2, 2) == 1.5);
    CHECK(at(level, level.fields.sand, 7, 2) == 0);
}

TEST_CASE("level: surface fills up to an absolute elevation, flat to the bit") {
    const Level level = must(parse(R"("terrain": [{"shape": "plane", "height": 0.3, "slope_x": 0.2}],
        "sand": [{"shape": "box", "from": [2, 0], "to": [5, 8], "height": 0.7}],
        "water": [{"shape": "plane", "surface": 2.1234567}])"));
    double surface = 0;
    for (int i = 0; i < 5; ++i) {
        const double ground = at(level, level.fields.terrain, i, 4); // sand in the lake takes no room from the water
        const double here = ground + at(level, level.fields.water, i, 4);
        if (i > 0) CHECK(here == surface);
        surface = here;
        CHECK(ground / STEP == std::round(ground / STEP));
    }
    CHECK(surface == doctest::Approx(2.1234567));
    CHECK(at(level, level.fields.water, 9, 4) == 0); // ground above
    const Level island = must(parse(R"("sand": [{"shape": "box", "from": [2, 0], "to": [5, 8], "height": 3}],
        "water": [{"shape": "plane", "surface": 2}])"));
    CHECK(at(island, island.fields.water, 3, 4) == 0); // sand above: dry
    CHECK(at(island, island.fields.water, 1, 4) == 2);
}

TEST_CASE("level: a dam with a flat crest across a valley") {
    const Level level = must(parse(R"("terrain": [{"shape": "plane", "height": 4, "slope_x": -0.5},
        {"shape": "plane", "height": -1, "slope_x": 0.5, "combine": "max"}],
        "sand": [{"shape": "ridge", "points": [[0, 4.5], [10, 4.5]], "width": 1, "side_slope": 1, "surface": 2.5}])"));
    const auto top = [&](int i, int j) { return at(level, level.fields.terrain, i, j) + at(level, level.fields.sand, i, j); };
    CHECK(top(4, 4) == 2.5);
    CHECK(top(5, 4) == 2.5);
    // Beside the crest the side falls from 0.75 m above the ground's mean to nothing over 0.75 of the cell.
    CHECK(top(4, 5) == 1.75 + 0.75 * 0.75 / 2);
    CHECK(at(level, level.fields.sand, 0, 4) == 0); // the valley side is higher
    CHECK(top(0, 4) == 3.75);
}

TEST_CASE("level: a surface inside sand fills the pores of a dune that stands above it") {
    const auto drawn = [](const std::string& key) {
        return must(parse(R"("terrain": [{"shape": "plane", "height": 0.25, "slope_x": 0.125}],
            "sand": [{"shape": "box", "from": [3, 0], "to": [6.5, 8], "height": 2}, {"shape": "box", "from": [8, 0], "to": [9, 8], "height": 0.1}],
            "water": [{"shape": "plane", "surface": 1.25)" +
                          key + "}]"));
    };
    const Level lake = drawn(R"(, "inside_sand": true)"), dry = drawn("");
    for (int i = 0; i < 10; ++i) {
        CAPTURE(i);
        const double ground = at(lake, lake.fields.terrain, i, 4), water = at(lake, lake.fields.water, i, 4);
        CHECK(ground + water == std::max(ground, 1.25));                                     // to the bit
        CHECK(at(dry, dry.fields.water, i, 4) == ((i >= 3 && i < 7) || i == 9 ? 0 : water)); // where sand stands above
    }
    CHECK(says(message(parse(R"("water": [{"shape": "plane", "height": 1, "inside_sand": true}])")), "inside_sand"));
    CHECK(says(message(parse(R"("sand": [{"shape": "plane", "surface": 1, "inside_sand": true}])")), "inside_sand"));
}

TEST_CASE("level: surface cuts down with min") {
    const Level level = must(parse(R"("sand": [{"shape": "plane", "height": 3},
        {"shape": "box", "from": [0, 0], "to": [5, 8], "surface": 1, "combine": "min"}])"));
    CHECK(at(level, level.fields.sand, 1, 1) == 1);
    CHECK(at(level, level.fields.sand, 8, 1) == 3);
}

TEST_CASE("level: wet sand holds a share of its depth") {
    const Level level = must(parse(R"("sand": [{"shape": "cylinder", "center": [5, 4], "radius": 2, "height": 2}],
        "water": [{"shape": "plane", "wet": 0.25}, {"shape": "box", "from": [0, 0], "to": [10, 1], "surface": 1}])"));
    CHECK(at(level, level.fields.water, 5, 4) == 0.5);
    CHECK(at(level, level.fields.water, 0, 4) == 0);
    CHECK(at(level, level.fields.water, 0, 0) == 1);
}

TEST_CASE("level: settings by name") {
    const Level level = must(parse(R"("gravity": 1.62, "duration": 3, "description": "d",
        "material": {"friction": 0.7, "saturation": [0.1, 0.2, 0.5], "bed_friction": 0.02},
        "method": {"name": "robust", "substeps": 2, "outflow_limiter": false, "quantum": 0, "saturation_smoothing": 1,
                   "water_transport_order": 2, "sand_transport_order": 2},
        "sides": {"east": {"kind": "level", "value": 2, "from": 1, "to": 3}, "north": {"kind": "outflow"}},
        "sources": [{"shape": "point", "center": [1, 2], "rate": -0.5, "material": "sand"},
                    {"shape": "box", "from": [1, 2], "to": [3, 4], "rate": [[0, 1], [2, 0]], "velocity": [0, -4]}],
        "rain": 1e-5, "effects": {"cohesion": "off", "mixture": "on", "drag": "auto"})"));
    const Settings& s = level.settings;
    CHECK(s.gravity == 1.62);
    CHECK(s.material.friction == 0.7);
    CHECK(s.material.saturation[2] == 0.5);
    CHECK(s.material.young_modulus == 2e5);
    CHECK(s.method.substeps == 2);
    CHECK(!s.method.outflow_limiter);
    CHECK(s.method.saturation_smoothing == 1);
    CHECK(s.method.water_transport_order == 2);
    CHECK(s.method.sand_transport_order == 2);
    CHECK(s.sides[1].kind == SideKind::level);
    CHECK(s.sides[1].to == 3);
    CHECK(s.sides[1].value.at(5) == 2);
    CHECK(s.sides[3].kind == SideKind::outflow);
    CHECK(s.sides[0].kind == SideKind::wall);
    REQUIRE(s.sources.size() == 2);
    CHECK(s.sources[0].material == SourceMaterial::sand);
    CHECK(s.sources[0].rate.at(0) == -0.5);
    CHECK(s.sources[1].box == std::array<double, 4>{1, 2, 3, 4});
    CHECK(s.sources[1].set_velocity);
    CHECK(s.sources[1].rate.at(1) == 0.5);
    CHECK(s.rain.at(1) == 1e-5);
    REQUIRE(s.effects.size() == 3);
    CHECK(std::find(s.effects.begin(), s.effects.end(), std::pair{std::string("cohesion"), Force::off}) != s.effects.end());
}

TEST_CASE("level: a series from a file") {
    const Folder folder;
    folder.write("rain.csv", std::string("time [s], rain [m/s]\r\n# storm\n0, 0\r\n10,1e-4\n\n20,0"));
    const Level level = must(parse(R"("rain": {"file": "rain.csv"})", folder.path()));
    CHECK(level.settings.rain.samples.size() == 3);
    CHECK(level.settings.rain.at(15) == doctest::Approx(5e-5));
}

TEST_CASE("level: size override keeps the length in x and stretches y") {
    const std::string rest = R"("terrain": [{"shape": "box", "from": [0, 4], "to": [10, 8], "height": 1}],
        "sides": {"west": {"kind": "outflow", "from": 4}, "south": {"kind": "outflow", "from": 4}},
        "sources": [{"shape": "disc", "center": [5, 2], "radius": 1.5, "rate": 1}, {"shape": "box", "from": [1, 2], "to": [3, 4], "rate": 1}])";
    LevelOverrides overrides;
    overrides.size = {20, 32}; // dx 0.5, length in y 16 m instead of 8 m
    const Level level = must(parse(rest, "", overrides));
    CHECK(level.settings.grid.dx == 0.5);
    CHECK(level.settings.dt == doctest::Approx(0.005));
    CHECK(at(level, level.fields.terrain, 3, 15) == 0);
    CHECK(at(level, level.fields.terrain, 3, 16) == 1);
    CHECK(level.settings.sides[0].from == 8);
    CHECK(level.settings.sides[2].from == 4);
    CHECK(level.settings.sources[0].center[1] == 4);
    CHECK(level.settings.sources[0].radius == 1.5);
    CHECK(level.settings.sources[1].box == std::array<double, 4>{1, 4, 3, 8});
    overrides.dt = 0.02;
    overrides.method = "robust";
    CHECK(must(parse(rest, "", overrides)).settings.dt == 0.02);
}

TEST_CASE("level: a method brings its own settings; keys beside it and an override change them") {
    const Method published = must(parse(R"("method": {"name": "published", "strain_transport": "direct", "velocity_clamp": 0.5,
                                                        "substeps": 2})"))
                                 .settings.method;
    CHECK(published.published());
    CHECK(published.strain_transport == StrainTransport::direct);
    CHECK(!published.outflow_limiter);
    CHECK(published.gravity_cap == 0);
    CHECK(published.velocity_clamp == 0.5); // in any order of the keys
    CHECK(published.substeps == 2);
    LevelOverrides overrides;
    overrides.method = "published";
    const Method other = must(parse(R"("method": {"substeps": 2, "largest_height": 32})", "", overrides)).settings.method;
    CHECK(other.published());
    CHECK(other.strain_transport == StrainTransport::polar);
    CHECK(other.velocity_clamp == 0.25);
    CHECK(other.substeps == 2);
    CHECK(other.largest_height == 32);
    const std::string tuned = R"("method": {"name": "published", "velocity_clamp": 0.5})";
    CHECK(must(parse(tuned, "", overrides)).settings.method.velocity_clamp == 0.5); // the level's own method stays as it is
    overrides.method = "robust";
    const Method back = must(parse(tuned, "", overrides)).settings.method;
    CHECK(!back.published());
    CHECK(back.velocity_clamp == Method{}.velocity_clamp);
    CHECK(back.outflow_limiter);
}

TEST_CASE("level: an accuracy preset scales cells and time step and sets the substeps; an override wins, so does a size") {
    const Level plain = must(parse(R"("method": {"substeps": 5})"));
    const Level draft = must(parse(R"("accuracy": "draft", "method": {"substeps": 5})"));
    CHECK(draft.settings.grid.nx == (plain.settings.grid.nx + 1) / 2);
    CHECK(draft.settings.grid.nx * draft.settings.grid.dx == doctest::Approx(plain.settings.grid.nx * plain.settings.grid.dx));
    CHECK(draft.settings.dt / draft.settings.grid.dx == doctest::Approx(plain.settings.dt / plain.settings.grid.dx));
    CHECK(plain.settings.method.substeps == 5);
    CHECK(draft.settings.method.substeps == 2);
    LevelOverrides overrides;
    overrides.accuracy = "accurate";
    const Level accurate = must(parse(R"("accuracy": "draft")", "", overrides));
    CHECK(accurate.settings.grid.nx == 2 * plain.settings.grid.nx);
    CHECK(accurate.settings.method.water_transport_order == 2);
    CHECK(draft.settings.method.water_transport_order == 1);
    overrides = {};
    CHECK(must(parse(R"("accuracy": "draft", "method": {"water_transport_order": 2})")).settings.method.water_transport_order ==
          2);
    overrides.size = {12, 8};
    CHECK(must(parse(R"("accuracy": "draft")", "", overrides)).settings.grid.nx == 12);
    overrides = {};
    overrides.accuracy = "fine";
    const Level fine = must(parse(R"("fine_grid": [48, 36], "method": {"substeps": 5})", "", overrides));
    CHECK(fine.settings.grid.nx == 48);
    CHECK(fine.settings.grid.ny == 36);
    CHECK(fine.settings.dt / fine.settings.grid.dx == doctest::Approx(plain.settings.dt / plain.settings.grid.dx));
    CHECK(fine.settings.method.substeps == 5);
    CHECK(must(parse("", "", overrides)).settings.grid.nx == plain.settings.grid.nx); // names no finer one
    CHECK(must(parse(R"("accuracy": "draft")", "", overrides)).settings.grid.nx == draft.settings.grid.nx); // nor does this one
    CHECK(must(parse(R"("fine_grid": [48, 36])")).settings.grid.nx == plain.settings.grid.nx);
    CHECK(parse(R"("fine_grid": [48, 36.5])").status().message.find("fine_grid: must be whole numbers") != std::string::npos);
    overrides.accuracy = "exact";
    const auto refused = parse("", "", overrides);
    REQUIRE_FALSE(refused);
    CHECK(refused.status().message.find("\"exact\" is not known") != std::string::npos);
}

TEST_CASE("level: variants are merged in by name") {
    const std::string rest = R"("material": {"friction": 0.4, "young_modulus": 1e5}, "sand": [{"shape": "plane", "height": 1}],
        "variants": {"slippery": {"material": {"friction": 0.1}}, "bare": {"sand": [], "material": null}})";
    const Level plain = must(parse(rest));
    CHECK(plain.variants == std::vector<std::string>{"bare", "slippery"});
    CHECK(plain.settings.material.friction == 0.4);
    LevelOverrides overrides;
    overrides.variant = "slippery";
    const Level slippery = must(parse(rest, "", overrides));
    CHECK(slippery.settings.material.friction == 0.1);
    CHECK(slippery.settings.material.young_modulus == 1e5);
    CHECK(slippery.fields.sand == plain.fields.sand);
    CHECK(slippery.name == plain.name + ", slippery");
    overrides.variant = "bare";
    const Level bare = must(parse(rest, "", overrides));
    CHECK(bare.fields.sand.empty());
    CHECK(bare.settings.material.friction == Material{}.friction);
}

TEST_CASE("level: wrong variants") {
    const auto with = [](const std::string& rest, const char* variant) {
        LevelOverrides overrides;
        if (variant != nullptr) overrides.variant = variant;
        const auto level = parse(rest, "", overrides);
        CHECK_FALSE(level);
        return message(level);
    };
    const std::string two = R"("variants": {"slippery": {"material": {"friction": -1}}, "bare": {"sand": []}})";
    CHECK(says(with(two, "slipery"), "variant: \"slipery\" is not known, did you mean \"slippery\"?"));
    CHECK(says(with("", "bare"), "the level has no variants"));
    CHECK(says(with(two, "slippery"), "material.friction"));
    CHECK(says(with(R"("variants": [])", nullptr), "variants: want an object"));
    CHECK(says(with(R"("variants": {"a": 3})", nullptr), "variants.a: want an object, found 3"));
    CHECK(says(with(R"("variants": {"a": {"name": "b"}})", nullptr), "variants.a.name: a variant cannot change it"));
}

TEST_CASE("level: wrong overrides") {
    const auto with = [](const LevelOverrides& overrides) {
        const auto level = parse("", "", overrides);
        CHECK((!level && level.status().code == Code::bad_argument));
        return message(level);
    };
    LevelOverrides overrides;
    overrides.size = {0, 10};
    CHECK(says(with(overrides), "size: 0 is outside 1 ... 16384"));
    overrides.size = {10, 20000};
    CHECK(says(with(overrides), "size: 20000"));
    overrides.size.reset();
    overrides.dt = 0;
    CHECK(says(with(overrides), "dt: 0 is outside"));
    overrides.dt.reset();
    overrides.method = "publisht";
    CHECK(says(with(overrides), "method: \"publisht\" is not known, did you mean \"published\"?"));
}
