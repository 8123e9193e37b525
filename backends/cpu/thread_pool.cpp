#include "backends/cpu/thread_pool.hpp"
#include "backends/cpu/processor.hpp"
#include "engine/compute/float_environment.hpp"
#include "engine/compute/thread_name.hpp"
#include <cstdio>
#include <exception>

namespace wadi::cpu {

namespace {

// About 20 us: longer than two threads drift apart within a pass, far shorter than a time slice.
constexpr int spins = 2000;

// Waits until done(value) and returns the value. Whoever changes the value wakes.
template <class Number, class Done> Number wait_until(const std::atomic<Number>& value, compute::Waiter& changed, Done done) {
    Number now = 0;
    const auto look = [&] { return done(now = value.load(std::memory_order_acquire)); };
    for (int n = 0; n < spins; ++n) {
        if (look()) return now;
        pause();
    }
    changed.wait(look);
    return now;
}

} // namespace

void Remaining::wait() {
    wait_until(count_, done_, [](int left) { return left == 0; });
}

ThreadPool::ThreadPool(int threads, compute::RunJobs jobs) : jobs_(std::move(jobs)), most_jobs_(threads) {
    if (jobs_) return;
    try {
        while (size() < threads) workers_.emplace_back([this, number = size() + 1] { worker(number); });
    } catch (const std::exception&) { // no more threads, or no memory for them: those that there are do the work
    }
}

ThreadPool::~ThreadPool() {
    stop_.store(true);
    job_.fetch_add(one_generation);
    changed_.wake();
    for (auto& thread : workers_) thread.join();
}

void ThreadPool::run(const std::function<void()>& work) {
    if (jobs_) return jobs_(most_jobs_, work);
    work_ = &work;
    job_.fetch_add(one_generation + open_bit, std::memory_order_acq_rel);
    changed_.wake();
    work();
    job_.fetch_sub(open_bit, std::memory_order_acq_rel);
    wait_until(job_, changed_, [](std::uint64_t job) { return (job & inside) == 0; });
}

// False: the job that was seen is closed already, or the pool stops.
bool ThreadPool::enter(std::uint64_t& seen) {
    std::uint64_t job = wait_until(job_, changed_, [&](std::uint64_t now) { return now / one_generation != seen; });
    seen = job / one_generation;
    while ((job & open_bit) != 0 && job / one_generation == seen) {
        if (job_.compare_exchange_weak(job, job + 1, std::memory_order_acq_rel)) return true;
    }
    return false;
}

void ThreadPool::worker(int number) {
    char name[32];
    std::snprintf(name, sizeof name, "wadi cpu %d", number);
    compute::name_this_thread(name);
    const compute::DefaultFloats floats;
    std::uint64_t seen = 0;
    while (!stop_.load()) {
        if (!enter(seen)) continue;
        (*work_)();
        if (((job_.fetch_sub(1, std::memory_order_acq_rel) - 1) & (inside | open_bit)) == 0) changed_.wake();
    }
}

} // namespace wadi::cpu
