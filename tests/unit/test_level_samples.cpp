// engine/level: warnings with their numbers, the levels that ship and their schema.
#include "engine/level/json_reader.hpp"
#include "engine/settings/data/setting_table.hpp"
#include "tests/unit/level_text.hpp"
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <set>

using namespace wadi;
using namespace level_text;

namespace {

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Json read_json(const std::filesystem::path& path) {
    auto json = parse_json(read_text(path));
    CHECK_MESSAGE(json, path.string() << ": " << json.status().message);
    return json ? json.value() : Json{};
}

/// All warnings of a level of 0.1 m cells and 0.009 s, one per line.
std::string warnings(const std::string& rest, double dt = 0.009) {
    const std::string text = R"({"format_version": 1, "name": "w", "grid": {"nx": 40, "ny": 30, "dx": 0.1}, "dt": )" +
                             std::to_string(dt) + ", " + rest + "}";
    const auto level = parse_level(text, "", {});
    CHECK_MESSAGE(level, message(level));
    std::string lines;
    if (level)
        for (const std::string& warning : level->warnings) lines += warning + "\n";
    return lines;
}

const char* const LOW_PILE = R"("sand": [{"shape": "cylinder", "center": [2, 1.5], "radius": 1, "height": 0.5}],
    "water": [{"shape": "plane", "wet": 0.25}], "material": {"young_modulus": 8e4, "cohesion_wet": 5e3, "cohesion_capillary": 5e3}, "gravity": 9.81)";

/// Of the levels that ship.
std::vector<std::string> names() {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(samples())) {
        if (std::filesystem::exists(entry.path() / "level.json")) found.push_back(entry.path().filename().string());
    }
    CHECK(found.size() >= 3);
    return found;
}

void collect_keys(const Json& value, std::set<std::string>& keys) {
    if (value.is_object())
        for (const auto& [key, child] : value.items()) {
            keys.insert(key);
            if (key != "variants") collect_keys(child, keys);
        }
    if (value.is_array())
        for (const Json& child : value) collect_keys(child, keys);
}

/// Every name under a "properties" anywhere in the schema.
void collect_properties(const Json& value, std::set<std::string>& names) {
    if (value.is_array())
        for (const Json& child : value) collect_properties(child, names);
    if (!value.is_object()) return;
    for (const auto& [key, child] : value.items()) {
        if (key == "properties")
            for (const auto& [name, property] : child.items()) names.insert(name);
        collect_properties(child, names);
    }
}

} // namespace

TEST_CASE("level warnings: sand of second order in water of first") {
    const auto ordered = [](const char* method) {
        return says(warnings(std::string(LOW_PILE) + R"(, "method": )" + method), "method.sand_transport_order: 2 with water");
    };
    CHECK(ordered(R"({"sand_transport_order": 2})"));
    CHECK_FALSE(ordered(R"({"sand_transport_order": 2, "water_transport_order": 2})"));
    CHECK_FALSE(ordered(R"({"water_transport_order": 2})"));
    CHECK_FALSE(
        says(warnings(R"("sand": [{"shape": "plane", "height": 1}], "method": {"sand_transport_order": 2})"), "moves sand"));
}

TEST_CASE("level warnings: none for a small pile of damp sand") { CHECK(warnings(LOW_PILE).empty()); }

TEST_CASE("level warnings: waves slower than they should be") {
    const std::string text = warnings(R"("water": [{"shape": "plane", "height": 2}])", 0.03);
    // (0.45 / 0.3)^2 / 9.81 = 0.229; 0.45 * 0.1 / sqrt(2 * 9.81) = 0.01016; 0.03 * sqrt(2 * 9.81) / 0.45 = 0.2953
    CHECK_MESSAGE(says(text, "dx 0.1 m, dt 0.03 s: water deeper than 0.229 m moves slower than it should, and the level has 2 m; "
                             "use dt <= 0.0101 s or dx >= 0.296 m"),
                  text);
    CHECK(warnings(R"("water": [{"shape": "plane", "height": 2}])", 0.0101).empty());
    CHECK(says(warnings(R"("water": [{"shape": "plane", "height": 2}], "method": {"gravity_cap": 0})", 0.03),
               "unstable while method.gravity_cap is off"));
}

