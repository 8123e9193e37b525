// Threads that run one function together and sleep in between. Nothing ever waits for a thread that has not begun: on busy cores
// the others do its share.
#pragma once
#include "engine/compute/device.hpp"
#include "engine/compute/waiter.hpp"
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace wadi::cpu {

/// Work still to be done by somebody. Waiting spins only briefly, so that another process on the same cores costs little.
class Remaining {
  public:
    void set(int count) { count_.store(count, std::memory_order_relaxed); }
    void finish(int count) {
        if (count_.fetch_sub(count, std::memory_order_acq_rel) == count) done_.wake();
    }
    void wait();

  private:
    std::atomic<int> count_{0};
    compute::Waiter done_;
};

class ThreadPool {
  public:
    /// `threads` in all, the caller of run() being one of them; fewer where the system refuses some. With `jobs` none is made:
    /// that calls the work so many times.
    explicit ThreadPool(int threads, compute::RunJobs jobs = {});
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int size() const { return jobs_ ? most_jobs_ : static_cast<int>(workers_.size()) + 1; }
    /// Calls work() on the caller and on every other thread that wakes before the caller's own call has returned; returns when
    /// all of these calls have.
    void run(const std::function<void()>& work);

  private:
    // The job as one number, so that entering and closing exclude each other: generation, open, threads inside.
    static constexpr std::uint64_t open_bit = std::uint64_t{1} << 32;
    static constexpr std::uint64_t one_generation = std::uint64_t{1} << 33;
    static constexpr std::uint64_t inside = open_bit - 1;

    /// The caller of run() is number 1.
    void worker(int number);
    bool enter(std::uint64_t& seen);

    const compute::RunJobs jobs_;
    const int most_jobs_;
    const std::function<void()>* work_ = nullptr;
    std::atomic<std::uint64_t> job_{0};
    compute::Waiter changed_; // job_
    std::atomic<bool> stop_{false};
    std::vector<std::thread> workers_;
};

} // namespace wadi::cpu
