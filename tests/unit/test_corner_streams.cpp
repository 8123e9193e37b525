// engine/level/corner_streams.hpp: ditches whose cells touch at a corner alone.
#include "engine/level/corner_streams.hpp"
#include "tests/unit/level_text.hpp"
#include <doctest/doctest.h>
#include <functional>

using namespace wadi;
using namespace level_text;

namespace {

/// The warnings of ground of 40 x 40 cells of 0.5 m into which rain falls.
std::string warned(const std::function<bool(int i, int j)>& ditch, double depth, bool rain = true) {
    Settings settings;
    settings.grid = {40, 40, 0.5};
    settings.dt = 0.01;
    if (rain) settings.rain.samples = {{0, 1e-5}};
    InitialFields fields;
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) fields.terrain.push_back(static_cast<float>(ditch(i, j) ? 1 - 0.001 * i : 1 + depth));
    std::vector<std::string> warnings;
    warn_corner_streams(settings, fields, warnings);
    return warnings.empty() ? std::string() : warnings[0];
}

} // namespace

TEST_CASE("a ditch one cell wide that goes over corners is named with its width, places and what it dams") {
    const auto diagonal = [](int i, int j) { return i == j && i >= 3 && i < 30; };
    const std::string said = warned(diagonal, 0.8);
    CHECK_MESSAGE(says(said, "a ditch one cell wide (0.5 m) goes over a corner between cells at 24 places"), said);
    CHECK_MESSAGE(says(said, "most at (14, 14) with 0.827 m"), said);
    CHECK(says(warned([](int i, int j) { return i == 39 - j; }, 0.8), "at 39 places"));
    // At 22.5 degrees or so: two cells along x, then a corner.
    CHECK(says(warned([](int i, int j) { return i / 2 == j; }, 0.8), "at 19 places"));
    CHECK(says(warned([](int i, int j) { return j == (i < 20 ? 5 : 6); }, 0.8), "at 1 place,"));
}

TEST_CASE("ditches that water runs along, low banks, rooms and hollows that touch, and dry levels are not named") {
    CHECK(warned([](int i, int j) { return i == j || i == j + 1; }, 0.8).empty());          // over sides of cells
    CHECK(warned([](int i, int j) { return j == 5 || i == 7; }, 0.8).empty());              // a crossing
    CHECK(warned([](int i, int j) { return std::abs(i - j) < 2; }, 0.8).empty());           // three cells wide
    CHECK(warned([](int i, int j) { return i == j; }, 0.08).empty());                       // banks of at most 0.12 m
    CHECK(warned([](int i, int j) { return (i < 20) == (j < 20); }, 0.8).empty());          // two rooms
    CHECK(warned([](int i, int j) { return i == j && (i == 9 || i == 10); }, 0.8).empty()); // two hollows
    CHECK(warned([](int i, int j) { return i == j; }, 0.8, false).empty());                 // no water
    CHECK(warned(
              [](int i, int j) { // a corner with a way round it
                  return j == (i < 20 ? 5 : 6) || (j == 3 && i > 16 && i < 23) || ((i == 17 || i == 22) && j > 2 && j < 6);
              },
              0.8)
              .empty());
}
