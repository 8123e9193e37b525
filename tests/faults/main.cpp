// wadi-test-faults: a library whose host runs out of memory at every allocation in turn, is killed while it saves, or has a full
// disk. Usage: wadi-test-faults memory [STRIDE] | load [STRIDE] | save | disk; "saver PATH" is the child that is killed.
#include "tests/faults/own_new.hpp"
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

// Allocation number `fail_at` of the process fails, and all later ones where `for_ever`.
std::atomic<long> allocations{0}, live{0}, fail_at{0};
std::atomic<bool> for_ever{false};

} // namespace

void* allocate(std::size_t size) noexcept {
    const long number = ++allocations, at = fail_at;
    if (at > 0 && (number == at || (for_ever && number > at))) return nullptr;
    void* memory = std::malloc(size == 0 ? 1 : size);
    if (memory != nullptr) ++live;
    return memory;
}
void release(void* memory) noexcept {
    if (memory != nullptr) --live;
    std::free(memory);
}

namespace {

const char* const LEVEL = R"({ "format_version": 1, "name": "faults", "grid": { "nx": 6, "ny": 5, "dx": 0.5 }, "dt": 0.02,
    "terrain": [ { "shape": "plane", "height": 0.1, "slope_x": 0.05 } ], "water": [ { "shape": "box", "from": [0, 0], "to": [1, 2], "height": 1 } ],
    "sources": [ { "shape": "disc", "center": [1, 1], "radius": 0.6, "rate": [[0, 0.1], [1, 0.2]] } ], "sides": { "east": { "kind": "outflow" } } })";

int wrong = 0;

void expect(bool good, const std::string& what) {
    if (good) return;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
}

wadi_world_id make_world() {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 2;
    wadi_world_id world{};
    return wadi_create_world_from_level_text(LEVEL, nullptr, nullptr, nullptr, &options, &world) == WADI_OK ? world
                                                                                                            : wadi_world_id{};
}

/// A host's session; true when every call succeeded. Failures must say that memory ran out. Allocations count from the world's
/// making on: the JSON library allocates where it frees a level's text, and ends the process when it cannot.
bool session(long fail = 0) {
    fail_at = 0;
    bool good = true;
    const auto note = [&](wadi_result result, const char* call) {
        if (result == WADI_OK || result == WADI_NOT_READY) return;
        good = false;
        if (result == WADI_ERROR_OUT_OF_MEMORY) return;
        fail_at = 0; // for the text
        expect(false, std::string(call) + " answered " + std::to_string(result));
    };
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 2;
    wadi_world_id world{};
    note(wadi_create_world_from_level_text(LEVEL, nullptr, nullptr, nullptr, &options, &world), "create");
    if (!good) return false;
    allocations = 0;
    fail_at = fail;
    note(wadi_world_set_command_log(world, 1), "set_command_log");
    note(wadi_world_set_rollback(world, 2, 1), "set_rollback");
    note(wadi_world_set_outputs(world, 1), "set_outputs");
    note(wadi_world_set_profiling(world, 1), "set_profiling"); // what times steps is the device's thread
    note(wadi_world_step(world, 2), "step");
    note(wadi_world_set_profiling(world, 0), "end of profiling");
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = edit.y0 = 1.2;
    edit.radius = 1;
    edit.amount = 0.3;
    note(wadi_world_edit(world, &edit, 1), "edit");
    note(wadi_world_step(world, 1), "step that promotes");
    auto frame = wadi_default_frame();
    note(wadi_world_update(world, 45'000'000, &frame), "update");
    size_t bytes = 0;
    note(wadi_world_save(world, nullptr, &bytes), "save: size");
    static unsigned char snapshot[1 << 20];
    size_t room = sizeof snapshot;
    const auto saved = wadi_world_save(world, snapshot, &room);
    note(saved, "save");
    if (saved == WADI_OK) note(wadi_world_load(world, snapshot, room), "load");
    uint64_t ticket = 0;
    const auto begun = wadi_world_begin_save(world, &ticket);
    note(begun, "begin_save");
    for (auto ended = WADI_NOT_READY; begun == WADI_OK && ended == WADI_NOT_READY;) { // put together by a thread of its own
        room = sizeof snapshot;
        ended = wadi_world_end_save(world, ticket, snapshot, &room);
        note(ended, "end_save");
    }
    const float xy[4] = {1, 1, 2, 2};
    note(wadi_world_query(world, xy, 2, &ticket), "query");
    static float cells[30];
    note(wadi_world_read_field(world, WADI_FIELD_TOTAL_WATER_DEPTH, cells, 30), "read_field");
    auto stats = wadi_default_world_stats();
    const auto known = wadi_world_get_stats(world, &stats);
    note(known, "get_stats");
    if (known == WADI_OK && (stats.water_drift_quanta != 0 || stats.sand_drift_quanta != 0)) ++wrong;
    size_t log_bytes = 0;
    note(wadi_world_get_commands(world, nullptr, &log_bytes), "get_commands");
    note(wadi_world_trim(world), "trim");
    wadi_destroy_world(world);
    return good;
}

