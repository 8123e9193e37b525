// One progress line on standard error: redrawn on a terminal, a plain line every 10 % elsewhere.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace recorder {

/// Says on standard error that a level is still being loaded, if it lives for more than a second.
class LoadingNote {
  public:
    explicit LoadingNote(const std::string& level);
    ~LoadingNote();
    LoadingNote(const LoadingNote&) = delete;
    LoadingNote& operator=(const LoadingNote&) = delete;

  private:
    std::mutex mutex_;
    std::condition_variable ended_;
    bool over_ = false;
    std::thread waiting_; // none where the system refuses it
};

class Progress {
  public:
    Progress(double seconds, std::uint64_t steps);
    /// `stepping_seconds`: wall time that the steps took so far.
    void show(std::uint64_t step, double time, double stepping_seconds);
    /// Prints a line of its own without disturbing the progress line.
    void note(const std::string& text);
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    double seconds_;
    std::uint64_t steps_;
    bool terminal_;
    bool drawn_ = false;
    std::uint64_t next_tenth_ = 1;
    Clock::time_point last_drawn_;
};

} // namespace recorder
