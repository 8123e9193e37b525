// The C ABI against the shared library: good calls, bad handles, bad sizes, bad files; nothing crashes and every error has a
// text.
#include "tests/plugin/abi_worlds.hpp"
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <fstream>
#include <limits>
#include <string>
#include <vector>
#include <wadi/wadi.h>

using wadi::test::cpu_device;
using wadi::test::error_mentions;

namespace {

const std::string LEVELS = WADI_SOURCE_DIR "/samples/levels/";

constexpr const char* POND = R"({"format_version": 1, "name": "pond", "grid": {"nx": 16, "ny": 12, "dx": 0.5}, "dt": 0.01})";

wadi_world_arrays pond(std::vector<float>& terrain, std::vector<float>& water) {
    terrain.assign(16 * 12, 0.0F);
    water.assign(16 * 12, 0.0F);
    for (std::size_t k = 0; k < water.size(); ++k) water[k] = k % 16 < 5 ? 1.0F : 0.0F;
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json = POND;
    arrays.nx = 16;
    arrays.ny = 12;
    arrays.terrain = terrain.data();
    arrays.water = water.data();
    return arrays;
}

struct Pond {
    wadi_world_id id{};
    Pond() {
        std::vector<float> terrain, water;
        const auto arrays = pond(terrain, water);
        const auto options = cpu_device();
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
    }
    ~Pond() { wadi_destroy_world(id); }
};

} // namespace

