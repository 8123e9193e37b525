// One world is for one thread at a time: a second one is turned away unharmed. Different worlds are independent.
#include "tests/plugin/abi_worlds.hpp"
#include <atomic>
#include <chrono>
#include <doctest/doctest.h>
#include <thread>
#if defined(__linux__)
#include <filesystem>
#include <fstream>
#include <map>
#include <sys/resource.h>
#include <unistd.h>
#endif

using namespace wadi::test;

TEST_CASE("two threads on one world: each call works or says BUSY, and what was done is what was counted") {
    auto world = mixed_world("cpu", 24);
    std::atomic<unsigned> stepped{0}, busy{0}, wrong{0};
    std::atomic<int> begun{0};
    const auto hammer = [&] {
        ++begun;
        while (begun < 2) std::this_thread::yield(); // or one is through before the other begins
        for (int n = 0, done = 0; done < 60 && n < 1'000'000; ++n) {
            const auto result = wadi_world_step(world.id, 1);
            if (result == WADI_OK) ++stepped, ++done;
            if (result == WADI_ERROR_BUSY) ++busy;
            if (result == WADI_ERROR_BUSY && !error_mentions("wadi_world_step: another call is inside this world")) ++wrong;
            if (result != WADI_OK && result != WADI_ERROR_BUSY) ++wrong;
            uint64_t hash = 0;
            if (n % 20 == 0 && wadi_world_get_hash(world.id, &hash) == WADI_ERROR_BUSY) ++busy;
            if (n % 50 == 0 && wadi_world_get_warning(world.id, 1000) != nullptr) ++wrong;
        }
    };
    std::thread first(hammer), second(hammer);
    first.join();
    second.join();
    CHECK(wrong == 0);
    MESSAGE("stepped " << stepped.load() << ", busy " << busy.load());
    CHECK(stepped == 120);
    CHECK(steps_of(world) == stepped);
    auto alone = mixed_world("cpu", 24);
    step(alone, stepped);
    CHECK(hash_of(alone) == hash_of(world));
}

TEST_CASE("a world in use by another thread is not destroyed; once it is, the other thread is told") {
    unsigned busy = 0;
    for (int round = 0; round < 20; ++round) {
        auto world = mixed_world("cpu", 24);
        std::atomic<bool> inside{false};
        wadi_result last = WADI_OK;
        std::thread other([&] {
            uint64_t hash = 0;
            for (last = WADI_OK; last == WADI_OK || last == WADI_ERROR_BUSY;) {
                last = wadi_world_get_hash(world.id, &hash);
                inside = true;
            }
        });
        while (!inside) std::this_thread::yield();
        wadi_result destroyed = wadi_destroy_world(world.id);
        for (; destroyed == WADI_ERROR_BUSY; destroyed = wadi_destroy_world(world.id)) ++busy;
        other.join();
        CHECK(destroyed == WADI_OK);
        CHECK(last == WADI_ERROR_BAD_ARGUMENT);
    }
    CHECK(busy > 0);
}

TEST_CASE("four threads with a world each: the same bits as alone") {
    auto alone = mixed_world("cpu", 24);
    step(alone, 60);
    const auto expected = hash_of(alone);
    std::vector<std::thread> threads;
    std::atomic<unsigned> right{0};
    for (int n = 0; n < 4; ++n) {
        threads.emplace_back([&] {
            auto world = mixed_world("cpu", 24);
            step(world, 60);
            if (hash_of(world) == expected) ++right;
        });
    }
    for (auto& thread : threads) thread.join();
    CHECK(right == 4);
}

namespace {

// A host's job system: on one thread in turn, or on a thread for each part.
struct Jobs {
    bool threaded = false;
    std::atomic<unsigned> passes{0}, parts{0};
};

void run_jobs(void* user, uint32_t count, wadi_job job, void* data) {
    auto& jobs = *static_cast<Jobs*>(user);
    ++jobs.passes;
    jobs.parts += count;
    std::vector<std::thread> threads;
    for (uint32_t n = 0; n < count; ++n) {
        if (jobs.threaded)
            threads.emplace_back(job, data, n);
        else
            job(data, n);
    }
    for (auto& thread : threads) thread.join();
}

uint64_t hash_with(const wadi_device_options& options) {
    const char* settings = R"({ "format_version": 1, "name": "jobs", "grid": { "nx": 160, "ny": 120, "dx": 0.25 }, "dt": 0.01,
        "sand": [ { "shape": "cylinder", "center": [20, 15], "radius": 6, "height": 2 } ],
        "water": [ { "shape": "box", "from": [0, 0], "to": [10, 30], "height": 3 } ] })";
    wadi_world_id id{};
    REQUIRE_MESSAGE(wadi_create_world_from_level_text(settings, nullptr, nullptr, nullptr, &options, &id) == WADI_OK,
                    std::string(wadi_get_last_error()));
    const AbiWorld world(id);
    step(world, 20);
    return hash_of(world);
}

} // namespace