/// One allocation fails, or all from one on; each `stride`-th in turn until a session needs no more.
int memory(long stride) {
    session();
    const long before = live + 4; // what is made once and stays: the thread's last error, the table of worlds
    expect(session(), "a session without faults");
    const long needed = allocations;
    expect(live <= before, "a session leaves nothing");
    std::printf("%ld allocations in a session\n", needed);
    for (const bool lasting : {false, true}) {
        int failed = 0;
        for (long n = 1; n <= needed && wrong < 10; n += stride) {
            for_ever = lasting;
            if (!session(n)) ++failed;
            fail_at = 0;
            expect(live <= before, "allocation " + std::to_string(n) + (lasting ? " and all later ones" : "") +
                                       " failed: " + std::to_string(live - before) +
                                       " too many are left"); // leaks add up from session to session
        }
        std::printf("%s: %d sessions ended with an error\n", lasting ? "all from one on" : "one alone", failed);
        expect(failed > needed / stride / 2, "most failures are told");
    }
    expect(session(), "a session afterwards");
    return wrong;
}

/// A snapshot is taken whole or not at all, whichever allocations fail: of the same effects, of more, of another material. Of the
/// latter two one allocation in `stride` fails.
int load(long stride) {
    const auto bytes_of = [](wadi_world_id world) {
        size_t size = 0;
        expect(wadi_world_save(world, nullptr, &size) == WADI_OK, "save: size");
        std::vector<unsigned char> bytes(size);
        expect(wadi_world_save(world, bytes.data(), &size) == WADI_OK, "save");
        return bytes;
    };
    const auto hash_of = [](wadi_world_id world) {
        std::uint64_t hash = 0;
        expect(wadi_world_get_hash(world, &hash) == WADI_OK, "hash");
        return hash;
    };
    const auto other = make_world();
    expect(wadi_world_step(other, 3) == WADI_OK, "step");
    std::vector<std::vector<unsigned char>> snapshots{bytes_of(other)};
    auto edit = wadi_default_edit();
    edit.layer = WADI_LAYER_SAND;
    edit.x0 = edit.y0 = 1.2;
    edit.radius = 1;
    edit.amount = 0.3;
    expect(wadi_world_edit(other, &edit, 1) == WADI_OK && wadi_world_step(other, 2) == WADI_OK, "promotion");
    snapshots.push_back(bytes_of(other));
    expect(wadi_world_set_material(other, "sand_density", 1700) == WADI_OK && wadi_world_step(other, 1) == WADI_OK, "material");
    snapshots.push_back(bytes_of(other));
    wadi_destroy_world(other);
    int refused = 0, loads = 0;
    for (std::size_t n = 0; n < snapshots.size(); ++n) {
        const auto& snapshot = snapshots[n];
        for (const bool lasting : {false, true}) {
            bool failed = true;
            for (long at = 1; failed && wrong < 10; at += n == 0 ? 1 : stride, ++loads) {
                const std::string which = "snapshot " + std::to_string(n) + ", allocation " + std::to_string(at);
                const auto world = make_world();
                const float xy[2] = {1, 1};
                uint64_t ticket = 0;
                expect(wadi_world_set_rollback(world, 2, 1) == WADI_OK && wadi_world_step(world, 2) == WADI_OK &&
                           wadi_world_query(world, xy, 1, &ticket) == WADI_OK,
                       which + ": a world in use");
                const std::uint64_t before = hash_of(world);
                for_ever = lasting;
                allocations = 0;
                fail_at = at;
                const auto result = wadi_world_load(world, snapshot.data(), snapshot.size());
                failed = allocations >= at;
                fail_at = 0;
                if (result == WADI_OK) {
                    expect(bytes_of(world) == snapshot, which + ": what was loaded is the snapshot");
                } else {
                    ++refused;
                    uint64_t kept[2];
                    uint32_t count = 2;
                    expect(result == WADI_ERROR_OUT_OF_MEMORY, which + ": answered " + std::to_string(result));
                    expect(hash_of(world) == before, which + ": the world is as it was");
                    expect(wadi_world_get_rollback_steps(world, kept, &count) == WADI_OK && count == 2,
                           which + ": so are its kept states");
                    expect(wadi_world_load(world, snapshot.data(), snapshot.size()) == WADI_OK && bytes_of(world) == snapshot,
                           which + ": with memory it loads");
                }
                expect(wadi_world_step(world, 2) == WADI_OK, which + ": the world runs on");
                wadi_destroy_world(world);
            }
        }
    }
    std::printf("%d loads of %zu snapshots, %d refused\n", loads, snapshots.size(), refused);
    expect(refused > loads / 2, "most are refused");
    return wrong;
}