TEST_CASE("level warnings: a front onto dry ground") {
    const std::string rest = R"("water": [{"shape": "box", "from": [0, 0], "to": [2, 3], "height": 0.5}])";
    // 2 sqrt(9.81 * 0.5) = 4.43; 0.35 * 0.1 / 0.009 = 3.89; 0.035 / 4.43 = 0.0079; 0.009 * 4.43 / 0.35 = 0.1139
    CHECK_MESSAGE(says(warnings(rest),
                       "water of 0.5 m beside dry ground should run at up to 4.43 m/s but is held at velocity_clamp dx/dt = "
                       "3.89 m/s; use dt <= 0.0079 s or dx >= 0.114 m"),
                  warnings(rest));
    CHECK(warnings(rest, 0.0079).empty());
    // The same water behind a bank that is higher than it.
    CHECK(warnings(rest + R"(, "terrain": [{"shape": "box", "from": [2, 0], "to": [4, 3], "height": 1}])").empty());
}

TEST_CASE("level warnings: a stream that will run at the clamp") {
    const std::string bed =
        R"("terrain": [{"shape": "plane", "height": 2, "slope_x": -0.5}], "material": {"bed_friction": 0.01})";
    const std::string rest = bed + R"(, "sources": [{"shape": "box", "from": [0, 1], "to": [0.2, 2], "rate": 1.5}])";
    // 0.3 m2/s: (9.81 * 0.3 * 0.5 / 0.01)^(1/3) = 5.28, but 1.9 m of fall give less further down: sqrt(2 * 9.81 * 1.9) = 6.1
    CHECK_MESSAGE(says(warnings(rest),
                       "sources[0]: 0.3 m2/s that run down a slope of 0.5 come to some 5.28 m/s but will be held at "
                       "velocity_clamp dx/dt = 3.89 m/s; use dt <= 0.00662 s"),
                  warnings(rest));
    CHECK(warnings(rest, 0.0066).empty());
    CHECK(warnings(bed + R"(, "sources": [{"shape": "box", "from": [0, 1], "to": [0.2, 2], "rate": 0.5}])").empty());
    // Up the slope it runs nowhere.
    CHECK(warnings(bed + R"(, "sources": [{"shape": "box", "from": [3.8, 1], "to": [4, 2], "rate": 1.5}])").empty());
    CHECK(says(warnings(bed + R"(, "sides": {"west": {"kind": "discharge", "value": 0.9}})"), "sides.west: 0.3 m2/s"));
}

TEST_CASE("level warnings: speed of a source, diffusion") {
    CHECK(says(warnings(R"("sources": [{"shape": "box", "from": [1, 1], "to": [2, 2], "rate": 1, "velocity": [0, -8]}])"),
               "sources[0].velocity: 8 m/s is more than velocity_clamp dx/dt = 3.88889 m/s; use dt <= 0.00437 s"));
    CHECK(says(warnings(R"("sources": [{"shape": "disc", "center": [1, 1], "radius": 0.04, "rate": 1}])"),
               "sources[0]: covers no cell centre"));
    CHECK(warnings(R"("sources": [{"shape": "disc", "center": [1.04, 1.04], "radius": 0.04, "rate": 1}])").empty());
    CHECK(says(warnings(R"("sources": [{"shape": "box", "from": [1.06, 1], "to": [1.14, 2], "rate": 1}])"),
               "covers no cell centre"));
    CHECK(
        says(warnings(R"("sand": [{"shape": "plane", "height": 0.5}], "material": {"young_modulus": 8e4, "diffusion_rate": 1})"),
             "material.diffusion_rate: 1 m2/s acts like 0.222222 m2/s"));
}

TEST_CASE("level warnings: a source that brings more than a cell takes") {
    const auto point = [](const char* discharge) {
        return warnings(std::string(R"("sources": [{"shape": "point", "center": [1, 1], "discharge": )") + discharge + "}]");
    };
    CHECK_MESSAGE(says(point("120"),
                       "sources[0].discharge: 120 m3/s on 0.01 m2 is more than 10000 m/s of depth, and what is beyond does "
                       "not flow; use at most 100 m3/s, or a larger shape"),
                  point("120"));
    CHECK(says(point("-120"), "sources[0].discharge: 120 m3/s on 0.01 m2"));
    CHECK(point("99").empty());
    CHECK(warnings(R"("sources": [{"shape": "disc", "center": [1, 1], "radius": 0.2, "discharge": 120}])").empty());
}

