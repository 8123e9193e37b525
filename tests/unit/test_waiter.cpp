// Waits of the pool and of the worker: no wake-up is lost.
#include "engine/compute/waiter.hpp"
#include <chrono>
#include <doctest/doctest.h>
#include <thread>

using wadi::compute::Waiter;

TEST_CASE("waiter: two threads that wake each other in turn never sleep through a turn") {
    Waiter changed;
    std::atomic<int> turn{0};
    constexpr int turns = 20000;
    const auto play = [&](int side) {
        for (int n = side; n < turns; n += 2) {
            changed.wait([&] { return turn.load(std::memory_order_acquire) == n; });
            turn.store(n + 1, std::memory_order_release);
            changed.wake();
        }
    };
    std::thread other([&] { play(1); });
    play(0);
    other.join();
    CHECK(turn == turns);
}

TEST_CASE("waiter: who waits sleeps until what it waits for holds, however often it is woken") {
    Waiter changed;
    std::atomic<bool> holds{false}, through{false};
    std::thread other([&] {
        changed.wait([&] { return holds.load(); });
        through = true;
    });
    for (int n = 0; n < 20; ++n) {
        changed.wake();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        CHECK_FALSE(through);
    }
    holds = true;
    changed.wake();
    other.join();
    CHECK(through);
}
