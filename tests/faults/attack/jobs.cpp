// Job systems that forget parts of a pass, run them twice, or begin them when the pass is over: the bits stay, and nobody waits
// for ever.
#include "tests/faults/attack/attack.hpp"
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

namespace attack {
namespace {

enum class Habit { honest, forgets_some, forgets_all, repeats, one_by_one_late, returns_early };
const char* const names[] = {"honest", "forgets some", "forgets all", "repeats", "begins each later", "returns early"};

/// Two threads that take jobs from a queue, as a host's do.
class Hosts {
  public:
    explicit Hosts(Habit habit) : habit_(habit) {
        for (auto& thread : threads_) thread = std::thread([this] { work(); });
    }
    ~Hosts() {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        changed_.notify_all();
        for (auto& thread : threads_) thread.join();
    }
    static void run(void* user, uint32_t count, wadi_job job, void* data) { static_cast<Hosts*>(user)->take(count, job, data); }
    /// None is queued or runs any more.
    void settle() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return queue_.empty() && running_ == 0; });
    }
    long done = 0, forgotten = 0;

  private:
    void take(uint32_t count, wadi_job job, void* data) {
        std::unique_lock lock(mutex_);
        for (uint32_t n = 0; n < count; ++n) {
            const bool forgets = habit_ == Habit::forgets_all || (habit_ == Habit::forgets_some && random_() % 2 == 0);
            forgotten += forgets ? 1 : 0;
            for (int times = forgets ? 0 : habit_ == Habit::repeats ? 3 : 1; times > 0; --times)
                queue_.push_back([job, data, n] { job(data, n); });
        }
        changed_.notify_all();
        if (habit_ != Habit::returns_early) changed_.wait(lock, [this] { return queue_.empty() && running_ == 0; });
    }
    void work() {
        std::unique_lock lock(mutex_);
        while (!ends_) {
            if (queue_.empty()) {
                changed_.wait(lock);
                continue;
            }
            const auto job = queue_.front();
            queue_.pop_front();
            ++running_;
            lock.unlock();
            if (habit_ == Habit::one_by_one_late || habit_ == Habit::returns_early)
                std::this_thread::sleep_for(std::chrono::microseconds(50));
            job();
            lock.lock();
            --running_;
            ++done;
            changed_.notify_all();
        }
    }

    Habit habit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> queue_;
    int running_ = 0;
    bool ends_ = false;
    std::mt19937 random_{7};
    std::thread threads_[2];
};

/// Of a world whose passes are large enough to be shared out; 0 where a call fails.
std::uint64_t hash_by(Hosts* hosts) {
    auto options = wadi_default_device_options();
    options.backend = "cpu";
    options.threads = 3;
    if (hosts != nullptr) {
        options.run_jobs = Hosts::run;
        options.jobs_user = hosts;
    }
    const char* text = R"({ "format_version": 1, "name": "jobs", "grid": { "nx": 160, "ny": 120, "dx": 0.25 }, "dt": 0.01,
        "sand": [ { "shape": "cylinder", "center": [20, 15], "radius": 6, "height": 2 } ],
        "water": [ { "shape": "box", "from": [0, 0], "to": [10, 30], "height": 3 } ] })";
    wadi_world_id world{};
    std::uint64_t hash = 0;
    if (wadi_create_world_from_level_text(text, nullptr, nullptr, nullptr, &options, &world) != WADI_OK) return 0;
    const bool good =
        wadi_world_step(world, 10) == WADI_OK && wadi_world_get_hash(world, &hash) == WADI_OK && ledger_holds(world);
    if (hosts != nullptr) hosts->settle(); // none may begin after the end
    return wadi_destroy_world(world) == WADI_OK && good ? hash : 0;
}

} // namespace

int jobs() {
    const std::uint64_t expected = hash_by(nullptr);
    expect(expected != 0, "a world on the library's own threads");
    for (std::size_t n = 0; n < std::size(names); ++n) {
        // A child that waits for ever is ended by its alarm.
        const auto ran = run_child([&] {
            Hosts hosts(static_cast<Habit>(n));
            const std::uint64_t hash = hash_by(&hosts);
            std::printf("a job system that is or does this: %s; %ld parts run, %ld forgotten\n", names[n], hosts.done,
                        hosts.forgotten);
            expect(hash == expected, "the bits of the library's own threads");
            const bool forgets = static_cast<Habit>(n) == Habit::forgets_some || static_cast<Habit>(n) == Habit::forgets_all;
            expect((hosts.forgotten > 0) == forgets && (hosts.done > 0) == (static_cast<Habit>(n) != Habit::forgets_all),
                   "as it is called");
            return wrong == 0 ? 0 : 1;
        });
        expect(ran.code == 0, std::string("a job system that ") + names[n] + ": ended with " + std::to_string(ran.code));
    }
    return wrong;
}

} // namespace attack