TEST_CASE("level warnings: stiffness of the sand") {
    const auto with = [](const std::string& modulus, const std::string& method = "") {
        return warnings(R"("sand": [{"shape": "plane", "height": 2}], "material": {"young_modulus": )" + modulus + "}" + method);
    };
    // rho_s g h0 = 39240 Pa: 196200 ... 588600
    CHECK(says(with("1e5"), "material.young_modulus: 100000 Pa is outside 197000 ... 588000 Pa"));
    CHECK(says(with("1e5"), "compressed by its own weight"));
    CHECK(says(with("1e6"), "does not fill hollows"));
    CHECK(with("2e5").empty());
    CHECK(with("0").empty()); // friction only
    // lambda + 2 mu = 1.346 E; the cap is 0.2 * 2000 * (0.1/0.009)^2 = 49383 Pa with one substep: E acts like 36684 Pa
    CHECK_MESSAGE(says(with("2e5", R"(, "method": {"substeps": 1})"), "200000 Pa acts like 36600 Pa at this sand substep"),
                  with("2e5", R"(, "method": {"substeps": 1})"));
    CHECK(with("1e5", R"(, "effects": {"elastoplastic": "off"})").empty());
}

TEST_CASE("level warnings: cohesion too weak for a wall, wet slopes") {
    const auto wall = [](const std::string& cohesion, const std::string& wet = "0.25") {
        return warnings(R"("sand": [{"shape": "cylinder", "center": [2, 1.5], "radius": 1, "height": 2}],
            "water": [{"shape": "plane", "wet": )" +
                        wet + R"(}], "material": {"cohesion_wet": )" + cohesion + R"(, "cohesion_capillary": )" + cohesion + "}");
    };
    // 2000 * 9.81 * 2 / (4 * (0.4 + sqrt(1.16))) = 6642 Pa
    CHECK_MESSAGE(says(wall("5e3"), "a wet sand wall of 2 m needs 6650 Pa (sand_density g h / (4 tan(45 deg + phi/2)), tan phi = "
                                    "yield_friction) and the level has 5000 Pa"),
                  wall("5e3"));
    CHECK(wall("6.65e3").empty());
    CHECK(wall("5e3", "0.45").empty()); // soaked sand is meant to run
    const auto slope = [](const std::string& rise, const std::string& wet, const std::string& more = "") {
        return warnings(R"("terrain": [{"shape": "plane", "height": 0, "slope_x": )" + rise +
                        R"(}], "sand": [{"shape": "plane", "height": 0.5}], "water": [{"shape": "plane", )" + wet +
                        R"(}], "material": {"young_modulus": 0)" + more + "}");
    };
    const auto seeping = [&](double rise, const std::string& wet, const std::string& more = "") {
        return slope(std::to_string(rise), "\"wet\": " + wet, more);
    };
    const auto limit = [](const std::string& held) { return "at 1170 faces, more than friction holds there, " + held + " "; };
    // tests/stability/quality/test_wet_sand.cpp and test_porosity.cpp have the same slopes move or stand.
    const auto turns_at = [&](double held, const char* text, const std::string& wet, const std::string& more = "") {
        CHECK_MESSAGE(says(seeping(1.05 * held, wet, more), limit(text)), seeping(1.05 * held, wet, more));
        CHECK_MESSAGE(seeping(0.95 * held, wet, more).empty(), seeping(0.95 * held, wet, more));
    };
    turns_at(0.2428, "0.243", "1");
    turns_at(0.3612, "0.361", "0.75");
    turns_at(0.5, "0.5", "0.4925"); // what pores hold back weighs as sand
    turns_at(0.5, "0.5", "1", R"(, "exchange_rate": 0)");
    turns_at(0.1667, "0.167", "1", R"(}, "effects": {"slope_normal": "off")"); // no pressure bears weight there
    turns_at(0.2427, "0.243", "1", R"(, "porosity": 0.4, "sand_density": 1600)");
    turns_at(0.2609, "0.261", "1", R"(, "porosity": 0.3, "sand_density": 1866.9)");
    CHECK(seeping(0.49, "0").empty());
    // Pores full to a level: nothing seeps.
    CHECK(slope("0.2", R"("surface": 0.6, "inside_sand": true)").empty());
    const auto damp = [](const std::string& rise, const std::string& wet) {
        return warnings(R"("sand": [{"shape": "plane", "height": 0.5, "slope_x": )" + rise +
                        R"(}], "water": [{"shape": "plane", "wet": )" + wet + R"(}], "material": {"young_modulus": 2e5})");
    };
    CHECK_FALSE(damp("0.3", "1").empty());
    CHECK(damp("0.3", "0.25").empty()); // cohesion holds it
}

TEST_CASE("level warnings: water that porous sand displaces counts with its depth, not with its volume") {
    const auto lake = [](const char* porosity) { // up to 2 m over 1 m of sand, 1.4 m of water
        return warnings(R"("sand": [{"shape": "plane", "height": 1}], "water": [{"shape": "plane", "surface": 2}],
            "material": {"young_modulus": 2e5, "porosity": )" +
                            std::string(porosity) + "}",
                        0.03);
    };
    CHECK_MESSAGE(says(lake("0.4"), "and the level has 2 m; use"), lake("0.4"));
    CHECK_MESSAGE(says(lake("1"), "and the level has 2 m; use"), lake("1"));
    const auto pond = [](const char* porosity) { // the same beside a dry bed: 1 m above the sand
        return warnings(R"("sand": [{"shape": "plane", "height": 1}],
            "water": [{"shape": "box", "from": [0, 0], "to": [2, 3], "surface": 2}], "material": {"young_modulus": 2e5, "porosity": )" +
                        std::string(porosity) + "}");
    };
    CHECK_MESSAGE(says(pond("0.4"), "water of 1 m beside dry ground"), pond("0.4"));
    CHECK_MESSAGE(says(pond("1"), "water of 1 m beside dry ground"), pond("1"));
}

TEST_CASE("level warnings: an opening between two cell centres") {
    const char* swings = R"("sides": {"west": {"kind": "level", "value": [[0, 1], [0.1, 1.1], [0.2, 1], [0.3, 1.1], [0.4, 1]])";
    CHECK(says(warnings(swings + std::string("}}")), "sides.west.value: a level that swings within 0.2 s throws back"));
    CHECK(warnings(swings + std::string(R"(, "absorb": 1}})")).empty());
    CHECK(warnings(R"("sides": {"west": {"kind": "level", "value": [[0, 1], [100, 1.1], [200, 1], [300, 1.1]]}})").empty());
    CHECK(says(warnings(R"("sides": {"west": {"kind": "outflow", "from": 1.06, "to": 1.14}})"),
               "sides.west: no cell centre lies between"));
    CHECK(warnings(R"("sides": {"west": {"kind": "outflow", "from": 1.04, "to": 1.06}})").empty());
}

TEST_CASE("level warnings: heights and the quantum") {
    CHECK_MESSAGE(says(warnings(R"("terrain": [{"shape": "plane", "height": 15}])"),
                       "the highest column is 15 m of 16 m; what would rise above is refused, use 32 or more"),
                  warnings(R"("terrain": [{"shape": "plane", "height": 15}])"));
    CHECK(warnings(R"("terrain": [{"shape": "plane", "height": 14}])").empty());
}

TEST_CASE("level warnings: a layer that changes nothing") {
    CHECK(says(warnings(R"("sand": [{"shape": "cylinder", "center": [9, 9], "radius": 1, "height": 1}])"),
               "sand[0]: changes no cell"));
    CHECK(says(warnings(R"("terrain": [{"shape": "plane", "height": 3}], "water": [{"shape": "plane", "surface": 2}])"),
               "water[0]: changes no cell"));
    CHECK(warnings(R"("terrain": [{"shape": "plane", "height": 0}])").empty());
    const auto velocity = [](const std::string& from_to, const std::string& of_it) {
        return warnings(R"("velocities": [{"of": "water", "shape": "box", )" + from_to + R"(, "velocity": )" + of_it + "}]");
    };
    // Round faces, whose velocity it is meant to be, but round no cell centre.
    CHECK(says(velocity(R"("from": [0.26, 0], "to": [0.34, 8])", "[1, 0]"), "velocities[0]: changes no cell"));
    CHECK(velocity(R"("from": [0.26, 0], "to": [0.36, 8])", "[1, 0]").empty());
    CHECK(velocity(R"("from": [0.26, 0], "to": [0.36, 8])", "[0, 0]").empty());
}

TEST_CASE("shipped levels load without a warning, dam_break with the one its README explains, as published with two more") {
    for (const char* name : {"piles", "canyon", "beach", "wadi"}) {
        const auto level = load_level((samples() / name / "level.json").string(), {});
        REQUIRE_MESSAGE(level, message(level));
        for (const std::string& warning : level->warnings) CHECK_MESSAGE(false, name << ": " << warning);
    }
    const std::string path = (samples() / "dam_break" / "level.json").string();
    const auto shipped = load_level(path, {});
    REQUIRE_MESSAGE(shipped, message(shipped));
    REQUIRE(shipped->warnings.size() == 1);
    CHECK(says(shipped->warnings[0], "acts like 330000 Pa"));
    LevelOverrides as_published;
    as_published.variant = "paper";
    const auto level = load_level(path, as_published);
    REQUIRE_MESSAGE(level, message(level));
    REQUIRE(level->warnings.size() == 3);
    CHECK(says(level->warnings[0], "the level has 8 m; use dt <= 0.0253 s or dx >= 0.886 m"));
    CHECK(says(level->warnings[1], "dt <= 0.00987 s or dx >= 2.28 m, or method.water_substeps 5"));
    CHECK(says(level->warnings[2], "acts like 330000 Pa"));
    LevelOverrides overrides;
    overrides.dt = 0.009; // what the warnings advise
    const auto cured = load_level(path, overrides);
    REQUIRE_MESSAGE(cured, message(cured));
    CHECK(cured->warnings.empty());
}

TEST_CASE("shipped levels: seepage loads without a warning in every variant") {
    for (const char* variant : {"low", "medium", "high"}) {
        LevelOverrides overrides;
        overrides.variant = variant;
        const auto level = load_level((samples() / "seepage" / "level.json").string(), overrides);
        REQUIRE_MESSAGE(level, message(level));
        for (const std::string& warning : level->warnings) CHECK_MESSAGE(false, variant << ": " << warning);
    }
}

TEST_CASE("shipped levels: every level and variant loads, at other sizes too") {
    for (const std::string& name : names()) {
        const std::string path = (samples() / name / "level.json").string();
        const auto level = load_level(path, {});
        REQUIRE_MESSAGE(level, name << ": " << message(level));
        LevelOverrides overrides;
        for (const std::string& variant : level->variants) {
            overrides.variant = variant;
            const auto changed = load_level(path, overrides);
            CHECK_MESSAGE(changed, name << ", " << variant << ": " << message(changed));
        }
        overrides.variant.reset();
        for (const auto& [nx, ny] : {std::pair{64, 64}, std::pair{97, 33}, std::pair{512, 512}}) {
            overrides.size = {nx, ny};
            const auto sized = load_level(path, overrides);
            CHECK_MESSAGE(sized, name << ": " << message(sized));
        }
    }
}

TEST_CASE("shipped levels: piles") {
    const auto loaded = load_level((samples() / "piles" / "level.json").string(), {});
    REQUIRE_MESSAGE(loaded, message(loaded));
    const Level& level = loaded.value();
    const double wet[2][3] = {{0.33, 0.45, 1}, {0, 0.1, 0.25}}; // from the south
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 3; ++column) {
            const int i = column * 112 + 60;
            const int j = row * 112 + 50;
            const double sand = at(level, level.fields.sand, i, j);
            CHECK(sand == doctest::Approx(2).epsilon(0.011));
            CHECK(at(level, level.fields.water, i, j) == doctest::Approx(wet[row][column] * sand).epsilon(1e-5));
        }
    CHECK(at(level, level.fields.sand, 50, 50) != at(level, level.fields.sand, 61, 61)); // not symmetric
}

