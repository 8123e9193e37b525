#include "backends/cpu/thread_pool.hpp"

namespace wadi::cpu {

namespace {

// About 20 us: longer than two threads drift apart within a pass, far shorter than a time slice.
constexpr int spins = 2000;

void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

void wait_while(std::atomic<int>& value, int old) {
    for (int n = 0; n < spins; ++n) {
        if (value.load(std::memory_order_acquire) != old) return;
        pause();
    }
    while (value.load(std::memory_order_acquire) == old) value.wait(old, std::memory_order_acquire);
}

} // namespace

void Barrier::wait(const std::function<void()>& before_release) {
    const int generation = generation_.load(std::memory_order_acquire);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
        if (before_release) before_release();
        arrived_.store(0, std::memory_order_relaxed);
        generation_.fetch_add(1, std::memory_order_acq_rel);
        generation_.notify_all();
    } else {
        wait_while(generation_, generation);
    }
}

ThreadPool::ThreadPool(int threads) : barrier_(threads) {
    for (int t = 1; t < threads; ++t) workers_.emplace_back([this, t] { worker(t); });
}

ThreadPool::~ThreadPool() {
    stop_.store(true);
    generation_.fetch_add(1);
    generation_.notify_all();
    for (auto& thread : workers_) thread.join();
}

void ThreadPool::run(const std::function<void(int)>& work) {
    work_ = &work;
    running_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
    generation_.fetch_add(1, std::memory_order_acq_rel);
    generation_.notify_all();
    work(0);
    for (int left = running_.load(std::memory_order_acquire); left != 0; left = running_.load(std::memory_order_acquire)) {
        wait_while(running_, left);
    }
}

void ThreadPool::worker(int thread) {
    int seen = 0;
    for (;;) {
        wait_while(generation_, seen);
        ++seen;
        if (stop_.load()) return;
        (*work_)(thread);
        if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) running_.notify_all();
    }
}

} // namespace wadi::cpu
