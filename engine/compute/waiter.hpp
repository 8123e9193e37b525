// Sleeping until something holds, and being woken: what a pool and a worker wait on.
#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>

namespace wadi::compute {

/// Waits that lose no wake-up on any system: std::atomic::wait of libstdc++ loses some where there are no futexes (Windows). What
/// is waited for is kept in atomics beside it and changed before wake(), which costs one instruction while nobody sleeps.
class Waiter {
  public:
    /// Sleeps until holds(). Only what happened before a wake() is sure to be seen.
    template <class Holds> void wait(Holds holds) {
        if (holds()) return;
        std::unique_lock lock(mutex_);
        // Either this comes ahead of the look of a wake(), which then takes the lock, or behind it, and holds() sees what it was
        // about.
        sleepers_.fetch_add(1, std::memory_order_acq_rel);
        changed_.wait(lock, holds);
        sleepers_.fetch_sub(1, std::memory_order_relaxed);
    }
    void wake() {
        if (sleepers_.fetch_add(0, std::memory_order_acq_rel) == 0) return;
        { const std::lock_guard lock(mutex_); } // nobody is between its look and its sleep
        changed_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::atomic<int> sleepers_{0};
};

} // namespace wadi::compute
