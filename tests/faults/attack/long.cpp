// Worlds that run for long, and many one after the other: nothing is left behind.
#include "tests/faults/attack/attack.hpp"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <malloc.h>
#include <memory>
#include <unistd.h>
#include <vector>

namespace attack {
namespace {

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
    malloc_trim(0); // what was given back and not passed on comes and goes by 8 MiB as Mesa compiles
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

} // namespace

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
    // Threads of new worlds each touch another of malloc's arenas: 3 to 6 MiB for Mesa's within the first dozens of worlds.
    mallopt(M_ARENA_MAX, 1);
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

} // namespace attack
