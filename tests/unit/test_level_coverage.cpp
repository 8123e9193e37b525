// Sand and water are drawn by area: volumes against closed forms, turned and mirrored shapes, and what layers make of a cell that
// an edge runs through.
#include "engine/level/level.hpp"
#include "tests/unit/level_text.hpp"
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <utility>

using namespace wadi;
using namespace level_text;

namespace {

constexpr double PI = std::numbers::pi;
constexpr double SMALLEST = 1.0 / (1 << 20); // the quantum of 16 m

std::string ridge(double angle) {
    const double x = 2 * std::cos(angle), y = 2 * std::sin(angle);
    const auto point = [](double east, double north) { return "[" + std::to_string(east) + ", " + std::to_string(north) + "]"; };
    return R"({"shape": "ridge", "width": 2, "height": 1.5, "points": [)" + point(5.03 - x, 4.01 - y) + ", " +
           point(5.03 + x, 4.01 + y) + "]}";
}

std::string sand(const std::string& layers) { return "\"sand\": [" + layers + "]"; }

} // namespace

TEST_CASE("coverage: shapes have their volume on every grid, straight and turned") {
    struct Case {
        std::string layer;
        double volume;
        int fine = 4; // beside the edges the middles of cells count: cones are right to (dx/radius)^2 / 4
    };
    const Case cases[] = {
        {R"({"shape": "cylinder", "center": [5.03, 4.01], "radius": 2, "height": 2})", 8 * PI},
        {R"({"shape": "cylinder", "center": [5.03, 4.01], "radius": 1, "height": 2, "side_slope": 1.3})",
         PI * 2 / 3 * (1 + (1 + 2 / 1.3) + std::pow(1 + 2 / 1.3, 2)), 8},
        {R"({"shape": "cone", "center": [5.03, 4.01], "radius": 3, "height": 2})", PI * 6, 8},
        {R"({"shape": "box", "from": [2.03, 1.41], "to": [7.38, 5.97], "height": 1.5})", 5.35 * 4.56 * 1.5},
        {ridge(0), 1.5 * (8 + PI)},
        {ridge(PI / 8), 1.5 * (8 + PI)},
        {ridge(PI / 4), 1.5 * (8 + PI)},
        {ridge(1), 1.5 * (8 + PI)},
    };
    for (const Case& one : cases)
        for (const int fine : {one.fine, 2 * one.fine}) {
            CAPTURE(one.layer);
            CAPTURE(fine);
            const Level level = drawn(sand(one.layer), fine);
            CHECK(volume(level, level.fields.sand) == doctest::Approx(one.volume).epsilon(0.001));
        }
}

TEST_CASE("coverage: the same volume in the middle of a cell as across the corner of four, and less than a cell is not lost") {
    for (const char* center : {"[5, 4]", "[5.5, 4.5]", "[5.3, 4.1]"})
        for (const double radius : {0.2, 0.45, 1.3}) {
            const Level level = drawn(sand(R"({"shape": "cylinder", "height": 1, "center": )" + std::string(center) +
                                           ", \"radius\": " + std::to_string(radius) + "}"),
                                      1);
            CHECK(volume(level, level.fields.sand) == doctest::Approx(PI * radius * radius).epsilon(0.02));
            for (const std::string& warning : level.warnings) CHECK_FALSE(says(warning, "changes no cell"));
        }
}

TEST_CASE("coverage: sides of boxes part cells where they run") {
    const Level level = drawn(sand(R"({"shape": "box", "from": [2.3, 2], "to": [4.45, 4.9], "height": 2})"), 1);
    CHECK(at(level, level.fields.sand, 1, 3) == 0);
    CHECK(at(level, level.fields.sand, 2, 3) == doctest::Approx(1.4).epsilon(1e-6));
    CHECK(at(level, level.fields.sand, 3, 3) == 2);
    CHECK(at(level, level.fields.sand, 4, 3) == doctest::Approx(0.9).epsilon(1e-6));
    CHECK(at(level, level.fields.sand, 4, 4) == doctest::Approx(0.81).epsilon(1e-6));
    CHECK(at(level, level.fields.sand, 5, 3) == 0);
}