TEST_CASE("shipped levels: the canyon's dams close it, and its reaches lie one below the other") {
    const auto loaded = load_level((samples() / "canyon" / "level.json").string(), {});
    REQUIRE_MESSAGE(loaded, message(loaded));
    const Level& level = loaded.value();
    const double crest[3] = {11.16, 9.1, 7.04};
    const int row[3] = {192, 128, 64};
    for (int dam = 0; dam < 3; ++dam) {
        int sandy = 0;
        for (int i = 0; i < 200; ++i) {
            const double top = at(level, level.fields.terrain, i, row[dam]) + at(level, level.fields.sand, i, row[dam]);
            CHECK(top >= crest[dam] - 1e-5);
            if (at(level, level.fields.sand, i, row[dam]) > 3.7) ++sandy;
        }
        CHECK(sandy >= 18); // the floor is 10 m wide
    }
    double highest_sand = 0;
    for (const float sand : level.fields.sand) highest_sand = std::max(highest_sand, static_cast<double>(sand));
    CHECK(highest_sand < 4);
    CHECK(level.fields.water.empty());
}

TEST_CASE("shipped levels: the beach's lake is level over the sand, its castle dry above it, its wall in reach of the brushes") {
    const auto loaded = load_level((samples() / "beach" / "level.json").string(), {});
    REQUIRE_MESSAGE(loaded, message(loaded));
    const Level& level = loaded.value();
    CHECK(at(level, level.fields.terrain, 160, 20) + at(level, level.fields.water, 160, 20) ==
          doctest::Approx(1.05).epsilon(1e-5));
    CHECK(at(level, level.fields.sand, 160, 20) > 0.2);
    const auto top = [&](int i, int j) { return at(level, level.fields.terrain, i, j) + at(level, level.fields.sand, i, j); };
    CHECK(top(160, 160) - top(160, 220) > 0.5); // the keep over the beach behind it, which is higher ground
    for (const ScriptedEdit& script : level.settings.edits) {
        const double end = script.edit.x0 + script.move[0] * (script.until - script.time);
        CHECK(script.edit.x0 >= 12);
        CHECK(end <= 20);
        CHECK(script.until < level.duration);
    }
    CHECK(level.settings.edits.size() == 8);
}

