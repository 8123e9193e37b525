// Every number of a choice is taken if and only if wadi.h lists it, whatever place of the interface takes it.
#include "tests/plugin/abi_worlds.hpp"
#include <doctest/doctest.h>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <set>

namespace enum_tests {

using namespace wadi::test;

namespace {

/// The numbers of an enum of wadi.h but its COUNT, as wadi_api.json has them.
std::set<int> listed(const std::string& name) {
    std::ifstream file(WADI_SOURCE_DIR "/plugin/wadi_api.json");
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const auto from = text.find("\"" + name + "\"", text.find("\"enums\""));
    REQUIRE_MESSAGE(from != std::string::npos, name);
    const auto begin = text.find("\"values\"", from);
    const std::string values = text.substr(begin, text.find('}', begin) - begin);
    const std::regex row("\"WADI_(\\w+)\": (-?\\d+)");
    std::set<int> numbers;
    for (std::sregex_iterator at(values.begin(), values.end(), row), end; at != end; ++at)
        if (!(*at)[1].str().ends_with("_COUNT")) numbers.insert(std::stoi((*at)[2]));
    return numbers;
}

} // namespace

TEST_CASE("choices: each number that wadi.h lists is taken, no other") {
    const auto world = mixed_world("cpu", 12);
    auto settings = wadi_default_update_settings();
    settings.interpolate_outputs = 1;
    REQUIRE(wadi_world_set_update_settings(world.id, &settings) == WADI_OK);
    REQUIRE(wadi_world_set_outputs(world.id, WADI_OUTPUT_BIT(WADI_OUTPUT_COUNT) - 1) == WADI_OK);
    auto frame = wadi_default_frame();
    for (int n = 0; n < 3; ++n) REQUIRE(wadi_world_update(world.id, 40'000'000, &frame) == WADI_OK);
    REQUIRE(hash_of(world) != 0); // waits
    uint32_t stamp = 0;
    const float image[4] = {1, 1, 1, 1};
    REQUIRE(wadi_world_create_stamp(world.id, 2, 2, image, &stamp) == WADI_OK);
    const auto make = [](const wadi_level_overrides& overrides) {
        const auto options = cpu_device();
        wadi_world_id id{};
        const char* level = R"({ "format_version": 1, "name": "choices", "dt": 0.02, "grid": { "nx": 8, "ny": 8, "dx": 0.5 },
                                 "water": [ { "shape": "plane", "height": 1 } ] })";
        const auto result = wadi_create_world_from_level_text(level, nullptr, nullptr, &overrides, &options, &id);
        if (result == WADI_OK) wadi_destroy_world(id);
        return result;
    };
    const auto edit = [&](int kind, int layer) {
        auto one = wadi_default_edit();
        one.kind = static_cast<wadi_edit_kind>(kind);
        one.layer = static_cast<wadi_layer>(layer);
        one.x1 = one.y1 = 1;
        one.stamp = stamp;
        return wadi_world_edit(world.id, &one, 1);
    };
    struct Place {
        const char *name, *type;
        std::function<wadi_result(int)> take;
    };
    const Place places[] = {
        {"overrides.active_tiles", "wadi_active_tiles",
         [&](int number) {
             auto overrides = wadi_default_level_overrides();
             overrides.active_tiles = static_cast<wadi_active_tiles>(number);
             return make(overrides);
         }},
        {"overrides.fused_stages", "wadi_choice",
         [&](int number) {
             auto overrides = wadi_default_level_overrides();
             overrides.fused_stages = static_cast<wadi_choice>(number);
             return make(overrides);
         }},
        {"edit.kind", "wadi_edit_kind", [&](int number) { return edit(number, WADI_LAYER_SAND); }},
        {"edit.layer", "wadi_layer", [&](int number) { return edit(WADI_EDIT_BRUSH, number); }},
        {"source.shape", "wadi_source_shape",
         [&](int number) {
             auto source = wadi_default_source();
             const wadi_sample rate{0, 0};
             source.shape = static_cast<wadi_source_shape>(number);
             source.to[0] = source.to[1] = 1;
             source.rate = &rate;
             source.rate_count = 1;
             return wadi_world_set_source(world.id, 0, &source);
         }},
        {"body.shape", "wadi_body_shape",
         [&](int number) {
             auto body = wadi_default_body();
             body.shape = static_cast<wadi_body_shape>(number);
             uint32_t count = 0;
             return wadi_buoyancy_points(&body, nullptr, &count);
         }},
        {"get_view, output", "wadi_output",
         [&](int number) {
             auto view = wadi_default_output_view();
             return wadi_world_get_view(world.id, static_cast<wadi_output>(number), WADI_OUTPUT_CURRENT, &view);
         }},
        {"get_view, set", "wadi_output_set",
         [&](int number) {
             auto view = wadi_default_output_view();
             return wadi_world_get_view(world.id, WADI_OUTPUT_TERRAIN, static_cast<wadi_output_set>(number), &view);
         }},
        {"field_name", "wadi_field",
         [&](int number) {
             return wadi_field_name(static_cast<wadi_field>(number)) != nullptr ? WADI_OK : WADI_ERROR_BAD_ARGUMENT;
         }},
        {"read_field", "wadi_field",
         [&](int number) {
             std::vector<float> values(144);
             return wadi_world_read_field(world.id, static_cast<wadi_field>(number), values.data(), values.size());
         }},
    };
    for (const auto& [name, type, take] : places) {
        CAPTURE(std::string(name));
        const auto numbers = listed(type);
        REQUIRE(numbers.size() >= 2);
        for (int number = -3; number <= 70; ++number) {
            CAPTURE(number);
            const auto result = take(number);
            if (numbers.contains(number))
                CHECK_MESSAGE(result == WADI_OK, std::string(wadi_get_last_error()));
            else
                CHECK(result == WADI_ERROR_BAD_ARGUMENT);
        }
        for (const int number : {-2147483647 - 1, 2147483647}) CHECK(take(number) == WADI_ERROR_BAD_ARGUMENT);
    }
}

} // namespace enum_tests
