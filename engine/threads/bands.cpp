#include "engine/threads/bands.hpp"
#include "engine/compute/float_environment.hpp"
#include "engine/compute/thread_name.hpp"
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace wadi {
namespace {

thread_local int limit = 0; // 0: one for each core

std::size_t allowed_threads() {
    constexpr std::size_t most = 64; // more wait for memory
    return limit > 0 ? static_cast<std::size_t>(limit) : std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most);
}

} // namespace

ThreadLimit::ThreadLimit(int most) : before_(limit) { limit = most; }
ThreadLimit::~ThreadLimit() { limit = before_; }

void in_bands(std::size_t count, std::size_t band,
              const std::function<void(std::size_t n, std::size_t begin, std::size_t end)>& work) {
    const std::size_t bands = bands_of(count, band);
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failing;
    const auto share = [&] {
        try {
            for (std::size_t n = next++; n < bands; n = next++) work(n, n * band, std::min(count, (n + 1) * band));
        } catch (...) {
            const std::lock_guard lock(failing);
            failure = std::current_exception();
            next = bands;
        }
    };
    std::vector<std::thread> others;
    try {
        const std::size_t threads = std::min(allowed_threads(), bands);
        while (others.size() + 1 < threads)
            others.emplace_back([&] {
                compute::name_this_thread("wadi helper");
                const compute::DefaultFloats floats;
                const ThreadLimit alone(1); // bands within a band are its own
                share();
            });
    } catch (const std::system_error&) { // no more threads, or no memory for them: those that there are do the work
    } catch (const std::bad_alloc&) {
    }
    share();
    for (auto& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace wadi
