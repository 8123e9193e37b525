// What levels, snapshots and command logs cost is known before the work begins; a host's own limits; loads that a host ends.
#include "tests/plugin/abi_worlds.hpp"
#include "tests/unit/map_files.hpp"
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <thread>

namespace cost_tests {

using namespace wadi::test;

namespace {

std::string head(int n) {
    return R"({ "format_version": 1, "name": "cost", "dt": 0.02, "duration": 3, "grid": { "nx": )" + std::to_string(n) +
           R"(, "ny": )" + std::to_string(n) + R"(, "dx": 0.5 })";
}
const std::string noise = R"({ "shape": "noise", "amplitude": 0.1, "wavelength": 3, "octaves": 8, "seed": 1 })";
const std::string hill =
    R"(, "terrain": [ )" + noise + R"( ], "water": [ { "shape": "cylinder", "center": [8, 8], "radius": 3, "height": 1 } ],
    "edits": [ { "time": 0.1, "every": 0.001, "until": 1, "layer": "water", "shape": "disc", "center": [4, 4], "radius": 1, "amount": 0.001 } ] })";

wadi_cost cost_of(const std::string& text) {
    auto cost = wadi_default_cost();
    REQUIRE_MESSAGE(wadi_get_level_text_cost(text.c_str(), nullptr, nullptr, nullptr, &cost) == WADI_OK,
                    std::string(wadi_get_last_error()));
    return cost;
}

using Sum = uint64_t wadi_cost::*;
const std::pair<Sum, const char*> sums[] = {{&wadi_cost::cells, "cells"},
                                            {&wadi_cost::file_bytes, "file_bytes"},
                                            {&wadi_cost::map_values, "map_values"},
                                            {&wadi_cost::work, "work"},
                                            {&wadi_cost::host_bytes, "host_bytes"},
                                            {&wadi_cost::device_bytes, "device_bytes"},
                                            {&wadi_cost::steps, "steps"},
                                            {&wadi_cost::edits_per_step, "edits_per_step"},
                                            {&wadi_cost::commands_per_step, "commands_per_step"}};

/// Calls act(limits) with each sum of `cost` as the limit, which is taken, and with one less, which is refused in words. How many
/// sums there are.
template <class Act> int try_limits(const wadi_cost& cost, const Act& act) {
    int tried = 0;
    for (const auto& [sum, name] : sums) {
        if (cost.*sum < 2) continue;
        CAPTURE(std::string(name));
        auto most = wadi_default_cost();
        most.*sum = cost.*sum;
        CHECK_MESSAGE(act(most) == WADI_OK, std::string(wadi_get_last_error()));
        most.*sum = cost.*sum - 1;
        CHECK(act(most) == WADI_ERROR_BAD_FILE);
        CHECK(error_mentions(std::string(name) + ": it asks for " + std::to_string(cost.*sum) + " "));
        CHECK(error_mentions("its host allows " + std::to_string(cost.*sum - 1)));
        ++tried;
    }
    return tried;
}

struct Heard {
    int calls = 0, end_at = 0, throw_at = 0;
    double newest = 0;
    bool falls = false, other_thread = false;
    std::thread::id thread = std::this_thread::get_id();
};
wadi_bool hear(void* user, double share) {
    auto& heard = *static_cast<Heard*>(user);
    ++heard.calls;
    heard.falls = heard.falls || share < heard.newest || share > 1;
    heard.newest = share;
    heard.other_thread = heard.other_thread || heard.thread != std::this_thread::get_id();
    if (heard.calls == heard.throw_at) throw std::runtime_error("a host's mistake");
    return heard.calls == heard.end_at ? 0 : 1;
}

wadi_result make_heard(const std::string& text, Heard& heard, wadi_world_id& world) {
    auto options = cpu_device();
    options.threads = 2;
    options.progress = hear;
    options.progress_user = &heard;
    return wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &world);
}

} // namespace

