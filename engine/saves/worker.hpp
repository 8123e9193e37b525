// A thread that does one job at a time beside the caller's.
#pragma once
#include "engine/compute/waiter.hpp"
#include <atomic>
#include <functional>
#include <thread>

namespace wadi {

/// The thread is made for the first job and sleeps in between. One caller.
class Worker {
  public:
    Worker() = default;
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Only while not busy. The job must not throw. It is done within the call where the system refuses the thread.
    void start(std::function<void()> job);
    /// False once the job is done; its results may then be read.
    bool busy() const { return busy_.load(std::memory_order_acquire); }

  private:
    void run();

    std::function<void()> job_;
    std::atomic<bool> busy_{false};
    std::atomic<unsigned> jobs_{0}; // handed over so far, the order to stop among them
    bool stop_ = false;             // written before jobs_ counts up
    compute::Waiter changed_;       // busy_ or jobs_
    std::thread thread_;
};

} // namespace wadi
