// Threads that run one function together and sleep in between. They spin only briefly at a barrier, so that another process
// on the same cores costs little.
#pragma once
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace wadi::cpu {

/// A barrier for a fixed number of threads; reusable.
class Barrier {
  public:
    explicit Barrier(int threads) : threads_(threads) {}
    /// The last thread to arrive calls `before_release`, if there is one, while the others still wait.
    void wait(const std::function<void()>& before_release);

  private:
    const int threads_;
    std::atomic<int> arrived_{0};
    std::atomic<int> generation_{0};
};

class ThreadPool {
  public:
    /// `threads` in all, the caller of run() being one of them.
    explicit ThreadPool(int threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int size() const { return static_cast<int>(workers_.size()) + 1; }
    /// Calls work(thread) on every thread, 0 being the caller; returns when all have finished.
    void run(const std::function<void(int thread)>& work);
    /// Inside work only: waits until all threads of the pool are here.
    void barrier(const std::function<void()>& before_release = {}) { barrier_.wait(before_release); }

  private:
    void worker(int thread);

    Barrier barrier_;
    const std::function<void(int)>* work_ = nullptr;
    std::atomic<int> generation_{0};
    std::atomic<int> running_{0};
    std::atomic<bool> stop_{false};
    std::vector<std::thread> workers_;
};

} // namespace wadi::cpu
