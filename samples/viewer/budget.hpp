// The tuner beside the window: settings of a level for a budget of milliseconds per frame.
#pragma once
#include "simulation.hpp"
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

namespace viewer {

class Budget {
  public:
    Budget() = default;
    ~Budget() { stop(); }
    Budget(const Budget&) = delete;
    Budget& operator=(const Budget&) = delete;

    /// Measures the level of `choice.text` on what `choice` runs on, for about so many minutes, in a thread of its own. Throws
    /// std::runtime_error where the level is no JSON.
    void start(const std::string& level_name, const SimulationChoice& choice, double milliseconds, double minutes);
    /// Ends it without a result; waits for the piece of a run that is under way.
    void stop();
    bool running() const { return running_; }
    /// What is being measured.
    std::string progress() const;
    void wait();

    struct Found {
        std::string patch;      // of a variant, as JSON
        std::string conclusion; // a sentence; without a patch, why there is none
    };
    /// The result of what was started, once.
    std::optional<Found> take();

  private:
    std::thread thread_;
    std::atomic<bool> running_ = false, stop_ = false;
    mutable std::mutex mutex_; // of the two below
    std::string progress_;
    std::optional<Found> found_;
};

} // namespace viewer
