// How far a level is drawn, told to its host, which may end it.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace wadi {

/// Thrown where the host has ended the work.
struct Cancelled {};

class Progress {
  public:
    /// tell(share of the work that is done, 0 ... 1): whether to go on. Called on the thread that made this alone.
    using Tell = std::function<bool(double share)>;
    explicit Progress(Tell tell) : tell_(std::move(tell)) {}

    /// Work that is known now, as LevelFiles::take_work() counts.
    void expect(std::int64_t work) { all_ += work; }
    /// So much more is done; from any thread. Throws Cancelled.
    void add(std::int64_t work) {
        done_ += work;
        if (std::this_thread::get_id() == host_ && !tell_(share())) cancelled_ = true;
        if (cancelled_) throw Cancelled{};
    }

  private:
    double share() const {
        const auto all = static_cast<double>(all_), done = static_cast<double>(done_);
        return all > 0 && done < all ? done / all : 1;
    }

    const Tell tell_;
    const std::thread::id host_ = std::this_thread::get_id();
    std::int64_t all_ = 0;
    std::atomic<std::int64_t> done_{0};
    std::atomic<bool> cancelled_{false};
};

} // namespace wadi