TEST_CASE("roughness from arrays is that of a level, kept through a snapshot, and refused out of range") {
    const auto made = [](const wadi_world_arrays& arrays) {
        wadi_world_id id{};
        const auto options = cpu_device();
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
        return id;
    };
    const auto hash_after = [](wadi_world_id id, uint32_t steps) {
        uint64_t hash = 0;
        REQUIRE(wadi_world_step(id, steps) == WADI_OK);
        REQUIRE(wadi_world_get_hash(id, &hash) == WADI_OK);
        return hash;
    };
    std::vector<float> terrain, water, rough(16 * 12, 0.25F);
    auto arrays = pond(terrain, water);
    const wadi_world_id smooth = made(arrays);
    std::string text = POND;
    text.insert(text.size() - 1, R"(, "roughness": [{"shape": "plane", "manning": 0.25}])");
    arrays.settings_json = text.c_str();
    const wadi_world_id drawn = made(arrays);
    arrays.settings_json = POND;
    arrays.roughness = rough.data();
    const wadi_world_id given = made(arrays), later = made(arrays);
    const uint64_t hash = hash_after(given, 30);
    CHECK(hash_after(drawn, 30) == hash);
    CHECK(hash_after(smooth, 30) != hash);

    size_t size = 0;
    REQUIRE(wadi_world_save(given, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> saved(size);
    REQUIRE(wadi_world_save(given, saved.data(), &size) == WADI_OK);
    CHECK(wadi_world_load(smooth, saved.data(), size) != WADI_OK); // another level
    REQUIRE_MESSAGE(wadi_world_load(later, saved.data(), size) == WADI_OK, std::string(wadi_get_last_error()));
    CHECK(hash_after(later, 20) == hash_after(given, 20));

    for (const float wrong : {-0.01F, 1.5F, std::numeric_limits<float>::quiet_NaN()}) {
        rough[17] = wrong;
        wadi_world_id none{};
        const auto options = cpu_device();
        CHECK(wadi_create_world_from_arrays(&arrays, &options, &none) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(std::string(wadi_get_last_error()).find("in cell (1, 1)") != std::string::npos);
    }
    for (const wadi_world_id id : {smooth, drawn, given, later}) wadi_destroy_world(id);
}

TEST_CASE("a rain map from arrays is that of a level, and refused out of range or where it would rain too much") {
    std::vector<float> terrain, water, times(16 * 12, 0.0F);
    for (std::size_t n = 0; n < times.size(); ++n) times[n] = n % 16 < 8 ? 2.5F : 0.5F;
    auto arrays = pond(terrain, water);
    std::string text = POND, drawn = POND;
    text.insert(text.size() - 1, R"(, "rain": 0.01)");
    drawn.insert(drawn.size() - 1, R"(, "rain": 0.01, "rain_map": [{"shape": "plane", "times": 0.5},
        {"shape": "box", "from": [0, 0], "to": [4, 6], "times": 2}])");
    const auto hash_of = [&](const std::string& settings, const float* map) {
        arrays.settings_json = settings.c_str();
        arrays.rain_map = map;
        const auto options = cpu_device();
        wadi_world_id id{};
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
        uint64_t hash = 0;
        REQUIRE(wadi_world_step(id, 30) == WADI_OK);
        REQUIRE(wadi_world_get_hash(id, &hash) == WADI_OK);
        wadi_destroy_world(id);
        return hash;
    };
    const uint64_t by_level = hash_of(drawn, nullptr);
    CHECK(hash_of(text, times.data()) == by_level);
    CHECK(hash_of(text, nullptr) != by_level);
    arrays.settings_json = text.c_str();
    arrays.rain_map = times.data();
    for (const auto& [wrong, says] : {std::pair{-1.0F, "rain_map"}, {101.0F, "0 ... 100 in cell (1, 1)"}, {100.0F, ""}}) {
        times[17] = wrong;
        const auto options = cpu_device();
        wadi_world_id id{};
        const bool fine = std::string(says).empty();
        CHECK((wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK) == fine);
        if (!fine)
            CHECK_MESSAGE(std::string(wadi_get_last_error()).find(says) != std::string::npos, std::string(wadi_get_last_error()));
        wadi_destroy_world(id);
    }
    text = POND;
    text.insert(text.size() - 1, R"(, "rain": 0.1)"); // 100 times
    arrays.settings_json = text.c_str();
    const auto options = cpu_device();
    wadi_world_id id{};
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(std::string(wadi_get_last_error()).find("above 1 m/s") != std::string::npos);
}

TEST_CASE("a world from arrays steps, reads back and keeps its ledger") {
    const Pond world;
    CHECK(wadi_get_abi_version() == WADI_ABI_VERSION);
    REQUIRE(wadi_world_step(world.id, 100) == WADI_OK);
    double seconds = 0;
    uint64_t steps = 0;
    REQUIRE(wadi_world_get_time(world.id, &seconds, &steps) == WADI_OK);
    CHECK(steps == 100);
    CHECK(seconds == doctest::Approx(1.0));
    std::vector<float> w(16 * 12);
    REQUIRE(wadi_world_read_field(world.id, WADI_FIELD_TOTAL_WATER_DEPTH, w.data(), w.size()) == WADI_OK);
    CHECK(w[15] > 0.0F);
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    CHECK(stats.water_drift_quanta == 0);
    CHECK(stats.water_volume == doctest::Approx(stats.water_initial));
    CHECK(stats.water_initial == doctest::Approx(5 * 12 * 0.25));
    auto info = wadi_default_world_info();
    REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
    CHECK(info.nx == 16);
    CHECK(info.passes_per_sand_substep == 0);
    CHECK(info.bytes_per_cell <= 56);
    const size_t length = wadi_world_describe_plan(world.id, nullptr, 0);
    std::vector<char> plan(length + 1);
    CHECK(wadi_world_describe_plan(world.id, plan.data(), plan.size()) == length);
    CHECK(std::strlen(plan.data()) == length);
    for (int field = 0; field < WADI_FIELD_COUNT; ++field) {
        CHECK(wadi_field_name(static_cast<wadi_field>(field)) != nullptr);
        CHECK(wadi_world_read_field(world.id, static_cast<wadi_field>(field), w.data(), w.size()) == WADI_OK);
    }
    CHECK(std::string(wadi_field_name(WADI_FIELD_SAND_DEPTH)) == "hs"); // the engine counts them by hand
    CHECK(std::string(wadi_field_name(WADI_FIELD_SATURATION)) == "phi");
    CHECK(std::string(wadi_field_name(WADI_FIELD_MIXED_VELOCITY_Y)) == "vm");
    CHECK(std::string(wadi_field_name(WADI_FIELD_STRETCH_YY)) == "Vyy");
    CHECK(std::string(wadi_field_name(WADI_FIELD_WETNESS)) == "wet");
    CHECK(std::string(wadi_field_name(WADI_FIELD_SILT)) == "silt");
    CHECK(wadi_field_name(WADI_FIELD_COUNT) == nullptr);
}

TEST_CASE("same level, same hash; profiling names every stage and changes nothing") {
    const auto options = cpu_device();
    auto overrides = wadi_default_level_overrides();
    overrides.nx = overrides.ny = 48;
    uint64_t hashes[2];
    for (int n = 0; n < 2; ++n) {
        wadi_world_id id{};
        REQUIRE_MESSAGE(wadi_create_world_from_level((LEVELS + "dam_break/level.json").c_str(), &overrides, &options, &id) ==
                            WADI_OK,
                        std::string(wadi_get_last_error()));
        CHECK(wadi_world_set_profiling(id, n) == WADI_OK);
        REQUIRE(wadi_world_step(id, 20) == WADI_OK);
        auto stats = wadi_default_world_stats();
        REQUIRE(wadi_world_get_stats(id, &stats) == WADI_OK);
        hashes[n] = stats.hash;
        uint32_t count = 0;
        REQUIRE(wadi_world_get_stage_timings(id, nullptr, &count) == WADI_OK);
        CHECK(count == 16);
        std::vector<wadi_stage_timing> timings(count);
        REQUIRE(wadi_world_get_stage_timings(id, timings.data(), &count) == WADI_OK);
        CHECK((timings[0].milliseconds > 0) == (n == 1));
        CHECK(wadi_destroy_world(id) == WADI_OK);
    }
    CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("a world's warnings are read one by one, and none behind the last") {
    const auto warnings = [](float depth) {
        std::vector<float> terrain, water;
        auto arrays = pond(terrain, water);
        arrays.settings_json =
            R"({"format_version": 1, "name": "pond", "grid": {"nx": 16, "ny": 12, "dx": 0.5}, "dt": 0.05})"; // 9 m/s
        for (float& d : water) d *= depth;
        const auto options = cpu_device();
        wadi_world_id id{};
        REQUIRE_MESSAGE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK, std::string(wadi_get_last_error()));
        auto info = wadi_default_world_info();
        REQUIRE(wadi_world_get_info(id, &info) == WADI_OK);
        std::string all;
        for (uint32_t n = 0; n < info.warning_count; ++n) all += std::string(wadi_world_get_warning(id, n)) + "\n";
        CHECK(wadi_world_get_warning(id, info.warning_count) == nullptr);
        CHECK(error_mentions("n is " + std::to_string(info.warning_count)));
        CHECK(wadi_destroy_world(id) == WADI_OK);
        return all;
    };
    CHECK(warnings(15).find("beside dry ground should run at up to") != std::string::npos);
    CHECK(warnings(0.1F).empty());
}

TEST_CASE("null and destroyed ids are refused by every call") {
    Pond world;
    const auto dead = world.id;
    REQUIRE(wadi_destroy_world(dead) == WADI_OK);
    float value;
    auto stats = wadi_default_world_stats();
    auto info = wadi_default_world_info();
    uint32_t count = 0;
    for (const auto id : {wadi_world_id{0, 0}, dead, wadi_world_id{1000, 1}}) {
        CHECK(wadi_destroy_world(id) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_step(id, 1) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(error_mentions("destroyed"));
        CHECK(wadi_world_read_field(id, WADI_FIELD_TERRAIN, &value, 1) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_get_stats(id, &stats) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_get_info(id, &info) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_get_time(id, nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_set_profiling(id, 1) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_get_stage_timings(id, nullptr, &count) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(wadi_world_describe_plan(id, nullptr, 0) == 0);
        CHECK(wadi_world_get_warning(id, 0) == nullptr);
    }
    const Pond reborn; // takes the freed slot; the old id must not reach it
    CHECK(reborn.id.index == dead.index);
    CHECK(wadi_world_step(dead, 1) == WADI_ERROR_BAD_ARGUMENT);
}

TEST_CASE("bad arguments get a code and a text, and leave the world as it was") {
    const Pond world;
    auto stats = wadi_default_world_stats();
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    const auto hash = stats.hash;
    std::vector<float> values(16 * 12);
    CHECK(wadi_world_read_field(world.id, WADI_FIELD_TERRAIN, values.data(), 5) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("192"));
    CHECK(wadi_world_read_field(world.id, WADI_FIELD_TERRAIN, nullptr, 192) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_world_read_field(world.id, WADI_FIELD_COUNT, values.data(), 192) == WADI_ERROR_BAD_ARGUMENT);
    wadi_world_stats unsized{};
    CHECK(wadi_world_get_stats(world.id, &unsized) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("struct_size"));
    CHECK(wadi_world_get_stats(world.id, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_list_devices(nullptr, nullptr, nullptr, 0) == WADI_ERROR_BAD_ARGUMENT);
    REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
    CHECK(stats.hash == hash);
}

TEST_CASE("bad worlds are refused before anything is made") {
    const auto options = cpu_device();
    wadi_world_id id{};
    std::vector<float> terrain, water;
    auto arrays = pond(terrain, water);
    water[7 * 16 + 3] = std::nanf("");
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK_MESSAGE(error_mentions("3"), std::string(wadi_get_last_error()));
    water[7 * 16 + 3] = -1;
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    water[7 * 16 + 3] = 1;
    arrays.nx = 15;
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(error_mentions("16 x 12"));
    arrays.nx = 16;
    arrays.settings_json = "{";
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_FILE);
    CHECK(wadi_create_world_from_level("no/such/level.json", nullptr, &options, &id) == WADI_ERROR_NOT_FOUND);
    CHECK(wadi_create_world_from_level(nullptr, nullptr, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    auto nowhere = cpu_device();
    nowhere.backend = "abacus";
    CHECK(wadi_create_world_from_level((LEVELS + "dam_break/level.json").c_str(), nullptr, &nowhere, &id) ==
          WADI_ERROR_NOT_FOUND);
    CHECK(error_mentions("abacus"));
    nowhere.backend = "cpu";
    nowhere.device = 7;
    CHECK(wadi_create_world_from_level((LEVELS + "dam_break/level.json").c_str(), nullptr, &nowhere, &id) ==
          WADI_ERROR_NOT_FOUND);
    nowhere.device = -1;
    nowhere.threads = 100000;
    CHECK(wadi_create_world_from_level((LEVELS + "dam_break/level.json").c_str(), nullptr, &nowhere, &id) ==
          WADI_ERROR_BAD_ARGUMENT);
    auto overrides = wadi_default_level_overrides();
    overrides.nx = overrides.ny = 1 << 20;
    CHECK(wadi_create_world_from_level((LEVELS + "dam_break/level.json").c_str(), &overrides, &options, &id) ==
          WADI_ERROR_BAD_ARGUMENT);
    CHECK(id.index == 0);
}

TEST_CASE("devices are listed, and a small buffer is filled no further") {
    uint32_t count = 0;
    CHECK(wadi_list_accuracy_presets(nullptr, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    REQUIRE(wadi_list_accuracy_presets(nullptr, &count) == WADI_OK);
    std::vector<wadi_accuracy_preset> presets(count);
    REQUIRE(wadi_list_accuracy_presets(presets.data(), &count) == WADI_OK);
    REQUIRE(presets.size() == 4);
    for (std::size_t n = 1; n < 3; ++n) CHECK(presets[n].cells > presets[n - 1].cells);
    CHECK(std::string(presets[1].name) == "balanced");
    CHECK(std::string(presets[3].name) == "fine");
    CHECK(presets[3].cells == 0); // the level's
    REQUIRE(wadi_list_devices(nullptr, &count, nullptr, 0) == WADI_OK);
    REQUIRE(count >= 1);
    std::vector<wadi_device_info> infos(count + 1);
    infos[1].index = -77;
    uint32_t one = 1;
    char notes[8];
    CHECK(wadi_list_devices(infos.data(), &one, notes, sizeof notes) == WADI_ERROR_BAD_ARGUMENT); // struct_size is 0
    CHECK(infos[0].backend[0] == 0);
    infos[0].struct_size = sizeof infos[0];
    REQUIRE(wadi_list_devices(infos.data(), &one, notes, sizeof notes) == WADI_OK);
    CHECK(one == count);
    CHECK(std::string(infos[0].backend) == "cpu");
    CHECK(infos[1].index == -77);
}

TEST_CASE("a device below -1 is refused, -1 is the best") {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    wadi_world_id id{};
    for (const int32_t device : {-2, INT32_MIN}) {
        options.device = device;
        CHECK(wadi_create_world_from_level_text(
                  R"({"format_version": 1, "name": "x", "grid": {"nx": 4, "ny": 4, "dx": 1}, "dt": 0.1})", nullptr, nullptr,
                  nullptr, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
        CHECK(std::string(wadi_get_last_error()).find("below -1") != std::string::npos);
    }
}

TEST_CASE("texts hold words of files as a terminal may show them, and whole characters") {
    const auto device = cpu_device();
    const auto message = [&](const std::string& key) {
        wadi_world_id world{};
        const std::string level = "{\"format_version\": 1, \"name\": \"x\", \"" + key + "\": 1}";
        CHECK(wadi_create_world_from_level_text(level.c_str(), nullptr, nullptr, nullptr, &device, &world) ==
              WADI_ERROR_BAD_FILE);
        return std::string(wadi_get_last_error());
    };
    for (const char c : message("a\\n\\u001b[2Jb\\u009b\\u007f")) CHECK(static_cast<unsigned char>(c) >= 0x20);
    CHECK(message("a\\u001b[2Jb").find("a [2Jb") != std::string::npos);
    CHECK(message("a\\u009bb").find("\xc2\x9b") == std::string::npos);
    for (std::size_t length = 2000; length < 2004; ++length) {
        const std::string text = message(std::string(length % 4, 'x') + [] {
            std::string many;
            for (int n = 0; n < 700; ++n) many += "\xe2\x82\xac"; // a character of three bytes
            return many;
        }());
        CHECK(text.size() > 900);
        const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U; };
        for (std::size_t at = 0; at < text.size(); ++at)
            if (text[at] == '\xe2') REQUIRE((at + 2 < text.size() && continues(at + 1) && continues(at + 2)));
        for (std::size_t at = 0; at < text.size(); ++at)
            if (continues(at)) REQUIRE((at > 0 && (text[at - 1] == '\xe2' || (at > 1 && text[at - 2] == '\xe2'))));
    }
}
