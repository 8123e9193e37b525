// Levels as text, with maps that come from the host: the same world as from disk, and hosts that answer badly.
#include "tests/plugin/abi_worlds.hpp"
#include <cstring>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <wadi/wadi.h>

using wadi::test::cpu_device;

namespace {

const std::string canyon = WADI_SOURCE_DIR "/samples/levels/canyon/";

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    REQUIRE(file);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A file system of a host: names and bytes, and ways to go wrong.
struct Host {
    std::map<std::string, std::string> files;
    int calls = 0;
    bool shrinks = false, fails_later = false;
    std::size_t claims = 0;
};

wadi_bool read_file(void* user, const char* name, void* data, size_t* size) {
    auto& host = *static_cast<Host*>(user);
    ++host.calls;
    const auto found = host.files.find(name);
    if (found == host.files.end()) return 0;
    if (data == nullptr) {
        *size = host.claims != 0 ? host.claims : found->second.size();
        return 1;
    }
    if (host.fails_later) return 0;
    if (host.shrinks) --*size;
    std::memcpy(data, found->second.data(), *size);
    return 1;
}

} // namespace

TEST_CASE("a level from memory is the level from disk") {
    const auto options = cpu_device();
    auto overrides = wadi_default_level_overrides();
    overrides.nx = overrides.ny = 40;
    Host host;
    host.files["terrain.png"] = contents(canyon + "terrain.png");
    const auto text = contents(canyon + "level.json");
    wadi_world_id memory{}, disk{};
    REQUIRE_MESSAGE(wadi_create_world_from_level_text(text.c_str(), read_file, &host, &overrides, &options, &memory) == WADI_OK,
                    std::string(wadi_get_last_error()));
    CHECK(host.calls == 2);
    REQUIRE(wadi_create_world_from_level((canyon + "level.json").c_str(), &overrides, &options, &disk) == WADI_OK);
    uint64_t a = 0, b = 1;
    for (const auto id : {memory, disk}) REQUIRE(wadi_world_step(id, 3) == WADI_OK);
    REQUIRE(wadi_world_get_hash(memory, &a) == WADI_OK);
    REQUIRE(wadi_world_get_hash(disk, &b) == WADI_OK);
    CHECK(a == b);
    wadi_destroy_world(memory);
    wadi_destroy_world(disk);
}

