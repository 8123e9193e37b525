// wadi-test-attack: hosts in odd surroundings, many at once, for long, and files that do harm, through the C interface. What it
// asserts of memory and time is of this process. Usage: wadi-test-attack has BACKEND | environment [BACKEND] | memory | hosts
// SECONDS | files | soak BACKEND STEPS | cycles BACKEND COUNT.
#include "tests/unit/map_files.hpp"
#include <algorithm>
#include <atomic>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <locale>
#include <malloc.h>
#include <memory>
#include <pthread.h>
#include <sched.h>
#include <string>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

using map_files::Bytes;
using map_files::Folder;

std::atomic<int> wrong{0};

bool expect(bool good, const std::string& what) {
    if (good) return true;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
    return false;
}

std::string backend = "cpu";

std::string level_text(int n) {
    const std::string size = std::to_string(n);
    return R"({ "format_version": 1, "name": "attack", "grid": { "nx": )" + size + R"(, "ny": )" + size +
           R"(, "dx": 0.5 }, "dt": 0.02, "terrain": [ { "shape": "plane", "height": 0.15, "slope_x": 0.02 } ],)"
           R"("water": [ { "shape": "box", "from": [0, 0], "to": [4.5, 6.25], "height": 1.5 } ],)"
           R"("sand": [ { "shape": "cone", "center": [8.5, 8], "radius": 3.5, "height": 1.25 } ],)"
           R"("sources": [ { "shape": "disc", "center": [3, 3], "radius": 0.75, "rate": [[0, 0.25], [1, 0.125]] } ],)"
           R"("rain": 1e-5, "evaporation": 1e-5, "sides": { "east": { "kind": "outflow" } } })";
}

wadi_result make(int n, wadi_world_id& world) {
    auto options = wadi_default_device_options();
    options.backend = backend.c_str();
    options.threads = 2;
    return wadi_create_world_from_level_text(level_text(n).c_str(), nullptr, nullptr, nullptr, &options, &world);
}

wadi_edit brush(wadi_layer layer) {
    auto edit = wadi_default_edit();
    edit.layer = layer;
    edit.x0 = edit.y0 = 5.5;
    edit.radius = 1.5;
    edit.amount = 0.0625;
    return edit;
}

bool ledger_holds(wadi_world_id world) {
    auto stats = wadi_default_world_stats();
    return wadi_world_get_stats(world, &stats) == WADI_OK && stats.water_drift_quanta == 0 && stats.sand_drift_quanta == 0;
}

/// A world made, run, saved, loaded and destroyed; its hash, 0 where a call failed.
std::uint64_t session() {
    wadi_world_id world{};
    if (!expect(make(32, world) == WADI_OK, "create")) return 0;
    const auto edit = brush(WADI_LAYER_SAND);
    bool good = wadi_world_step(world, 5) == WADI_OK && wadi_world_edit(world, &edit, 1) == WADI_OK;
    size_t bytes = 0;
    good = good && wadi_world_save(world, nullptr, &bytes) == WADI_OK;
    std::vector<unsigned char> snapshot(bytes);
    good = good && wadi_world_save(world, snapshot.data(), &bytes) == WADI_OK && wadi_world_step(world, 3) == WADI_OK &&
           wadi_world_load(world, snapshot.data(), bytes) == WADI_OK;
    for (int n = 0; n < 10; ++n) good = good && wadi_world_step(world, 1) == WADI_OK; // an update drops time where all is busy
    std::uint64_t hash = 0;
    good = good && ledger_holds(world) && wadi_world_get_hash(world, &hash) == WADI_OK;
    expect(good, "a session");
    expect(wadi_destroy_world(world) == WADI_OK, "destroy");
    return good ? hash : 0;
}

/// What a child that calls `body` used.
struct Child {
    int code = 0; // its exit code, or minus the signal that ended it
    double seconds = 0;
    double mebibytes = 0;
};
Child run_child(const std::function<int()>& body) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        alarm(120);
        wrong = 0;
        const int code = body();
        std::fflush(nullptr);
        _exit(code);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), seconds(used.ru_utime) + seconds(used.ru_stime),
            static_cast<double>(used.ru_maxrss) / 1024};
}

// ---- environment ----

/// 1,5 and 1.234.567.
struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

constexpr int not_here = 77; // the machine does not allow the surroundings

