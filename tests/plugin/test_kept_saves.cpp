// Saves and command logs that builds of before wrote, kept in tests/plugin/saves: each still loads and is what it was. After a
// rise of a format's number: WADI_KEEP_SAVES=1 build/ci/bin/wadi-test-plugin -tc='*kept*', which writes the missing file and
// prints its row. Files that are there are never written anew (engine/saves/README.md, Older saves).
#include "tests/plugin/abi_worlds.hpp"
#include <cstdlib>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

namespace kept_saves {

using namespace wadi::test;

namespace {

using Bytes = std::vector<unsigned char>;

/// A file of tests/plugin/saves, and the state that it is of.
struct Kept {
    uint32_t version;
    uint64_t hash;
    double friction; // which a host had changed
};
// One row for each version since that of the first release.
const Kept snapshots[] = {{4, 5135146086101446750u, 0.61},
                          {5, 5135146086101446750u, 0.61},
                          {6, 5135146086101446750u, 0.61},
                          {7, 3470966608497948279u, 0.61}};
const uint32_t logs[] = {2, 3};
constexpr uint64_t steps = 12;

std::filesystem::path folder() { return std::filesystem::path(WADI_SOURCE_DIR) / "tests" / "plugin" / "saves"; }
std::string snapshot_name(uint32_t version) { return "snapshot_" + std::to_string(version) + ".save"; }
std::string log_name(uint32_t version) { return "commands_" + std::to_string(version) + ".log"; }

Bytes bytes_of(const std::string& name) {
    std::ifstream file(folder() / name, std::ios::binary);
    REQUIRE_MESSAGE(file.is_open(), name);
    return {std::istreambuf_iterator<char>(file), {}};
}

AbiWorld kept_world(const std::string& backend) {
    auto options = cpu_device();
    options.backend = backend.c_str();
    wadi_world_id id{};
    REQUIRE_MESSAGE(wadi_create_world_from_level((folder() / "level.json").string().c_str(), nullptr, &options, &id) == WADI_OK,
                    std::string(wadi_get_last_error()));
    return AbiWorld(id);
}

uint64_t sources_of(const AbiWorld& world) {
    auto info = wadi_default_world_info();
    REQUIRE(wadi_world_get_info(world.id, &info) == WADI_OK);
    return info.source_count;
}

/// Every kind of command but sources, for step 3 or later.
void command(const AbiWorld& world) {
    const float image[] = {0.0F, 0.1F, 0.2F, 0.1F};
    uint32_t stamp = 0;
    REQUIRE(wadi_world_create_stamp(world.id, 2, 2, image, &stamp) == WADI_OK);
    wadi_edit edits[4];
    for (auto& edit : edits) edit = wadi_default_edit();
    edits[0].layer = WADI_LAYER_SAND;
    edits[0].x0 = 2, edits[0].y0 = 3, edits[0].amount = 0.05, edits[0].step = 5;
    edits[1].kind = WADI_EDIT_STAMP;
    edits[1].layer = WADI_LAYER_TERRAIN;
    edits[1].x0 = 1, edits[1].y0 = 1, edits[1].x1 = 3, edits[1].y1 = 2, edits[1].amount = 0.5, edits[1].stamp = stamp;
    edits[1].step = 6;
    edits[2].kind = WADI_EDIT_PUSH;
    edits[2].capsule = 1;
    edits[2].x0 = 3, edits[2].y0 = 3, edits[2].x1 = 5, edits[2].y1 = 4, edits[2].velocity_x = 1, edits[2].step = 7;
    edits[3] = edits[0];
    edits[3].layer = WADI_LAYER_WATER;
    edits[3].step = 8;
    REQUIRE(wadi_world_edit(world.id, edits, 4) == WADI_OK);
    step(world, 3);
    REQUIRE(wadi_world_set_material(world.id, "friction", 0.61) == WADI_OK);
    const wadi_region region{1, 1, 2, 2};
    const float depths[] = {0.1F, 0.2F, 0.3F, 0.4F};
    REQUIRE(wadi_world_write_region(world.id, WADI_FIELD_SAND_DEPTH, &region, depths, 4) == WADI_OK);
    REQUIRE(wadi_world_trim(world.id) == WADI_OK);
}

/// A source more than the level has, from step 9 on; snapshots hold it since version 7.
void add_source(const AbiWorld& world) {
    auto tap = wadi_default_source();
    const wadi_sample rate[] = {{0, 0.5}, {100, 0.25}};
    tap.center[0] = 3, tap.center[1] = 2, tap.rate = rate, tap.rate_count = 2, tap.step = 9;
    REQUIRE_MESSAGE(wadi_world_set_source(world.id, static_cast<uint32_t>(sources_of(world)), &tap) == WADI_OK,
                    std::string(wadi_get_last_error()));
}

uint32_t version_of(const Bytes& bytes) {
    uint32_t version = 0;
    REQUIRE(bytes.size() > 12);
    std::memcpy(&version, bytes.data() + 8, sizeof version);
    return version;
}

double friction_of(const AbiWorld& world) {
    wadi_material_info infos[64];
    uint32_t count = 64;
    REQUIRE(wadi_world_get_material(world.id, infos, &count) == WADI_OK);
    for (uint32_t n = 0; n < count; ++n)
        if (std::string(infos[n].name) == "friction") return infos[n].value;
    return -1;
}

} // namespace

TEST_CASE("kept saves: those that this build writes are among them") {
    const auto world = kept_world("cpu");
    REQUIRE(wadi_world_set_command_log(world.id, 1) == WADI_OK);
    command(world);
    step(world, steps - 3);
    const auto with_source = kept_world("cpu");
    command(with_source);
    add_source(with_source);
    step(with_source, steps - 3);
    const Bytes snapshot = saved(with_source), log = log_of(world);
    const uint32_t snapshot_version = version_of(snapshot), log_version = version_of(log);
    if (std::getenv("WADI_KEEP_SAVES") != nullptr) {
        const auto keep = [](const std::string& name, const Bytes& bytes) {
            if (std::filesystem::exists(folder() / name)) return;
            std::ofstream(folder() / name, std::ios::binary)
                .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
            MESSAGE("kept " << name);
        };
        keep(snapshot_name(snapshot_version), snapshot);
        keep(log_name(log_version), log);
        MESSAGE("{" << snapshot_version << ", " << hash_of(with_source) << "u, " << friction_of(world) << "}");
    }
    CHECK_MESSAGE(std::end(snapshots)[-1].version == snapshot_version, "a snapshot of this version is kept, and has a row");
    CHECK_MESSAGE(std::end(logs)[-1] == log_version, "so has a command log");
}

TEST_CASE("kept saves: snapshots of each version load and are the state that they were") {
    for (const Kept& kept : snapshots) {
        CAPTURE(kept.version);
        const Bytes bytes = bytes_of(snapshot_name(kept.version));
        CHECK(version_of(bytes) == kept.version);
        for (const auto& backend : abi_backends()) {
            CAPTURE(backend);
            const auto world = kept_world(backend);
            REQUIRE_MESSAGE(wadi_world_load(world.id, bytes.data(), bytes.size()) == WADI_OK, std::string(wadi_get_last_error()));
            CHECK(hash_of(world) == kept.hash);
            CHECK(steps_of(world) == steps);
            CHECK(friction_of(world) == kept.friction);
            CHECK(sources_of(world) == sources_of(kept_world("cpu")) + (kept.version >= 7 ? 1 : 0));
            auto stats = wadi_default_world_stats();
            REQUIRE(wadi_world_get_stats(world.id, &stats) == WADI_OK);
            CHECK(stats.sand_drift_quanta == 0); // its books came along
            CHECK(stats.water_drift_quanta == 0);
            step(world, 5);
            CHECK(steps_of(world) == steps + 5);
            CHECK(wadi_world_get_error(world.id) == WADI_OK);
        }
    }
}

TEST_CASE("kept saves: command logs of each version play every command that they hold") {
    for (const uint32_t version : logs) {
        CAPTURE(version);
        const Bytes bytes = bytes_of(log_name(version));
        CHECK(version_of(bytes) == version);
        const auto world = kept_world("cpu"), other = kept_world("cpu");
        REQUIRE_MESSAGE(wadi_world_play_commands(world.id, bytes.data(), bytes.size()) == WADI_OK,
                        std::string(wadi_get_last_error()));
        step(world, steps);
        command(other); // the same by hand
        step(other, steps - 3);
        CHECK(hash_of(world) == hash_of(other));
        CHECK(friction_of(world) == 0.61);
        const auto idle = kept_world("cpu");
        step(idle, steps);
        CHECK(hash_of(idle) != hash_of(world)); // control: the commands do something
    }
}

} // namespace kept_saves
