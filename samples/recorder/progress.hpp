// One progress line on standard error: redrawn on a terminal, a plain line every 10 % elsewhere.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace recorder {

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
