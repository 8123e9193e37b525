// Layers that lie where the ground is this high or that steep: volumes on every grid and turned, bounds, lakes, what is refused.
#include "engine/level/level.hpp"
#include "tests/unit/level_text.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace wadi;
using namespace level_text;

namespace {

/// Value of a field at a place [m].
double at_place(const Level& level, const std::vector<float>& field, double x, double y) {
    const double dx = level.settings.grid.dx;
    return at(level, field, static_cast<int>(x / dx), static_cast<int>(y / dx));
}

} // namespace

TEST_CASE("masks: a band of sand between two elevations has its volume on every grid, whichever way the ground falls") {
    for (const int fine : {2, 3, 8}) {
        const Level along = drawn(R"("terrain": [{"shape": "plane", "height": 0, "slope_x": 0.2}],
            "sand": [{"shape": "plane", "height": 0.5, "where": {"elevation": [0.45, 1.13]}}])",
                                  fine);
        CHECK(volume(along, along.fields.sand) == doctest::Approx(0.5 * 8 * (1.13 - 0.45) / 0.2).epsilon(1e-3));
        CHECK(at_place(along, along.fields.sand, 1.2, 4) == 0);
        CHECK(at_place(along, along.fields.sand, 4, 4) == 0.5);
        CHECK(at_place(along, along.fields.sand, 6.8, 4) == 0);
        // A hill: a ring between two heights of a cone.
        const Level ring = drawn(R"("terrain": [{"shape": "cone", "center": [5, 4], "height": 2, "radius": 3.5}],
            "sand": [{"shape": "plane", "height": 0.5, "where": {"elevation": [0.4, 1.2]}}])",
                                 fine);
        const double outer = 3.5 * (1 - 0.4 / 2), inner = 3.5 * (1 - 1.2 / 2);
        CHECK(volume(ring, ring.fields.sand) ==
              doctest::Approx(0.5 * std::numbers::pi * (outer * outer - inner * inner)).epsilon(fine == 8 ? 0.005 : 0.04));
    }
}

TEST_CASE("masks: sand lies where it is flat, water where the sand's surface is low; only where there is some") {
    // Level in the west, 0.5 steep in the east.
    const std::string ground =
        R"("terrain": [{"shape": "plane", "slope_x": 0.5, "height": -2.5}, {"shape": "plane", "height": 0, "combine": "max"}])";
    const Level flat = drawn(ground + R"(, "sand": [{"shape": "plane", "height": 1, "where": {"slope": [0, 0.3]}}])", 4);
    CHECK(at_place(flat, flat.fields.sand, 2, 4) == 1);
    CHECK(at_place(flat, flat.fields.sand, 8, 4) == 0);
    const Level steep = drawn(ground + R"(, "sand": [{"shape": "plane", "height": 1, "where": {"slope": [0.3, 1000]}}])", 4);
    CHECK(at_place(steep, steep.fields.sand, 2, 4) == 0);
    CHECK(at_place(steep, steep.fields.sand, 8, 4) == 1);
    // Sand counts as ground under water: 1 m of it in the west.
    const Level damp = drawn(ground + R"(, "sand": [{"shape": "box", "from": [0, 0], "to": [4, 8], "height": 1}],
        "water": [{"shape": "plane", "wet": 0.25, "where": {"elevation": [0.5, 1.5]}}])",
                             4);
    CHECK(at_place(damp, damp.fields.water, 2, 4) == 0.25);
    const Level dry = drawn(ground + R"(, "sand": [{"shape": "box", "from": [0, 0], "to": [4, 8], "height": 1}],
        "water": [{"shape": "plane", "wet": 0.25, "where": {"elevation": [-0.5, 0.5]}}])",
                            4);
    CHECK(at_place(dry, dry.fields.water, 2, 4) == 0);
    const Level both = drawn(ground + R"(, "sand": [{"shape": "box", "from": [0, 0], "to": [4, 8], "height": 1},
        {"shape": "plane", "height": 0.5, "where": {"present": true, "elevation": [0, 0]}}])",
                             4);
    CHECK(at_place(both, both.fields.sand, 2, 4) == 1.5);
    CHECK(at_place(both, both.fields.sand, 4.6, 4) == 0); // as low, but bare
    // Half as much halfway between 0.9 and 1.1 of a bound.
    const Level fades = drawn(R"("terrain": [{"shape": "plane", "height": 0, "slope_x": 0.3}],
        "sand": [{"shape": "plane", "height": 1, "where": {"slope": [0, 0.3]}}])",
                              4);
    CHECK(at_place(fades, fades.fields.sand, 5, 4) == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("masks: a lake that a mask cuts is level; shapes are cut within cells as elsewhere") {
    const Level lake = drawn(R"("terrain": [{"shape": "plane", "height": 0, "slope_x": 0.2}],
        "water": [{"shape": "plane", "surface": 1.5, "where": {"elevation": [0.31, 1.07]}}])",
                             4);
    for (std::size_t n = 0; n < lake.fields.water.size(); ++n) {
        const float water = lake.fields.water[n];
        if (water != 0) CHECK(lake.fields.terrain[n] + water == doctest::Approx(1.5));
    }
    const std::string box = R"({"shape": "box", "from": [2.03, 1.41], "to": [7.38, 5.97], "height": 1.5)";
    const Level plain = drawn("\"sand\": [" + box + "}]", 4),
                masked = drawn("\"sand\": [" + box + R"(, "where": {"elevation": [-1, 1]}}])", 4),
                none = drawn("\"sand\": [" + box + R"(, "where": {"elevation": [1, 2]}}])", 4);
    CHECK(plain.fields.sand == masked.fields.sand);
    CHECK(volume(none, none.fields.sand) == 0);
    CHECK(std::any_of(none.warnings.begin(), none.warnings.end(),
                      [](const std::string& text) { return text.find("sand[0]: changes no cell") != std::string::npos; }));
}

TEST_CASE("masks: what is refused, by name") {
    const auto refuses = [](const std::string& where, const std::string& text) {
        const auto result = parse_level(level_text::level(R"("sand": [{"shape": "plane", "height": 1, "where": )" + where + "}]"),
                                        "", LevelOverrides{});
        REQUIRE_FALSE(result);
        CHECK_MESSAGE(result.status().message.find(text) != std::string::npos, result.status().message);
    };
    refuses("{}", "sand[0].where: needs \"elevation\" or \"slope\", each [least, most]");
    refuses(R"({"present": true})", "sand[0].where: needs \"elevation\" or \"slope\"");
    refuses(R"({"elevation": [2, 1]})",
            "sand[0].where.elevation: is [least, most]; the first number must not be above the second");
    refuses(R"({"elevation": 2})", "sand[0].where.elevation: ");
    refuses(R"({"slope": [-0.1, 1]})", "sand[0].where.slope[0]: -0.1 is outside 0 ... 1000");
    refuses(R"({"elevtion": [0, 1]})", "sand[0].where.elevtion: unknown key, did you mean \"elevation\"?");
    refuses(R"("presnt")", "did you mean \"present\"?");
    refuses("3", "sand[0].where: ");
    const auto terrain = parse_level(
        level_text::level(R"("terrain": [{"shape": "plane", "height": 1, "where": {"slope": [0, 1]}}])"), "", LevelOverrides{});
    REQUIRE_FALSE(terrain);
    CHECK(terrain.status().message.find("terrain[0].where: unknown key") != std::string::npos);
}
