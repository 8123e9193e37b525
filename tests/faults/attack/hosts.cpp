// Many hosts in one process.
#include "tests/faults/attack/attack.hpp"
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

namespace attack {

namespace {

/// Four threads take turns at one world until they have met: what was done is what was counted.
void one_world() {
    constexpr int each = 25, met = 10;
    wadi_world_id world{}, alone{};
    if (!expect(make(32, world) == WADI_OK && make(32, alone) == WADI_OK, "create")) return;
    std::atomic<unsigned> busy{0}, steps{0};
    std::vector<std::thread> threads;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (int n = 0; n < 4; ++n) {
        threads.emplace_back([&] {
            int done = 0;
            while (wrong == 0 && (done < each || (busy < met && std::chrono::steady_clock::now() < end))) {
                const auto answer = wadi_world_step(world, 1);
                expect(answer == WADI_OK || answer == WADI_ERROR_BUSY, "a step, or busy");
                if (answer == WADI_OK) ++done, ++steps;
                if (answer == WADI_ERROR_BUSY) ++busy;
            }
        });
    }
    for (auto& thread : threads) thread.join();
    std::uint64_t together = 0, expected = 0;
    expect(wadi_world_step(alone, steps) == WADI_OK && wadi_world_get_hash(alone, &expected) == WADI_OK &&
               wadi_world_get_hash(world, &together) == WADI_OK && together == expected,
           "other bits than of one thread");
    expect(busy >= met, "threads met"); // control: they were inside at once
    std::printf("four threads on one world: %u steps, %u times busy\n", steps.load(), busy.load());
    wadi_destroy_world(world);
    wadi_destroy_world(alone);
}

} // namespace

int hosts(double seconds) {
    one_world();
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

} // namespace attack
