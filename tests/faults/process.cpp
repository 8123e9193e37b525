// wadi-test-process: what a host's process does to the library in it. Usage: wadi-test-process threads | exit | fork; "ends ..."
// is a child of "exit".
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <functional>
#include <pthread.h>
#include <sched.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>
#include <wadi/wadi.h>

namespace {

// Thread number `refused_from` of the process is refused, and all later ones where `refuses_on`.
std::atomic<long> threads_asked{0}, refused_from{0};
std::atomic<bool> refuses_on{false};

} // namespace

// In place of the system's for the shared library, too.
extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                                                     void* (*start)(void*), void* argument) {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto system = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    const long number = ++threads_asked, from = refused_from;
    if (from > 0 && (number == from || (refuses_on && number > from))) return EAGAIN;
    return system(thread, attributes, start, argument);
}

namespace {

using namespace std::chrono_literals;

int wrong = 0;

void expect(bool good, const std::string& what) {
    if (good) return;
    ++wrong;
    std::fprintf(stderr, "WRONG: %s (%s)\n", what.c_str(), wadi_get_last_error());
}

/// n x n cells, from 200 on more than one thread draws and checks.
wadi_result make(int n, wadi_world_id& world) {
    const std::string size = std::to_string(n);
    const std::string level = R"({ "format_version": 1, "name": "process", "grid": { "nx": )" + size + R"(, "ny": )" + size +
                              R"(, "dx": 0.5 }, "dt": 0.02, "terrain": [ { "shape": "plane", "height": 0.1, "slope_x": 0.05 } ],)"
                              R"("water": [ { "shape": "box", "from": [0, 0], "to": [40, 40], "height": 3 } ] })";
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 4;
    return wadi_create_world_from_level_text(level.c_str(), nullptr, nullptr, nullptr, &options, &world);
}

/// A world that runs and is saved beside the host: its hash.
std::uint64_t session() {
    wadi_world_id world{};
    expect(make(200, world) == WADI_OK, "a world");
    expect(wadi_world_step(world, 6) == WADI_OK, "step");
    std::uint64_t ticket = 0;
    std::size_t bytes = 0;
    expect(wadi_world_begin_save(world, &ticket) == WADI_OK, "begin_save");
    expect(wadi_world_end_save(world, ticket, nullptr, &bytes) == WADI_OK, "end_save: size");
    std::vector<unsigned char> snapshot(bytes), at_once(bytes);
    const auto until = std::chrono::steady_clock::now() + 20s;
    for (auto result = WADI_NOT_READY; result != WADI_OK && std::chrono::steady_clock::now() < until;) {
        result = wadi_world_end_save(world, ticket, snapshot.data(), &bytes);
        if (result != WADI_OK) {
            expect(result == WADI_NOT_READY, "end_save");
            std::this_thread::sleep_for(100us);
        }
    }
    expect(wadi_world_save(world, at_once.data(), &bytes) == WADI_OK && snapshot == at_once, "the save is whole");
    std::uint64_t hash = 0;
    expect(wadi_world_get_hash(world, &hash) == WADI_OK, "hash");
    expect(wadi_destroy_world(world) == WADI_OK, "destroy");
    return hash;
}

/// Each thread is refused in turn, alone and with all later ones; refused the first and all others, all runs within the calls.
int threads() {
    const std::uint64_t expected = session();
    threads_asked = 0;
    expect(session() == expected, "a session without faults");
    const long needed = threads_asked;
    for (const bool on : {false, true}) {
        for (long n = 1; n <= needed && wrong < 10; ++n) {
            refuses_on = on;
            threads_asked = 0;
            refused_from = n;
            expect(session() == expected, "fewer threads give the same bits, " + std::to_string(n));
            expect(threads_asked >= n, "a thread that is refused was asked for, " + std::to_string(n));
            refused_from = 0;
        }
    }
    std::printf("%ld threads in a session, each refused twice\n", needed);
    expect(needed > 5, "sessions have threads");
    expect(session() == expected, "a session afterwards");
    return wrong;
}

// ---- exit ----

std::string self;

/// Runs `body` in a child; 0 where it left by exit(0) within `seconds`, else what happened.
std::string run_child(const std::function<void()>& body, int seconds) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        body();
        std::exit(wrong);
    }
    int status = 0;
    for (int n = 0; n < seconds * 100; ++n) {
        if (waitpid(child, &status, WNOHANG) == child) {
            if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status));
            return WEXITSTATUS(status) == 0 ? "" : "ended with " + std::to_string(WEXITSTATUS(status));
        }
        std::this_thread::sleep_for(10ms);
    }
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return "hangs";
}

/// A host that keeps its world in a static object, whose destructor runs after those of the thread's variables.
struct Game {
    wadi_world_id world{};
    ~Game() {
        if (world.index == 0) return;
        if (wadi_destroy_world(world) != WADI_OK) _exit(3);
        if (wadi_destroy_world(world) != WADI_ERROR_BAD_ARGUMENT) _exit(4); // with a text that nobody can keep
        wadi_get_last_error();
    }
} game;