TEST_CASE("cost: of every level that ships, beside what its world then is") {
    const auto log = [](void*, wadi_log_level, const char*) {};
    for (const auto& entry : std::filesystem::directory_iterator(WADI_SOURCE_DIR "/samples/levels")) {
        const auto path = (entry.path() / "level.json").string();
        if (!std::filesystem::exists(path)) continue;
        CAPTURE(path);
        auto cost = wadi_default_cost();
        REQUIRE_MESSAGE(wadi_get_level_cost(path.c_str(), nullptr, &cost) == WADI_OK, std::string(wadi_get_last_error()));
        for (const auto& backend : abi_backends()) {
            CAPTURE(backend);
            auto options = cpu_device();
            options.backend = backend.c_str();
            options.log = log;
            wadi_world_id id{};
            REQUIRE_MESSAGE(wadi_create_world_from_level(path.c_str(), nullptr, &options, &id) == WADI_OK,
                            std::string(wadi_get_last_error()));
            const AbiWorld world(id);
            auto info = wadi_default_world_info();
            REQUIRE(wadi_world_get_info(id, &info) == WADI_OK);
            CHECK(cost.cells == static_cast<uint64_t>(info.nx) * static_cast<uint64_t>(info.ny));
            CHECK(cost.steps == static_cast<uint64_t>(std::ceil(info.duration / info.dt)));
            CHECK(cost.device_bytes >= info.device_bytes);
            CHECK(static_cast<double>(cost.device_bytes) < 1.25 * static_cast<double>(info.device_bytes) + 1e5);
        }
        CHECK(cost.file_bytes >= std::filesystem::file_size(path));
        CHECK(cost.work >= cost.cells);
        CHECK(cost.host_bytes > 4 * cost.cells);
    }
}

TEST_CASE("cost: maps by their headers alone, which a load then meets") {
    const map_files::Folder folder;
    folder.write("grid.npy", map_files::npy(map_files::dictionary("<f4", "(24, 20)"), std::vector<float>(480, 0.25F)));
    folder.write("harmed.png", map_files::png_of_zeros(64, 32, 8, 0, 100)); // of 2048 pixels
    const auto level = [&](const std::string& map, const std::string& more) {
        return folder.write(map + ".json", head(16) + R"(, "terrain": [ { "file": ")" + map + "\"" + more + R"( } ] })");
    };
    auto cost = wadi_default_cost();
    const auto with_grid = level("grid.npy", "");
    REQUIRE(wadi_get_level_cost(with_grid.c_str(), nullptr, &cost) == WADI_OK);
    CHECK(cost.map_values == 480);
    CHECK(cost.file_bytes == std::filesystem::file_size(folder.file("grid.npy")) + std::filesystem::file_size(with_grid));
    const auto with_png = level("harmed.png", R"(, "max": 1)");
    REQUIRE_MESSAGE(wadi_get_level_cost(with_png.c_str(), nullptr, &cost) == WADI_OK, std::string(wadi_get_last_error()));
    CHECK(cost.map_values == 64 * 32);
    const auto options = cpu_device();
    wadi_world_id id{};
    CHECK(wadi_create_world_from_level(with_png.c_str(), nullptr, &options, &id) == WADI_ERROR_BAD_FILE); // it was never decoded
    // A map alone; one that is not there; a level that passes the library's own limits.
    REQUIRE(wadi_get_level_cost(folder.file("grid.npy").c_str(), nullptr, &cost) == WADI_OK);
    CHECK(cost.cells == 480);
    CHECK(cost.device_bytes > 480 * 4);
    CHECK(wadi_get_level_cost(folder.file("none.npy").c_str(), nullptr, &cost) == WADI_ERROR_NOT_FOUND);
    std::string layers;
    for (int n = 0; n < 250; ++n)
        layers += (n == 0 ? "" : ", ") +
                  std::string(R"({ "shape": "noise", "amplitude": 0.1, "wavelength": 3, "octaves": 12, "seed": 1 })");
    const auto heavy = head(1024) + R"(, "terrain": [ )" + layers + " ] }";
    CHECK(wadi_get_level_text_cost(heavy.c_str(), nullptr, nullptr, nullptr, &cost) == WADI_ERROR_BAD_FILE);
    CHECK(error_mentions("allowed are"));
}