TEST_CASE("hosts without the file, or that change their mind, and texts that are no level") {
    const auto options = cpu_device();
    const auto text = contents(canyon + "level.json");
    wadi_world_id id{};
    Host host;
    const auto create = [&](wadi_read_file_callback callback) {
        return wadi_create_world_from_level_text(text.c_str(), callback, &host, nullptr, &options, &id);
    };
    const auto says = [](const char* words) { return std::string(wadi_get_last_error()).find(words) != std::string::npos; };
    CHECK(create(nullptr) == WADI_ERROR_NOT_FOUND);
    CHECK(says("read_file is NULL"));
    CHECK(create(read_file) == WADI_ERROR_NOT_FOUND);
    CHECK(says("terrain.png"));
    host.files["terrain.png"] = contents(canyon + "terrain.png");
    host.shrinks = true;
    CHECK(create(read_file) == WADI_ERROR_BAD_FILE);
    host.shrinks = false;
    host.fails_later = true;
    CHECK(create(read_file) == WADI_ERROR_BAD_FILE);
    host.fails_later = false;
    host.claims = std::size_t{1} << 60;
    CHECK(create(read_file) == WADI_ERROR_BAD_FILE);
    CHECK(says("largest accepted file"));
    host.claims = 0;
    host.files["terrain.png"].resize(100);
    CHECK(create(read_file) == WADI_ERROR_BAD_FILE);
    host.files["terrain.png"].clear();
    CHECK(create(read_file) == WADI_ERROR_BAD_FILE);
    CHECK(wadi_create_world_from_level_text("{", nullptr, nullptr, nullptr, &options, &id) == WADI_ERROR_BAD_FILE);
    CHECK(wadi_create_world_from_level_text(nullptr, nullptr, nullptr, nullptr, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(wadi_create_world_from_level_text("{}", nullptr, nullptr, nullptr, &options, nullptr) == WADI_ERROR_BAD_ARGUMENT);
    auto unsized = options;
    unsized.struct_size = 1;
    CHECK(wadi_create_world_from_level_text("{}", nullptr, nullptr, nullptr, &unsized, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(id.index == 0);
}

TEST_CASE("files outside a level's folder are asked for only where the host allows it; settings of arrays name none") {
    const auto options = cpu_device();
    const std::string head = R"({"format_version": 1, "name": "files", "grid": {"nx": 4, "ny": 4, "dx": 1}, "dt": 0.01, )";
    const std::string text = head + R"("rain": {"file": "../rain.csv"}})";
    Host host;
    host.files["../rain.csv"] = host.files["rain.csv"] = "0,0.001\n";
    wadi_world_id id{};
    CHECK(wadi_create_world_from_level_text(text.c_str(), read_file, &host, nullptr, &options, &id) == WADI_ERROR_BAD_FILE);
    CHECK(std::string(wadi_get_last_error()).find("rain.file: ../rain.csv: lies outside the level's folder") !=
          std::string::npos);
    CHECK(host.calls == 0);
    auto overrides = wadi_default_level_overrides();
    overrides.any_files = 1;
    REQUIRE(wadi_create_world_from_level_text(text.c_str(), read_file, &host, &overrides, &options, &id) == WADI_OK);
    CHECK(host.calls == 2);
    wadi_destroy_world(id);

    auto arrays = wadi_default_world_arrays();
    const std::string settings = head + R"("rain": {"file": "rain.csv"}})", plain = head + R"("rain": 0.001})";
    arrays.nx = arrays.ny = 4;
    arrays.settings_json = settings.c_str();
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_ARGUMENT);
    CHECK(std::string(wadi_get_last_error()).find("may name no files") != std::string::npos);
    arrays.settings_json = plain.c_str(); // negative control
    REQUIRE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK);
    wadi_destroy_world(id);
}

TEST_CASE("texts of a level may stand in single quotes, and messages name the same places") {
    const auto make = [](const std::string& text) {
        const auto options = cpu_device();
        wadi_world_id id{};
        const auto result = wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &id);
        return std::pair(result, id);
    };
    const std::string in_double = R"({ "format_version": 1, "name": "it's", "dt": 0.02, // don't mind
        "grid": { "nx": 8, "ny": 8, "dx": 0.5 }, /* '" */ "water": [ { "shape": "plane", "height": 1 } ] })";
    const std::string in_single = R"({ 'format_version': 1, 'name': 'it\u0027s', 'dt': 0.02, // don't mind
        "grid": { 'nx': 8, 'ny': 8, 'dx': 0.5 }, /* '" */ 'water': [ { 'shape': 'plane', 'height': 1 } ] })";
    uint64_t hashes[2] = {};
    for (const auto* text : {&in_double, &in_single}) {
        const auto [result, id] = make(*text);
        REQUIRE_MESSAGE(result == WADI_OK, std::string(wadi_get_last_error()));
        const AbiWorld world(id);
        auto info = wadi_default_world_info();
        REQUIRE(wadi_world_get_info(id, &info) == WADI_OK);
        CHECK(std::string(info.name) == "it's");
        step(world, 5);
        hashes[text == &in_single ? 1 : 0] = hash_of(world);
    }
    CHECK(hashes[0] == hashes[1]);
    const auto refused = [&](const char* text, const char* why) {
        CHECK(make(text).first == WADI_ERROR_BAD_FILE);
        CHECK_MESSAGE(error_mentions(why), std::string(wadi_get_last_error()));
    };
    refused("{ 'name': 'a \"b\"' }", "line 1, column 14: a text in single quotes holds a double quote");
    refused("{ 'name': 'a\\\"b', 'grid': { 'nx' 8 } }", "line 1, column");
    refused("{ 'dt': 0.1,\n  'dt': 0.2 }", "\"dt\" is given twice");
    refused("{ 'name': 'it", "line 1, column");
    refused("{ 'name\": 1 }", "holds a double quote");
}

TEST_CASE("level overrides: fused_stages is 1, -1 or 0") {
    auto overrides = wadi_default_level_overrides();
    overrides.nx = overrides.ny = 40;
    const std::string path = WADI_SOURCE_DIR "/samples/levels/dam_break/level.json";
    for (const int asked : {-2, 2, 1, -1}) {
        overrides.fused_stages = static_cast<wadi_choice>(asked);
        wadi_world_id world{};
        const bool known = asked == 1 || asked == -1;
        CHECK((wadi_create_world_from_level(path.c_str(), &overrides, nullptr, &world) == WADI_OK) == known);
        if (!known) CHECK(std::string(wadi_get_last_error()).find("fused_stages") != std::string::npos);
        if (known) CHECK(wadi_destroy_world(world) == WADI_OK);
    }
}

TEST_CASE("what a host's read_file throws, of any type, becomes an error") {
    const auto options = cpu_device();
    const auto text = contents(canyon + "level.json");
    wadi_world_id world{7, 7};
    const auto throws_int = [](void*, const char*, void*, size_t*) -> int32_t { throw 42; };
    const auto throws_text = [](void*, const char*, void*, size_t*) -> int32_t { throw std::runtime_error("the disk is out"); };
    CHECK(wadi_create_world_from_level_text(text.c_str(), throws_int, nullptr, nullptr, &options, &world) == WADI_ERROR_INTERNAL);
    CHECK(wadi::test::error_mentions("unknown type"));
    CHECK(wadi_create_world_from_level_text(text.c_str(), throws_text, nullptr, nullptr, &options, &world) ==
          WADI_ERROR_INTERNAL);
    CHECK(wadi::test::error_mentions("the disk is out"));
    CHECK(world.index == 7);
}