TEST_CASE("the CPU backend on a host's job system, one thread or several, gives the bits of its own threads") {
    auto options = cpu_device();
    options.threads = 2;
    const uint64_t expected = hash_with(options);
    for (const bool threaded : {false, true}) {
        for (const int parts : {1, 3}) {
            CAPTURE(threaded);
            CAPTURE(parts);
            Jobs jobs;
            jobs.threaded = threaded;
            options.threads = parts;
            options.run_jobs = run_jobs;
            options.jobs_user = &jobs;
            CHECK(hash_with(options) == expected);
            CHECK((jobs.passes > 0) == (parts > 1)); // a single part needs nobody else
            CHECK(jobs.parts == jobs.passes * static_cast<unsigned>(parts));
        }
    }
}

#if defined(__linux__)
namespace {

// Threads of this process by name, with their nice values.
std::multimap<std::string, int> named_threads() {
    std::multimap<std::string, int> found;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "comm");
        std::string name;
        std::getline(file, name);
        const auto id = static_cast<id_t>(std::stoul(task.path().filename().string()));
        if (name.starts_with("wadi ")) found.emplace(name, getpriority(PRIO_PROCESS, id));
    }
    return found;
}

// Threads begin and end some time beside the calls that make and join them.
std::multimap<std::string, int> named_threads_once_there_are(std::size_t count) {
    for (int n = 0; n < 10000 && named_threads().size() != count; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return named_threads();
}

} // namespace

TEST_CASE("the library's threads have names, and the priority of the thread that made the world") {
    REQUIRE(named_threads_once_there_are(0).empty()); // of earlier tests
    std::thread([] {
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())) + 1);
        const int nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
        auto options = cpu_device();
        options.threads = 3;
        wadi_world_id id{};
        REQUIRE(wadi_create_world_from_level_text(
                    R"({ "format_version": 1, "name": "threads", "grid": { "nx": 8, "ny": 8, "dx": 0.5 },
            "dt": 0.02, "water": [ { "shape": "plane", "height": 1 } ] })",
                    nullptr, nullptr, nullptr, &options, &id) == WADI_OK);
        const AbiWorld world(id);
        uint64_t ticket = 0;
        REQUIRE(wadi_world_begin_save(id, &ticket) == WADI_OK);
        std::vector<unsigned char> bytes(1 << 20);
        size_t size = bytes.size();
        while (wadi_world_end_save(id, ticket, bytes.data(), &size) == WADI_NOT_READY) size = bytes.size();
        const auto found = named_threads_once_there_are(4);
        const std::multimap<std::string, int> expected = {
            {"wadi cpu 2", nice}, {"wadi cpu 3", nice}, {"wadi device", nice}, {"wadi save", nice}};
        CHECK(found == expected);
    }).join();
    CHECK(named_threads_once_there_are(0).empty());
}

TEST_CASE("by default the CPU backend leaves one core to the host's frame") {
    REQUIRE(named_threads_once_there_are(0).empty());
    const auto wanted = std::max<std::size_t>(std::thread::hardware_concurrency(), 2) - 1;
    auto options = cpu_device();
    options.threads = 0;
    wadi_world_id id{};
    REQUIRE(
        wadi_create_world_from_level_text(R"({ "format_version": 1, "name": "threads", "grid": { "nx": 8, "ny": 8, "dx": 0.5 },
            "dt": 0.02, "water": [ { "shape": "plane", "height": 1 } ] })",
                                          nullptr, nullptr, nullptr, &options, &id) == WADI_OK);
    const AbiWorld world(id);
    REQUIRE(wadi_world_step(id, 1) == WADI_OK);
    std::this_thread::sleep_for(std::chrono::milliseconds(200)); // they take their names as they begin
    CHECK(named_threads().size() == wanted);                     // that which takes steps in order shares their work
}
#endif
