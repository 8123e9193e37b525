// Many hosts in one process.
#include "tests/faults/attack/attack.hpp"
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

namespace attack {

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

} // namespace attack
