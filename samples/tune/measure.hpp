// Runs of a level: the time that they take and the surfaces that they come to.
#pragma once
#include "level.hpp"
#include <functional>
#include <vector>

namespace tune {

struct Device {
    std::string backend = "auto";
    int device = -1;
    int threads = 0;             // of the CPU backend; 0 = all cores but one
    bool processor_time = false; // what all threads worked, and not what a clock on the wall shows
};

/// Row-major, row 0 in the south.
struct Surfaces {
    int nx = 0, ny = 0;
    std::vector<float> sand;    // depth hs [m]
    std::vector<float> surface; // elevation of what a viewer sees, H + max(W, hs) [m]
};

constexpr int PARTS = 16;      // a run's time is taken in so many parts of equal simulated time
constexpr int CHECKPOINTS = 4; // and its surfaces at the ends of so many

struct Run {
    Settings settings;
    double dt = 0;        // [s]
    double simulated = 0; // [s]
    std::uint64_t steps = 0;
    double stepping = 0;                      // time of all of them [s]
    std::vector<double> parts;                // time of each part [s]; fewer than PARTS where the limit ended the run
    std::vector<double> part_ends;            // simulated [s]
    std::vector<Surfaces> at;                 // the start, then each checkpoint; empty where not asked for
    bool has_sand = false, has_water = false; // at the end
    std::string device_name, backend;
    std::vector<std::string> warnings; // of the level with these settings
    double seconds() const;            // of all parts
    double step_seconds() const;       // mean
    /// Of the time of all parts that of the first `count`.
    double share(std::size_t count) const;
    /// For each part the quicker of this run and another one of the same settings: what else the machine did counts less.
    void keep_quicker(const Run& other);
};

struct RunRequest {
    double seconds = 0; // simulated
    bool keep_surfaces = true;
    double limit = 1e9; // [s] of time, after which it ends with a whole part
    int parts = PARTS;  // as many of them as are run
};

/// Thrown where `stop` of a runner says so.
struct Stopped : std::runtime_error {
    Stopped() : std::runtime_error("stopped") {}
};

/// [s] from some moment on: processor time where the device counts that.
double now(const Device& device);

class Runner {
  public:
    Runner(const Level& level, const Device& device, std::function<bool()> stop)
        : level_(level), device_(device), stop_(std::move(stop)) {}
    /// Throws BadInput where no world can be made or it fails.
    Run run(const Settings& settings, const RunRequest& request) const;
    const Level& level() const { return level_; }
    const Device& device() const { return device_; }

  private:
    const Level& level_;
    Device device_;
    std::function<bool()> stop_;
};

} // namespace tune
