#include "engine/saves/worker.hpp"
#include "engine/compute/float_environment.hpp"
#include "engine/compute/thread_name.hpp"
#include <exception>

namespace wadi {

Worker::~Worker() {
    if (!thread_.joinable()) return;
    changed_.wait([this] { return !busy(); });
    stop_ = true;
    jobs_.fetch_add(1, std::memory_order_release);
    changed_.wake();
    thread_.join();
}

void Worker::start(std::function<void()> job) {
    try {
        if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    } catch (const std::exception&) { // no more threads, or no memory for one
        return job();
    }
    job_ = std::move(job);
    busy_.store(true, std::memory_order_relaxed);
    jobs_.fetch_add(1, std::memory_order_release);
    changed_.wake();
}

void Worker::run() {
    compute::name_this_thread("wadi save");
    const compute::DefaultFloats floats;
    for (unsigned done = 0;; ++done) {
        changed_.wait([&] { return jobs_.load(std::memory_order_acquire) != done; });
        if (stop_) return;
        job_();
        busy_.store(false, std::memory_order_release);
        changed_.wake();
    }
}

} // namespace wadi