TEST_CASE("coverage: layers meet within a cell as they do on a finer grid") {
    const auto at_edge = [](const std::string& combine) {
        const Level level = drawn(sand(R"({"shape": "box", "from": [1, 1], "to": [3.3, 7], "height": 2},
            {"shape": "box", "from": [3.3, 1], "to": [6, 7], "height": 1, "combine": ")" +
                                       combine + "\"}"),
                                  1);
        return at(level, level.fields.sand, 3, 3);
    };
    for (const char* combine : {"add", "set", "max"}) CHECK(at_edge(combine) == doctest::Approx(0.3 * 2 + 0.7 * 1).epsilon(1e-6));
    CHECK(at_edge("min") == doctest::Approx(0.3 * 2).epsilon(1e-6));
    CHECK(at_edge("subtract") == doctest::Approx(0.3 * 2).epsilon(1e-6));
    // A pit takes its own share out of what is there.
    const Level pit = drawn(sand(R"({"shape": "plane", "height": 1},
        {"shape": "cylinder", "center": [5.1, 4.2], "radius": 2, "height": 0, "combine": "set"})"),
                            2);
    CHECK(volume(pit, pit.fields.sand) == doctest::Approx(80 - 4 * PI).epsilon(0.001));
    // Present is what is there within the cell.
    const Level present = drawn(sand(R"({"shape": "box", "from": [1, 1], "to": [3.5, 7], "height": 2},
        {"shape": "plane", "height": 1, "where": "present"})"),
                                1);
    CHECK(at(present, present.fields.sand, 3, 3) == 1.5);
}

TEST_CASE("coverage: the rim of a wet pile is as wet as the pile, also where the outline is another one") {
    for (const char* wet :
         {R"({"shape": "cylinder", "center": [5.03, 4.01], "radius": 2, "wet": 0.25})", R"({"shape": "plane", "wet": 0.25})",
          R"({"shape": "box", "from": [2.71, 1.13], "to": [7.77, 6.91], "wet": 0.25})"}) {
        const Level level = drawn(
            sand(R"({"shape": "cylinder", "center": [5.03, 4.01], "radius": 2, "height": 2})") + ", \"water\": [" + wet + "]", 4);
        int partly = 0;
        for (std::size_t n = 0; n < level.fields.sand.size(); ++n) {
            const double depth = static_cast<double>(level.fields.sand[n]);
            CHECK(std::fabs(static_cast<double>(level.fields.water[n]) - 0.25 * depth) <= SMALLEST);
            partly += depth > 0 && depth < 2;
        }
        CHECK(partly > 30);
    }
}

TEST_CASE("coverage: a lake stays flat to the bit over shapes that cut its cells") {
    const Level level = drawn(R"("terrain": [{"shape": "plane", "height": 0.3, "slope_x": 0.01},
            {"shape": "cylinder", "center": [2.2, 2.2], "radius": 1.1, "height": 3, "combine": "max"}],
        "sand": [{"shape": "cylinder", "center": [5.03, 4.01], "radius": 2, "height": 0.7}],
        "water": [{"shape": "plane", "wet": 0.25}, {"shape": "plane", "surface": 2.1234567}])",
                              4);
    const double surface = std::round(2.1234567 / SMALLEST) * SMALLEST;
    for (std::size_t n = 0; n < level.fields.water.size(); ++n) {
        const double ground = static_cast<double>(level.fields.terrain[n]);
        if (ground < 3) CHECK(ground + static_cast<double>(level.fields.water[n]) == surface);
    }
}

TEST_CASE("coverage: a shore has the area of its outline") {
    const Level level = drawn(R"("water": [{"shape": "cylinder", "center": [5.03, 4.01], "radius": 3, "surface": 0.5}])", 4);
    CHECK(volume(level, level.fields.water) == doctest::Approx(0.5 * 9 * PI).epsilon(0.001));
}

TEST_CASE("coverage: mirrored and transposed drawings have mirrored and transposed bits") {
    const int size = 64; // cells of 1/8 m: positions are exact
    const auto draw = [&](int kind) {
        const auto point = [&](double x, double y) {
            if (kind == 1) x = 8 - x;
            if (kind == 2) y = 8 - y;
            if (kind == 3) std::swap(x, y);
            return "[" + std::to_string(x) + ", " + std::to_string(y) + "]";
        };
        const auto corners = [&](double west, double south, double east, double north) {
            if (kind == 1) west = 8 - std::exchange(east, 8 - west);
            if (kind == 2) south = 8 - std::exchange(north, 8 - south);
            const auto pair = [&](double x, double y) {
                if (kind == 3) std::swap(x, y);
                return "[" + std::to_string(x) + ", " + std::to_string(y) + "]";
            };
            return "\"from\": " + pair(west, south) + ", \"to\": " + pair(east, north);
        };
        const std::string text = R"({ "format_version": 1, "name": "test", "dt": 0.01, "grid": {"nx": 64, "ny": 64, "dx": 0.125},
            "sand": [{"shape": "box", "height": 1, )" +
                                 corners(1.34375, 1.21875, 4.296875, 2.03125) + R"(},
            {"shape": "cylinder", "radius": 1.3, "height": 0.7, "center": )" +
                                 point(3.5625, 2.15625) + R"(},
            {"shape": "cylinder", "radius": 0.8, "height": 0.9, "side_slope": 2, "combine": "max", "center": )" +
                                 point(5.5625, 5.03125) + R"(},
            {"shape": "ridge", "width": 0.4, "height": 0.5, "points": [)" +
                                 point(1, 7) + ", " + point(6.5, 3.25) + R"(]}],
            "water": [{"shape": "box", "wet": 0.3, )" +
                                 corners(0.53125, 0.1875, 3.71875, 6.90625) + R"(},
            {"shape": "cylinder", "radius": 2.1, "surface": 0.3, "center": )" +
                                 point(2.09375, 5.71875) + "}]}";
        const auto result = parse_level(text, "", {});
        REQUIRE_MESSAGE(result, message(result));
        return *result;
    };
    const Level straight = draw(0);
    for (int kind = 1; kind < 4; ++kind) {
        const Level other = draw(kind);
        int differ = 0;
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
                const int a = kind == 1 ? size - 1 - i : kind == 3 ? j : i, b = kind == 2 ? size - 1 - j : kind == 3 ? i : j;
                differ += at(straight, straight.fields.sand, i, j) != at(other, other.fields.sand, a, b);
                differ += at(straight, straight.fields.water, i, j) != at(other, other.fields.water, a, b);
            }
        CHECK_MESSAGE(differ == 0, "kind " << kind);
    }
    CHECK(volume(straight, straight.fields.sand) > 1);
    CHECK(volume(straight, straight.fields.water) > 1);
}

TEST_CASE("coverage: terrain keeps its height, so that a wall holds on every grid") {
    const Level level =
        drawn(R"("terrain": [{"shape": "box", "from": [4.4, 0], "to": [5.6, 8], "height": 2.5, "combine": "max"}])", 1);
    CHECK(at(level, level.fields.terrain, 4, 3) == 2.5);
    CHECK(at(level, level.fields.terrain, 5, 3) == 2.5);
    CHECK(at(level, level.fields.terrain, 3, 3) == 0);
}
