// What a host does with every shipped level, knowing only the header: frames, brushes, saving, rolling back, and the command log
// of it all played again on every backend to the same hash.
#include "tests/plugin/plugin_world.hpp"
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

namespace {

using plugin_test::backends;

std::vector<std::string> all_levels() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(WADI_SOURCE_DIR) + "/samples/levels"))
        if (std::filesystem::exists(entry.path() / "level.json")) names.push_back((entry.path() / "level.json").string());
    std::sort(names.begin(), names.end());
    return names;
}

struct Session {
    wadi_world_id id{};
    wadi_world_info info = wadi_default_world_info();
    Session(const std::string& level, const std::string& backend) {
        auto overrides = wadi_default_level_overrides();
        overrides.nx = 40;
        overrides.ny = 36;
        auto options = wadi_default_device_options();
        options.backend = backend.c_str();
        REQUIRE_MESSAGE(wadi_create_world_from_level(level.c_str(), &overrides, &options, &id) == WADI_OK,
                        std::string(wadi_get_last_error()));
        REQUIRE(wadi_world_get_info(id, &info) == WADI_OK);
        auto settings = wadi_default_update_settings();
        settings.max_steps_in_flight = 0; // every step is taken, however slow the device
        settings.max_steps_per_update = 1024;
        REQUIRE(wadi_world_set_update_settings(id, &settings) == WADI_OK);
    }
    ~Session() { wadi_destroy_world(id); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    uint64_t hash() const {
        uint64_t value = 0;
        REQUIRE(wadi_world_get_hash(id, &value) == WADI_OK);
        return value;
    }
    uint64_t steps() const {
        uint64_t value = 0;
        REQUIRE(wadi_world_get_time(id, nullptr, &value) == WADI_OK);
        return value;
    }
    /// Frames of uneven length until `count` steps are done.
    void frames_until(uint64_t count, double shortest) const {
        for (int n = 0; steps() < count; ++n) {
            const double left = static_cast<double>(count - steps()), want = std::min(left, shortest + 0.3 * (n % 3));
            auto frame = wadi_default_frame();
            REQUIRE(wadi_world_update(id, static_cast<uint64_t>(want * info.dt * 1e9) + 1, &frame) == WADI_OK);
            REQUIRE(frame.dropped_nanoseconds == 0);
        }
        REQUIRE(steps() == count);
    }
    void brush(wadi_layer layer, double x, double y, double amount) const {
        auto edit = wadi_default_edit();
        edit.kind = WADI_EDIT_BRUSH;
        edit.layer = layer;
        edit.x0 = x * info.nx * info.dx;
        edit.y0 = y * info.ny * info.dx;
        edit.radius = 4 * info.dx;
        edit.amount = amount * info.dx;
        REQUIRE_MESSAGE(wadi_world_edit(id, &edit, 1) == WADI_OK, std::string(wadi_get_last_error()));
    }
};

} // namespace

TEST_CASE("every level: frames, edits, saving, rolling back, and the log of it replayed to the same hash on every backend") {
    int turn = 0;
    for (const auto& level : all_levels()) {
        CAPTURE(level);
        // Most of a GPU's time is making pipelines for each world; its first steps of every level: tests/levels.
        const auto chosen = turn++ % 2 == 0 ? backends() : std::vector<std::string>{"cpu"};
        std::map<std::string, std::vector<unsigned char>> logs;
        std::map<std::string, uint64_t> hashes;
        for (const auto& backend : chosen) {
            CAPTURE(backend);
            const Session session(level, backend);
            REQUIRE(wadi_world_set_command_log(session.id, 1) == WADI_OK);
            REQUIRE(wadi_world_set_rollback(session.id, 3, 4) == WADI_OK);
            session.frames_until(5, 0.4);
            session.brush(WADI_LAYER_SAND, 0.4, 0.5, 0.5);
            session.brush(WADI_LAYER_WATER, 0.6, 0.5, 0.25);
            session.frames_until(8, 0.7);
            const uint64_t at_eight = session.hash();
            size_t bytes = 0;
            REQUIRE(wadi_world_save(session.id, nullptr, &bytes) == WADI_OK);
            std::vector<unsigned char> saved(bytes);
            REQUIRE(wadi_world_save(session.id, saved.data(), &bytes) == WADI_OK);
            session.brush(WADI_LAYER_TERRAIN, 0.5, 0.4, 0.25);
            session.frames_until(11, 1.1);
            uint64_t reached = 0;
            REQUIRE(wadi_world_roll_back(session.id, 10, &reached) == WADI_OK);
            REQUIRE(reached == 8);
            CHECK(session.hash() == at_eight);
            session.frames_until(14, 0.5);
            const uint64_t end = session.hash();
            auto stats = wadi_default_world_stats();
            REQUIRE(wadi_world_get_stats(session.id, &stats) == WADI_OK);
            CHECK(stats.sand_drift_quanta == 0);
            CHECK(stats.water_drift_quanta == 0);
            CHECK(stats.not_finite == 0);
            CHECK(stats.sand_in > 0);
            size_t log_bytes = 0;
            REQUIRE(wadi_world_get_commands(session.id, nullptr, &log_bytes) == WADI_OK);
            logs[backend].resize(log_bytes);
            REQUIRE(wadi_world_get_commands(session.id, logs[backend].data(), &log_bytes) == WADI_OK);
            REQUIRE(wadi_world_load(session.id, saved.data(), saved.size()) == WADI_OK);
            CHECK(session.hash() == at_eight);
            hashes[backend] = end;
        }
        for (const auto& [recorded, log] : logs) {
            for (const auto& backend : chosen) {
                if (logs.size() > 1 && backend == recorded) continue;
                CAPTURE(recorded);
                CAPTURE(backend);
                const Session replay(level, backend);
                REQUIRE_MESSAGE(wadi_world_play_commands(replay.id, log.data(), log.size()) == WADI_OK,
                                std::string(wadi_get_last_error()));
                replay.frames_until(14, 2.3);
                CHECK(replay.hash() == hashes[recorded]);
            }
        }
    }
}
