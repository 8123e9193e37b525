#include "engine/saves/worker.hpp"

namespace wadi {

Worker::~Worker() {
    if (!thread_.joinable()) return;
    while (busy()) busy_.wait(true);
    stop_ = true;
    jobs_.fetch_add(1, std::memory_order_release);
    jobs_.notify_one();
    thread_.join();
}

void Worker::start(std::function<void()> job) {
    job_ = std::move(job);
    busy_.store(true, std::memory_order_relaxed);
    jobs_.fetch_add(1, std::memory_order_release);
    jobs_.notify_one();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void Worker::run() {
    for (unsigned done = 0;; ++done) {
        jobs_.wait(done, std::memory_order_acquire);
        if (stop_) return;
        job_();
        busy_.store(false, std::memory_order_release);
        busy_.notify_one();
    }
}

} // namespace wadi