int in_comma_locale() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) std::setlocale(LC_ALL, name);
    std::locale::global(std::locale(std::locale(), new Commas));
    return 0;
}
int under_signals() {
    struct sigaction action {};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, nullptr); // without SA_RESTART
    const itimerval often{{0, 200}, {0, 200}};
    return setitimer(ITIMER_REAL, &often, nullptr);
}
int without_folder() {
    char name[] = "/tmp/wadi-gone-XXXXXX";
    return mkdtemp(name) != nullptr && chdir(name) == 0 && rmdir(name) == 0 ? 0 : not_here;
}
int without_descriptors() {
    const rlimit none{0, 0};
    return setrlimit(RLIMIT_NOFILE, &none);
}
int without_proc() {
    if (unshare(CLONE_NEWNS) != 0) return not_here;
    if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return not_here;
    return mount("none", "/proc", "tmpfs", 0, nullptr) == 0 ? 0 : not_here;
}
int without_home() { return unsetenv("HOME") + unsetenv("XDG_CACHE_HOME") + unsetenv("TMPDIR"); }
int home_that_is_none() { return setenv("HOME", "/proc/none", 1) + setenv("XDG_CACHE_HOME", "/proc/none", 1); }

/// Calls `body` on a thread whose stack is so small.
void on_small_stack(std::size_t bytes, void* (*body)(void*), void* argument) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_t thread{};
    if (expect(pthread_attr_setstacksize(&attributes, bytes) == 0 && pthread_create(&thread, &attributes, body, argument) == 0,
               "a small stack"))
        pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

int environment() {
    // Found in a child: a parent that used Vulkan may not fork children that do.
    int ends[2];
    if (!expect(pipe(ends) == 0, "pipe")) return wrong;
    const auto session_in = [&](int (*surroundings)()) {
        return run_child([&] {
            const int there = surroundings();
            if (there != 0) return there;
            const std::uint64_t hash = session();
            return write(ends[1], &hash, sizeof hash) == sizeof hash ? static_cast<int>(wrong) : 1;
        });
    };
    const auto hash_of = [&] {
        std::uint64_t hash = 0;
        return read(ends[0], &hash, sizeof hash) == sizeof hash ? hash : 0;
    };
    expect(session_in([] { return 0; }).code == 0, "a session in plain surroundings");
    const std::uint64_t expected = hash_of();
    const std::pair<const char*, int (*)()> kinds[] = {{"decimal commas", in_comma_locale},
                                                       {"a signal every 200 us", under_signals},
                                                       {"no working folder", without_folder},
                                                       {"no descriptors", without_descriptors},
                                                       {"no /proc", without_proc},
                                                       {"no HOME", without_home},
                                                       {"a HOME that cannot be", home_that_is_none}};
    for (const auto& [name, surroundings] : kinds) {
        if (backend != "cpu" && surroundings == without_descriptors) continue; // a driver is files
        if (backend == "cuda" && surroundings == without_proc) continue;       // and NVIDIA's looks into /proc
        const auto ran = session_in(surroundings);
        std::printf("%s: %s\n", name, ran.code == 0 ? "same bits" : ran.code == not_here ? "not on this machine" : "FAILED");
        if (ran.code == not_here) continue;
        if (expect(ran.code == 0, std::string(name) + ": ended with " + std::to_string(ran.code)))
            expect(hash_of() == expected, std::string(name) + ": other bits");
    }
    const std::size_t stack = backend == "cpu" ? 65536 : 1 << 20; // a driver compiles on the caller's
    const auto small = run_child([&] {
        std::uint64_t hash = 0;
        on_small_stack(
            stack,
            [](void* to) -> void* {
                *static_cast<std::uint64_t*>(to) = session();
                return nullptr;
            },
            &hash);
        expect(hash == expected, "other bits on a small stack");
        return static_cast<int>(wrong);
    });
    std::printf("a stack of %zu KiB: %s\n", stack >> 10, small.code == 0 ? "same bits" : "FAILED");
    expect(small.code == 0, "a stack of 64 KiB: ended with " + std::to_string(small.code));
    return wrong;
}

// ---- memory ----

std::uint64_t pages(int column) {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t value = 0;
    for (int n = 0; n <= column; ++n) statm >> value;
    return value;
}