TEST_CASE("shipped levels: the wadi's floor falls to the east, dunes lie on it alone, the flood enters over the floor") {
    const auto loaded = load_level((samples() / "wadi" / "level.json").string(), {});
    REQUIRE_MESSAGE(loaded, message(loaded));
    const Level& level = loaded.value();
    const Grid& grid = level.settings.grid;
    double before = 1e9;
    for (int i = 40; i < grid.nx; i += 80) { // the lowest place of a column of cells is the floor
        double lowest = 1e9;
        for (int j = 0; j < grid.ny; ++j) {
            lowest = std::min(lowest, at(level, level.fields.terrain, i, j));
            if (at(level, level.fields.sand, i, j) > 1) CHECK(at(level, level.fields.terrain, i, j) < 14);
        }
        CHECK(lowest < before - 1);
        before = lowest;
    }
    double deepest = 0;
    for (const float sand : level.fields.sand) deepest = std::max(deepest, static_cast<double>(sand));
    CHECK(deepest > 2);
    CHECK(deepest < 4);
    const Side& west = level.settings.sides[static_cast<std::size_t>(SideName::west)];
    for (int j = 0; j < grid.ny; ++j) {
        const double y = (j + 0.5) * grid.dx;
        if (y > west.from && y < west.to) CHECK(at(level, level.fields.terrain, 0, j) < 11);
    }
}

TEST_CASE("shipped levels: every key is in the schema") {
    const Json schema = read_json(samples() / "level.schema.json");
    REQUIRE(schema.is_object());
    std::set<std::string> known;
    collect_properties(schema, known);
    for (const std::string& name : names()) {
        std::set<std::string> keys;
        const Json level = read_json(samples() / name / "level.json");
        collect_keys(level, keys);
        if (level.contains("variants")) {
            for (const Json& variant : level["variants"]) collect_keys(variant, keys);
        }
        CHECK(keys.size() > 10);
        for (const std::string& key : keys) CHECK_MESSAGE(known.count(key) == 1, name << ": " << key);
    }
    for (const std::string& side : side_names()) CHECK(schema["properties"]["sides"]["properties"].contains(side));
}