/// The host leaves while its other threads are inside calls, or lets a static object clean up.
int ends(const std::string& how) {
    if (how == "static") {
        make(20, game.world);
        wadi_world_step({77, 77}, 1); // a text of some length stays behind
        return 0;
    }
    static std::atomic<int> calls{0};
    for (int n = 0; n < 3; ++n) {
        std::thread([] {
            for (wadi_world_id world{};;) {
                make(30, world);
                for (int k = 0; k < 20; ++k) {
                    wadi_world_step(world, 3);
                    auto stats = wadi_default_world_stats();
                    wadi_world_get_stats(world, &stats);
                    wadi_world_step({77, 77}, 1);
                    ++calls;
                }
                wadi_destroy_world(world);
            }
        }).detach();
    }
    while (calls < 10) std::this_thread::yield();
    std::exit(0);
}

int exits() {
    for (const std::string how : {"static", "threads"}) {
        const int rounds = how == "static" ? 3 : 40;
        for (int n = 0; n < rounds && wrong < 5; ++n) {
            const auto ended = run_child(
                [&] {
                    execl(self.c_str(), self.c_str(), "ends", how.c_str(), static_cast<char*>(nullptr));
                    _exit(127);
                },
                20);
            expect(ended.empty(), "exit, " + how + ", round " + std::to_string(n) + ": " + ended);
        }
    }
    return wrong;
}

// ---- fork ----

/// Worlds of the parent are refused in a child, new ones work, and both end.
int forks() {
    wadi_world_id world{};
    expect(make(200, world) == WADI_OK && wadi_world_step(world, 2) == WADI_OK, "a world of the parent");
    std::uint64_t hash = 0, later = 0;
    expect(wadi_world_get_hash(world, &hash) == WADI_OK, "hash");
    const auto refuses = [&] {
        auto frame = wadi_default_frame();
        std::uint64_t any = 0;
        expect(wadi_world_step(world, 1) == WADI_ERROR_BAD_ARGUMENT, "step of an inherited world");
        expect(wadi_world_update(world, 20'000'000, &frame) == WADI_ERROR_BAD_ARGUMENT, "update of an inherited world");
        expect(wadi_world_get_hash(world, &any) == WADI_ERROR_BAD_ARGUMENT, "hash of an inherited world");
        expect(wadi_destroy_world(world) == WADI_ERROR_BAD_ARGUMENT, "destroying an inherited world");
    };
    std::string ended = run_child([&] { refuses(); }, 20);
    expect(ended.empty(), "a child that calls on its parent's world " + ended);
    ended = run_child(
        [&] {
            wadi_world_id own{};
            std::uint64_t of_own = 0;
            expect(make(200, own) == WADI_OK && wadi_world_step(own, 2) == WADI_OK, "a world of the child");
            expect(wadi_world_get_hash(own, &of_own) == WADI_OK && of_own == hash, "its bits");
            refuses(); // also beside a world in the same place
            expect(run_child([&] { expect(wadi_world_step(own, 1) == WADI_ERROR_BAD_ARGUMENT, "grandchild"); }, 10).empty(),
                   "a child of the child");
            expect(wadi_destroy_world(own) == WADI_OK, "destroying it");
        },
        40);
    expect(ended.empty(), "a child with a world of its own " + ended);
    ended = run_child([] {}, 10);
    expect(ended.empty(), "a child that only leaves " + ended);
    // The first process of a pid namespace, and the first of another within: both have the number 1.
    ended = run_child(
        [&] {
            if (unshare(CLONE_NEWPID) != 0) return void(std::puts("pid namespaces: not for this user"));
            const std::string first = run_child(
                [&] {
                    wadi_world_id own{};
                    expect(getpid() == 1 && make(40, own) == WADI_OK, "a world of process 1");
                    expect(unshare(CLONE_NEWPID) == 0, "a namespace within");
                    const std::string second = run_child(
                        [&] {
                            expect(getpid() == 1, "process 1 again");
                            expect(wadi_world_step(own, 1) == WADI_ERROR_BAD_ARGUMENT,
                                   "step of a world inherited under the same number");
                        },
                        20);
                    expect(second.empty(), "its child of the same number " + second);
                },
                40);
            expect(first.empty(), "a child in a pid namespace " + first);
        },
        60);
    expect(ended.empty(), "children with equal numbers " + ended);
    expect(wadi_world_get_hash(world, &later) == WADI_OK && later == hash, "the parent's world is as it was");
    expect(wadi_world_step(world, 2) == WADI_OK && wadi_destroy_world(world) == WADI_OK, "and runs on");
    return wrong;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    self = argv[0];
    if (what == "ends" && argc > 2) return ends(argv[2]);
    if (what != "threads" && what != "exit" && what != "fork") {
        std::fprintf(stderr, "wadi-test-process threads | exit | fork\n");
        return 2;
    }
    const int failures = what == "threads" ? threads() : what == "exit" ? exits() : forks();
    std::puts(failures == 0 ? "passed" : "FAILED");
    return failures == 0 ? 0 : 1;
}