/// Makes worlds until one is refused. 0 where that was told as a lack of memory.
int worlds_until_refused(int cells) {
    for (int n = 0; n < 1000; ++n) {
        wadi_world_id world{};
        const auto made = make(cells, world);
        const auto stepped = made == WADI_OK ? wadi_world_step(world, 2) : made;
        if (stepped == WADI_ERROR_OUT_OF_MEMORY) return 0;
        if (!expect(stepped == WADI_OK, "a world too many is told as a lack of memory")) return 1;
    }
    return 2;
}

/// A group of processes that may take so many bytes; its folder, empty where the machine allows none.
std::string memory_group(const std::string& bytes) {
    const std::string name = "wadi-attack-" + std::to_string(getpid());
    for (const auto& [root, limit] : {std::pair<std::string, const char*>{"/sys/fs/cgroup/", "memory.max"},
                                      {"/sys/fs/cgroup/memory/", "memory.limit_in_bytes"}}) {
        std::error_code failed;
        const std::string folder = root + name;
        if (!std::filesystem::exists(root + "cgroup.procs", failed) || !std::filesystem::create_directory(folder, failed))
            continue;
        std::ofstream file(folder + "/" + limit);
        if (file << bytes << std::flush) return folder;
        std::filesystem::remove(folder, failed);
    }
    return {};
}

int memory() {
    for (const std::uint64_t mebibytes : {4, 16, 48, 100, 300}) {
        const auto ran = run_child([&] {
            const rlim_t most = pages(0) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (mebibytes << 20);
            const rlimit limit{most, most};
            setrlimit(RLIMIT_AS, &limit);
            return worlds_until_refused(200);
        });
        expect(ran.code == 0,
               "address space of " + std::to_string(mebibytes) + " MiB more: ended with " + std::to_string(ran.code));
    }
    std::printf("address space for 4 to 300 MiB more: worlds until one is refused\n");
    const std::string group = memory_group("314572800");
    if (group.empty()) {
        std::printf("a control group of 300 MiB: not on this machine\n");
        return wrong;
    }
    const auto ran = run_child([&] {
        std::ofstream(group + "/cgroup.procs") << getpid() << std::flush;
        return worlds_until_refused(700);
    });
    std::printf("a control group of 300 MiB: at most %.0f MiB used\n", ran.mebibytes);
    expect(ran.code == 0, "a control group of 300 MiB: ended with " + std::to_string(ran.code));
    rmdir(group.c_str());
    return wrong;
}

// ---- many at once ----

