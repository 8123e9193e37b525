#include "progress.hpp"
#include "../common/platform.hpp"
#include <cstdio>
#include <system_error>

namespace recorder {

LoadingNote::LoadingNote(const std::string& level) {
    const auto wait = [this, level] {
        std::unique_lock lock(mutex_);
        if (!ended_.wait_for(lock, std::chrono::seconds(1), [this] { return over_; }))
            std::fprintf(stderr, "note: %s: loading the level and making its world ...\n", level.c_str());
    };
    try {
        waiting_ = std::thread(wait);
    } catch (const std::system_error&) {
    }
}

LoadingNote::~LoadingNote() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    ended_.notify_all();
    if (waiting_.joinable()) waiting_.join();
}

Progress::Progress(double seconds, std::uint64_t steps)
    : seconds_(seconds), steps_(steps), terminal_(common::error_stream_is_terminal()) {}

void Progress::show(std::uint64_t step, double time, double stepping_seconds) {
    if (steps_ == 0) return;
    const double rate = stepping_seconds > 0 ? static_cast<double>(step) / stepping_seconds : 0;
    const double real_time = stepping_seconds > 0 ? time / stepping_seconds : 0;
    const double percent = 100.0 * static_cast<double>(step) / static_cast<double>(steps_);
    if (!terminal_) {
        if (step * 10 < next_tenth_ * steps_) return;
        next_tenth_ = step * 10 / steps_ + 1;
        std::fprintf(stderr, "%3.0f %%  t = %.3f of %.3f s, %.0f steps/s, %.3g x real time\n", percent, time, seconds_, rate,
                     real_time);
        return;
    }
    const Clock::time_point now = Clock::now();
    if (drawn_ && step < steps_ && now - last_drawn_ < std::chrono::milliseconds(100)) return;
    constexpr int cells = 24;
    std::string bar(cells, '.');
    const auto full = static_cast<std::size_t>(percent / 100.0 * cells);
    bar.replace(0, full, full, '#');
    std::fprintf(stderr, "\r[%s] %3.0f %%  t = %.2f of %.2f s, %.0f steps/s, %.3g x real time\x1b[K", bar.c_str(), percent, time,
                 seconds_, rate, real_time);
    std::fflush(stderr);
    drawn_ = true;
    last_drawn_ = now;
}

void Progress::note(const std::string& text) {
    if (drawn_) std::fprintf(stderr, "\r\x1b[K");
    drawn_ = false;
    std::fflush(stderr);
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
}

void Progress::finish() {
    if (drawn_) std::fprintf(stderr, "\n");
    drawn_ = false;
}

} // namespace recorder