TEST_CASE("cost: work is what drawing takes") {
    CHECK(cost_of(head(64) + R"(, "terrain": [ )" + noise + " ] }").work == 64 * 64 * 8); // octaves
    const auto two = cost_of(head(64) + R"(, "terrain": [ )" + noise + ", " + noise + " ] }");
    CHECK(two.work == 2 * 64 * 64 * 8);
    CHECK(cost_of(head(128) + R"(, "terrain": [ )" + noise + " ] }").work == 128 * 128 * 8);
    const uint64_t edits = cost_of(head(64) + hill).edits_per_step; // every 1 ms, steps of 20 ms, by how times are rounded
    CHECK((edits == 20 || edits == 21));
    CHECK(cost_of(head(64) + hill).steps == 150);
}

TEST_CASE("limits of a host's own: each is taken, one less is refused with the sum and the limit") {
    const std::string text = head(32) + hill;
    auto options = cpu_device();
    const auto make = [&](const wadi_cost& most) {
        options.most = &most;
        wadi_world_id id{};
        const auto result = wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &id);
        const std::string kept = wadi_get_last_error();
        if (result == WADI_OK) wadi_destroy_world(id);
        return result;
    };
    CHECK(try_limits(cost_of(text), make) == 7);
    const wadi_cost unsized{};
    CHECK(make(unsized) == WADI_ERROR_BAD_ARGUMENT); // no struct_size

    // Of arrays what their settings and the world ask for.
    const std::string settings = head(16) + "}";
    const std::vector<float> water(256, 0.5F);
    auto arrays = wadi_default_world_arrays();
    arrays.settings_json = settings.c_str();
    arrays.nx = arrays.ny = 16;
    arrays.water = water.data();
    auto most = wadi_default_cost();
    options.most = &most;
    most.cells = 255;
    wadi_world_id id{};
    CHECK(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_ERROR_BAD_FILE);
    most.cells = 256;
    REQUIRE(wadi_create_world_from_arrays(&arrays, &options, &id) == WADI_OK);
    wadi_destroy_world(id);
}

