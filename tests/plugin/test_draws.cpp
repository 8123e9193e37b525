// What a host asks for when it makes a world: wadi_level_overrides.draws.
#include "tests/plugin/plugin_world.hpp"
#include <string>
#include <vector>

using namespace plugin_test;

TEST_CASE(
    "a host that draws foam, wetness and silt has them wherever there is water, silt over sand, unless the level forbids it") {
    const std::string level = R"({"format_version": 1, "name": "shore", "grid": {"nx": 24, "ny": 8, "dx": 0.5}, "dt": 0.01,
        "terrain": [{"shape": "plane", "height": 0, "slope_x": 0.1}])";
    const std::string water = R"(, "water": [{"shape": "box", "from": [0, 0], "to": [4, 4], "height": 2}])";
    constexpr uint64_t foam = WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM), wetness = WADI_OUTPUT_BIT(WADI_OUTPUT_WETNESS),
                       silt = WADI_OUTPUT_BIT(WADI_OUTPUT_SILT);
    struct Case {
        const char* level;
        uint64_t draws;
        std::string on;
    };
    const std::string sand = water + R"(, "sand": [{"shape": "plane", "height": 0.2}])";
    const std::string off = water + R"(, "effects": {"foam": "off"})", asks = water + R"(, "effects": {"foam": "on"})";
    for (const auto& [rest, draws, on] :
         {Case{water.c_str(), 0, ""}, Case{water.c_str(), foam, "foam "}, Case{water.c_str(), wetness, "wetness "},
          Case{water.c_str(), foam | wetness, "foam wetness "}, Case{off.c_str(), foam | wetness, "wetness "},
          Case{asks.c_str(), wetness, "foam wetness "}, Case{"", foam | wetness, ""}, Case{water.c_str(), silt, ""},
          Case{sand.c_str(), silt, "silt "}, Case{sand.c_str(), foam, "foam "}}) {
        CAPTURE(rest);
        CAPTURE(draws);
        auto overrides = wadi_default_level_overrides();
        overrides.draws = draws;
        auto options = wadi_default_device_options();
        options.backend = "cpu";
        wadi_world_id id{};
        REQUIRE(wadi_create_world_from_level_text((level + rest + "}").c_str(), nullptr, nullptr, &overrides, &options, &id) ==
                WADI_OK);
        const auto traces = [&] {
            uint32_t count = 0;
            REQUIRE(wadi_world_get_effects(id, nullptr, &count) == WADI_OK);
            std::vector<wadi_effect_info> effects(count);
            REQUIRE(wadi_world_get_effects(id, effects.data(), &count) == WADI_OK);
            std::string found;
            for (const std::string name : {"foam", "wetness", "silt"})
                for (const wadi_effect_info& one : effects)
                    if (one.on != 0 && one.name == name) found += name + " ";
            return found;
        };
        CHECK(traces() == on);
        if (*rest == '\0') { // they come with the first water
            auto edit = wadi_default_edit();
            edit.layer = WADI_LAYER_WATER;
            edit.x0 = edit.y0 = 2;
            edit.radius = 1;
            edit.amount = 0.5;
            REQUIRE(wadi_world_edit(id, &edit, 1) == WADI_OK);
            REQUIRE(wadi_world_step(id, 1) == WADI_OK);
            CHECK(traces() == "foam wetness ");
        }
        wadi_destroy_world(id);
    }
    auto overrides = wadi_default_level_overrides();
    overrides.draws = WADI_OUTPUT_BIT(WADI_OUTPUT_FLOW) | foam;
    wadi_world_id id{};
    CHECK(wadi_create_world_from_level_text((level + "}").c_str(), nullptr, nullptr, &overrides, nullptr, &id) ==
          WADI_ERROR_BAD_ARGUMENT);
    CHECK(std::string(wadi_get_last_error()) ==
          "wadi_create_world_from_level_text: overrides.draws has bits beside those of WADI_OUTPUT_FOAM (256), "
          "WADI_OUTPUT_WETNESS (8192) and WADI_OUTPUT_SILT (16384)");
}