int hosts(double seconds) {
    const std::uint64_t expected = session();
    std::atomic<bool> done{false};
    std::atomic<long> worlds{0};
    std::vector<std::thread> threads;
    for (int n = 0; n < 4; ++n) {
        threads.emplace_back([&] {
            for (; !done; ++worlds) expect(session() == expected, "other bits beside other hosts");
        });
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    done = true;
    for (auto& thread : threads) thread.join();
    std::printf("four hosts in one process: %ld worlds\n", worlds.load());
    expect(worlds >= 4, "each host had a world");
    return wrong;
}

// ---- files ----

/// As large as it may be, without its bytes.
std::string sparse(const Folder& folder, const std::string& name, const std::string& begin, std::uintmax_t bytes) {
    const std::string path = folder.write(name, begin);
    std::filesystem::resize_file(path, bytes);
    return path;
}

/// Seconds and MiB that reading may cost beyond those of a small file.
constexpr double most_seconds = 2, most_mebibytes = 160;
constexpr std::size_t most_text = 1100;

int files() {
    const Folder folder;
    const std::string head =
        R"({ "format_version": 1, "name": "attack", "dt": 0.02, "grid": { "nx": 16, "ny": 16, "dx": 0.5 }, )";
    const auto from_file = [&](const std::string& path) {
        wadi_world_id world{};
        auto options = wadi_default_device_options();
        options.backend = backend.c_str();
        options.threads = 1;
        return wadi_create_world_from_level(path.c_str(), nullptr, &options, &world);
    };
    const auto with_map = [&](const std::string& name) {
        const bool integers = name.ends_with("png") || name.ends_with("r16");
        return from_file(folder.write(name + ".json", head + R"("terrain": [ { "file": ")" + name + "\"" +
                                                          (integers ? ", \"max\": 1" : "") + " } ] }"));
    };
    const auto world = [&] {
        wadi_world_id id{};
        expect(make(32, id) == WADI_OK, "create");
        return id;
    };
    const auto play = [&](std::vector<unsigned char> log, const std::function<void(std::vector<unsigned char>&)>& harm) {
        harm(log);
        const auto id = world();
        return wadi_world_play_commands(id, log.data(), log.size());
    };
    std::vector<unsigned char> log;
    {
        const auto id = world();
        const auto edit = brush(WADI_LAYER_SAND);
        size_t bytes = 0;
        expect(wadi_world_set_command_log(id, 1) == WADI_OK && wadi_world_edit(id, &edit, 1) == WADI_OK &&
                   wadi_world_get_commands(id, nullptr, &bytes) == WADI_OK,
               "a command log");
        log.resize(bytes);
        expect(wadi_world_get_commands(id, log.data(), &bytes) == WADI_OK && wadi_destroy_world(id) == WADI_OK, "its bytes");
    }
    folder.write("small.npy", map_files::npy(map_files::dictionary("<f4", "(4, 4)"), std::vector<float>(16, 0.5F)));
    folder.write("bomb.png", map_files::png_of_zeros(16384, 16384, 16, 6));
    folder.write("flat.png", map_files::png_of_zeros(16000, 1, 8, 0));
    folder.write("wide.npy", map_files::npy(map_files::dictionary("<f8", "(1000000, 1000000)"), std::vector<double>(4)));
    folder.write("turned.npy", map_files::npy(map_files::dictionary("<f4", "(-4, -4)"), std::vector<float>(16)));
    folder.write("past.npy", map_files::npy(map_files::dictionary("<f4", "(18446744073709551615, 2)"), std::vector<float>(16)));
    folder.write("wide.asc", "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
    folder.write("long.asc", "ncols 4\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + std::string(5'000'000, '1') + "\n");
    folder.write("many.asc", [] {
        std::string text = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
        while (text.size() < 5'000'000) text += "1 ";
        return text;
    }());
    sparse(folder, "holes.r16", "", std::uintmax_t{1} << 38);
    sparse(folder, "holes.png", "\x89PNG\r\n\x1a\n", std::uintmax_t{1} << 38);
    const std::string huge = sparse(folder, "huge.snapshot", "WADISNAP", std::uintmax_t{1} << 40);
    const auto repeated = [](const std::string& what, std::size_t count) {
        std::string text;
        while (count-- > 0) text += what;
        return text;
    };
    struct Attack {
        std::string reader, name;
        std::string why; // a part of the message; empty where it is taken
        std::function<wadi_result()> read;
    };
    const std::vector<Attack> attacks = {
        {"npy", "small", "", [&] { return with_map("small.npy"); }},
        {"level", "100 000 brackets", "nested",
         [&] { return from_file(folder.write("deep.json", head + R"("terrain": )" + repeated("[", 100000))); }},
        {"level", "a million layers", "more than 256",
         [&] { return from_file(folder.write("layers.json", head + R"("terrain": [)" + repeated("{},", 1000000) + "{}]}")); }},
        {"level", "5 MB of digits", "number overflow",
         [&] { return from_file(folder.write("digits.json", head + R"("duration": )" + repeated("9", 5'000'000) + "}")); }},
        {"level", "a name of 5 MB", "unknown key",
         [&] { return from_file(folder.write("name.json", head + R"("extra)" + repeated("x", 5'000'000) + R"(": 1})")); }},
        {"level", "zeros", "line 1, column 1", [&] { return from_file(sparse(folder, "zeros.json", "", 5'000'000)); }},
        {"level", "holes of 1 TiB", "largest accepted",
         [&] { return from_file(sparse(folder, "holes.json", "{", std::uintmax_t{1} << 40)); }},
        {"level", "a grid of 2e9 by 2e9", "outside 1 ... 16384",
         [&] {
             return from_file(folder.write("grid.json", std::string(R"({ "format_version": 1, "name": "attack", "dt": 0.02,
                 "grid": { "nx": 2000000000, "ny": 2000000000, "dx": 0.5 } })")));
         }},
        {"png", "16384 x 16384 of 8 bytes in 13 MB", "largest PNG", [&] { return with_map("bomb.png"); }},
        {"png", "16000 x 1", "", [&] { return with_map("flat.png"); }},
        {"png", "holes of 256 GiB", "largest accepted", [&] { return with_map("holes.png"); }},
        {"npy", "a million by a million", "outside 1", [&] { return with_map("wide.npy"); }},
        {"npy", "-4 by -4", "outside 1", [&] { return with_map("turned.npy"); }},
        {"npy", "2^64 - 1 by 2", "(rows, columns)", [&] { return with_map("past.npy"); }},
        {"asc", "2e9 by 2e9", "whole number", [&] { return with_map("wide.asc"); }},
        {"asc", "a number of 5 MB", "line 6", [&] { return with_map("long.asc"); }},
        {"asc", "2.5 million numbers for 16 cells", "more values", [&] { return with_map("many.asc"); }},
        {"r16", "holes of 256 GiB", "largest accepted", [&] { return with_map("holes.r16"); }},
        {"snapshot", "holes of 1 TiB", "largest snapshot", [&] { return wadi_world_load_file(world(), huge.c_str()); }},
        {"commands", "as written", "", [&] { return play(log, [](auto&) {}); }},
        {"commands", "cut", "there are 159", [&] { return play(log, [](auto& bytes) { bytes.resize(bytes.size() - 1); }); }},
        {"commands", "a count of 2^32 - 1", "checksum",
         [&] { return play(log, [](auto& bytes) { std::fill_n(bytes.begin() + 32, 8, static_cast<unsigned char>(255)); }); }},
    };
    double usual = 0, most = 0;
    std::printf("| reader | file | CPU s | MiB |\n| --- | --- | --- | --- |\n");
    for (const auto& attack : attacks) {
        const std::string name = attack.reader + ", " + attack.name;
        const auto ran = run_child([&] {
            wrong = 0;
            const auto answer = attack.read();
            const std::string message = wadi_get_last_error();
            expect(message.size() <= most_text, "a message that can be shown");
            if (wrong > 0) return 99;
            if (answer == WADI_OK ? attack.why.empty() : message.find(attack.why) != std::string::npos) return 0;
            std::fprintf(stderr, "answered %d: %s\n", answer, message.substr(0, 300).c_str());
            return 1;
        });
        if (usual == 0) usual = ran.mebibytes;
        std::printf("| %s | %s | %.2f | %.0f |\n", attack.reader.c_str(), attack.name.c_str(), ran.seconds,
                    ran.mebibytes - usual);
        most = std::max(most, ran.mebibytes - usual);
        expect(ran.code == 0, name + ": ended with " + std::to_string(ran.code));
        expect(ran.seconds < most_seconds, name + ": took " + std::to_string(ran.seconds) + " s");
        expect(ran.mebibytes - usual < most_mebibytes, name + ": took " + std::to_string(ran.mebibytes - usual) + " MiB");
    }
    expect(most > 20, "what a file takes is seen"); // control: a million layers are read before they are counted
    return wrong;
}

// ---- for long ----

/// `resident` also grows as threads touch what malloc's arenas kept, for some thousand steps; `live` is what was asked for and
/// not given back.
struct Held {
    double resident = 0, live = 0; // KiB
    long threads = 0, descriptors = 0;
};
Held held() {
    const auto count = [](const char* folder) {
        return static_cast<long>(
            std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator{}));
    };
    const auto heap = mallinfo2();
    return {static_cast<double>(pages(1)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024,
            static_cast<double>(heap.uordblks + heap.hblkhd) / 1024, count("/proc/self/task"), count("/proc/self/fd")};
}

void expect_no_more(const Held& before, const std::string& what, double resident, double live) {
    const auto after = held();
    std::printf("%s: %.0f KiB resident before, %.0f after; %.1f and %.1f live; threads %ld and %ld, descriptors %ld and %ld\n",
                what.c_str(), before.resident, after.resident, before.live, after.live, before.threads, after.threads,
                before.descriptors, after.descriptors);
    expect(after.resident - before.resident < resident, what + ": memory grows");
    expect(after.live - before.live < live, what + ": blocks are left");
    expect(after.threads <= before.threads && after.descriptors <= before.descriptors,
           what + ": threads or descriptors are left");
}

constexpr double MOST_LIVE = 1024; // KiB: what a world keeps from round to round comes and goes by 0.5 MiB
/// What a game does to a world in hours.
int soak(long steps) {
    wadi_world_id world{};
    if (!expect(make(32, world) == WADI_OK, "create")) return wrong;
    expect(wadi_world_set_rollback(world, 4, 8) == WADI_OK && wadi_world_set_outputs(world, 7) == WADI_OK, "roll-back, outputs");
    size_t bytes = 0;
    expect(wadi_world_save(world, nullptr, &bytes) == WADI_OK, "save: size");
    std::vector<unsigned char> snapshot(bytes);
    Held early;
    const long turn = 32, turns = std::max(4L, steps / (16 * turn)),
               rounds = turns * turn; // all that a round may do comes in a turn
    for (long n = 0; n < rounds && wrong == 0; ++n) {
        if (n == turns / 2 * turn) early = held();
        auto edit = brush(n % 2 == 0 ? WADI_LAYER_SAND : WADI_LAYER_WATER);
        edit.x0 = 2 + static_cast<double>(n % 12);
        if (n % 4 >= 2) edit.amount = -edit.amount;
        auto frame = wadi_default_frame();
        const float xy[4] = {1, 2, 9, 8};
        uint64_t ticket = 0;
        bool good = wadi_world_edit(world, &edit, 1) == WADI_OK && wadi_world_step(world, 12) == WADI_OK &&
                    wadi_world_update(world, 80'000'000, &frame) == WADI_OK;
        const auto asked = wadi_world_query(world, xy, 2, &ticket);
        good = good && (asked == WADI_OK || asked == WADI_NOT_READY);
        size_t room = bytes;
        if (n % 8 == 3) good = good && wadi_world_save(world, snapshot.data(), &room) == WADI_OK;
        if (n % 32 == 31) good = good && wadi_world_load(world, snapshot.data(), bytes) == WADI_OK;
        if (n % 16 == 5)
            good = good && wadi_world_set_material(world, "cohesion_dry", 50 + static_cast<double>(n % 7)) == WADI_OK;
        if (n % 16 == 9) good = good && wadi_world_roll_back(world, UINT64_MAX, nullptr) == WADI_OK;
        if (n % turn == 0) good = good && ledger_holds(world);
        expect(good, "round " + std::to_string(n));
    }
    expect(ledger_holds(world), "not a quantum of drift");
    expect_no_more(early, std::to_string(16 * rounds) + " steps on " + backend, 2048, MOST_LIVE);
    std::vector<std::unique_ptr<char[]>> left; // control: small blocks that stay are seen
    const auto before = held().live;
    for (int n = 0; n < 6000; ++n) left.push_back(std::make_unique<char[]>(200));
    expect(held().live - before > MOST_LIVE, "blocks that stay show");
    wadi_destroy_world(world);
    return wrong;
}

int cycles(long count) {
    Held early;
    for (long n = 0; n < count && wrong == 0; ++n) {
        if (n == std::max(2L, count / 10)) early = held();
        wadi_world_id world{};
        if (!expect(make(24, world) == WADI_OK, "create")) break;
        expect(wadi_world_step(world, 2) == WADI_OK, "step");
        expect(wadi_destroy_world(world) == WADI_OK, "destroy");
    }
    const double most = backend == "cpu" ? 512 : 2048;
    expect_no_more(early, std::to_string(count) + " worlds on " + backend, most, most);
    const auto before = held(); // control: worlds that stay are seen
    wadi_world_id left[8]{};
    for (auto& world : left) expect(make(64, world) == WADI_OK && wadi_world_step(world, 2) == WADI_OK, "a world that stays");
    expect(held().resident - before.resident > most, "eight worlds that stay show");
    for (auto& world : left) wadi_destroy_world(world);
    return wrong;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "", given = argc > 2 ? argv[2] : "";
    const auto ends = [](int failures) {
        std::puts(failures == 0 ? "passed" : "FAILED");
        return failures == 0 ? 0 : 1;
    };
    if (what == "hosts" && argc > 2) return ends(hosts(std::atof(argv[2])));
    if (what == "files") return ends(files());
    if (what == "memory") return ends(memory());
    if (!given.empty()) backend = given;
    if (what == "has") {
        wadi_world_id world{};
        return make(8, world) == WADI_OK ? 0 : 1;
    }
    if (what == "environment") return ends(environment());
    if (what == "soak" && argc > 3) return ends(soak(std::atol(argv[3])));
    if (what == "cycles" && argc > 3) return ends(cycles(std::atol(argv[3])));
    std::fprintf(stderr,
                 "wadi-test-attack has BACKEND | environment [BACKEND] | memory | hosts SECONDS | files | soak BACKEND STEPS | "
                 "cycles BACKEND COUNT\n");
    return 2;
}