TEST_CASE("limits of a host's own hold for the snapshots and command logs of its worlds") {
    const std::string text = head(32) + hill;
    const auto make = [&](const wadi_cost* most) {
        auto options = cpu_device();
        options.most = most;
        wadi_world_id id{};
        REQUIRE_MESSAGE(wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &id) == WADI_OK,
                        std::string(wadi_get_last_error()));
        return AbiWorld(id);
    };
    const auto world = make(nullptr);
    REQUIRE(wadi_world_set_command_log(world.id, 1) == WADI_OK);
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = edit.y0 = 6;
    edit.amount = 0.1;
    edit.step = 170;
    const wadi_edit edits[] = {edit, edit, edit};
    step(world, 160);
    REQUIRE(wadi_world_edit(world.id, edits, 3) == WADI_OK);
    REQUIRE(wadi_world_set_material(world.id, "friction", 0.61) == WADI_OK);
    REQUIRE(wadi_world_set_material(world.id, "friction", 0.62) == WADI_OK);
    step(world, 20);
    size_t size = 0;
    REQUIRE(wadi_world_get_commands(world.id, nullptr, &size) == WADI_OK);
    std::vector<unsigned char> log(size);
    REQUIRE(wadi_world_get_commands(world.id, log.data(), &size) == WADI_OK);
    const auto snapshot = saved(world);

    auto cost = wadi_default_cost();
    const auto fresh = make(nullptr);
    const auto before = hash_of(fresh);
    REQUIRE_MESSAGE(wadi_world_get_snapshot_cost(fresh.id, snapshot.data(), snapshot.size(), &cost) == WADI_OK,
                    std::string(wadi_get_last_error()));
    CHECK(hash_of(fresh) == before);
    CHECK(cost.steps == 180);
    CHECK(cost.file_bytes == snapshot.size());
    // It brings sand, which the level has not.
    CHECK(cost.device_bytes > cost_of(text).device_bytes);
    REQUIRE(wadi_world_load(fresh.id, snapshot.data(), snapshot.size()) == WADI_OK);
    CHECK(cost.device_bytes >= device_bytes(fresh.id));
    // A level whose own sums pass the limit is refused already, so only sums that are larger can be tried.
    const auto level = cost_of(text);
    const auto larger = [&level](wadi_cost sum_of) {
        for (const auto& [sum, name] : sums)
            if (sum_of.*sum <= level.*sum + 1) sum_of.*sum = 0;
        return sum_of;
    };
    CHECK(try_limits(larger(cost), [&](const wadi_cost& most) {
              const auto limited = make(&most);
              const auto was = hash_of(limited);
              const auto result = wadi_world_load(limited.id, snapshot.data(), snapshot.size());
              if (result != WADI_OK) CHECK(hash_of(limited) == was);
              return result;
          }) == 3); // file_bytes, device_bytes, steps

    const auto player = make(nullptr);
    REQUIRE_MESSAGE(wadi_world_get_commands_cost(player.id, log.data(), log.size(), &cost) == WADI_OK,
                    std::string(wadi_get_last_error()));
    CHECK(cost.steps == 170);
    CHECK(cost.edits_per_step == 3);
    CHECK(cost.commands_per_step == 2);
    CHECK(try_limits(larger(cost), [&](const wadi_cost& most) {
              const auto limited = make(&most);
              return wadi_world_play_commands(limited.id, log.data(), log.size());
          }) == 3); // file_bytes, steps, commands_per_step
    // What is no snapshot or log is told as loading tells it.
    CHECK(wadi_world_get_snapshot_cost(player.id, log.data(), log.size(), &cost) == WADI_ERROR_BAD_FILE);
    CHECK(wadi_world_get_commands_cost(player.id, snapshot.data(), snapshot.size(), &cost) == WADI_ERROR_BAD_FILE);
}

TEST_CASE("a host hears how far a load is and may end it at any call") {
    const std::string text = head(300) + hill;
    Heard heard;
    wadi_world_id id{};
    REQUIRE_MESSAGE(make_heard(text, heard, id) == WADI_OK, std::string(wadi_get_last_error()));
    wadi_destroy_world(id);
    const int calls = heard.calls;
    CHECK(calls >= 5);
    CHECK(heard.newest == 1);
    CHECK_FALSE(heard.falls);
    CHECK_FALSE(heard.other_thread);
    for (int at = 1; at <= 3; ++at) { // with threads how many bands come to the host's own differs
        CAPTURE(at);
        Heard ending;
        ending.end_at = at;
        id = {};
        CHECK(make_heard(text, ending, id) == WADI_CANCELLED);
        CHECK(ending.calls == at); // and is not asked again
        CHECK(id.index == 0);
        CHECK(error_mentions("progress callback ended"));
        Heard throwing;
        throwing.throw_at = at;
        CHECK(make_heard(text, throwing, id) == WADI_ERROR_INTERNAL);
    }
    // At the end, too: no world is left.
    auto options = cpu_device();
    options.threads = 1;
    options.progress = hear;
    Heard one, last;
    options.progress_user = &one;
    REQUIRE(wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &id) == WADI_OK);
    wadi_destroy_world(id);
    for (last.end_at = one.calls - 1; last.end_at <= one.calls; ++last.end_at) {
        last.calls = 0;
        options.progress_user = &last;
        CHECK(wadi_create_world_from_level_text(text.c_str(), nullptr, nullptr, nullptr, &options, &id) == WADI_CANCELLED);
    }
}

} // namespace cost_tests