std::string path_of(const char* name) {
    return (std::filesystem::temp_directory_path() / (std::string("wadi-") + name + "-" + std::to_string(getpid()))).string();
}

/// Files that were not finished; how many there were.
int remove_parts_of(const std::string& path) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(path).parent_path())) {
        const std::string name = entry.path().string();
        if (name.starts_with(path) && name.ends_with(".part")) count += std::filesystem::remove(entry.path()) ? 1 : 0;
    }
    return count;
}

/// Saves again and again; the first file is there before the parent may kill it.
int saver(const char* path) {
    const auto world = make_world();
    for (;;) {
        if (wadi_world_step(world, 1) != WADI_OK || wadi_world_save_file(world, path) != WADI_OK) return 1;
    }
}

/// Kills a process that saves, at random moments: the file is always whole.
int save(const char* self) {
    const std::string path = path_of("killed");
    int loaded = 0;
    for (int round = 0; round < 40; ++round) {
        const pid_t child = fork();
        if (child == 0) {
            execl(self, self, "saver", path.c_str(), static_cast<char*>(nullptr));
            _exit(127);
        }
        for (int n = 0; n < 5000 && !std::filesystem::exists(path); ++n)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(std::chrono::microseconds(3000 + 977 * round));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        expect(WIFSIGNALED(status), "the child was killed, not done");
        const auto world = make_world();
        const bool good = wadi_world_load_file(world, path.c_str()) == WADI_OK;
        expect(good, "the file is a whole snapshot");
        if (good) ++loaded;
        wadi_destroy_world(world);
    }
    // Negative control: half a file is refused.
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const auto world = make_world();
    expect(wadi_world_load_file(world, path.c_str()) == WADI_ERROR_BAD_FILE, "half a file is refused");
    wadi_destroy_world(world);
    std::filesystem::remove(path);
    remove_parts_of(path); // of those that were killed
    std::printf("killed 40 times while saving, %d whole files\n", loaded);
    return wrong;
}

/// Files may grow to a part of a snapshot only: the old one survives, nothing else is left.
int disk() {
    const std::string path = path_of("full");
    const auto world = make_world();
    expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "saved while there is room");
    std::uint64_t old_hash = 0, hash = 0;
    expect(wadi_world_get_hash(world, &old_hash) == WADI_OK, "hash");
    expect(wadi_world_step(world, 3) == WADI_OK, "step");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{std::filesystem::file_size(path) / 2, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    expect(wadi_world_save_file(world, path.c_str()) == WADI_ERROR_BAD_FILE, "a full disk is told");
    expect(std::string(wadi_get_last_error()).find("writing") != std::string::npos, "by what failed");
    setrlimit(RLIMIT_FSIZE, &limit);
    expect(remove_parts_of(path) == 0, "no part of a file is left");
    expect(wadi_world_load_file(world, path.c_str()) == WADI_OK && wadi_world_get_hash(world, &hash) == WADI_OK &&
               hash == old_hash,
           "the old snapshot is whole");
    expect(wadi_world_save_file(world, path.c_str()) == WADI_OK, "saved once there is room again");
    wadi_destroy_world(world);
    std::filesystem::remove(path);
    return wrong;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "saver" && argc > 2) return saver(argv[2]);
    if (what != "memory" && what != "load" && what != "save" && what != "disk") {
        std::fprintf(stderr, "wadi-test-faults memory [STRIDE] | load [STRIDE] | save | disk\n");
        return 2;
    }
    const long stride = argc > 2 ? std::atol(argv[2]) : what == "load" ? 13 : 1;
    if (stride < 1) {
        std::fprintf(stderr, "wadi-test-faults: STRIDE is \"%s\"; it is a whole number from 1 on\n", argv[2]);
        return 2;
    }
    const int failures = what == "memory" ? memory(stride)
                         : what == "load" ? load(stride)
                         : what == "save" ? save(argv[0])
                                          : disk();
    std::puts(failures == 0 ? "passed" : "FAILED");
    return failures == 0 ? 0 : 1;
}
