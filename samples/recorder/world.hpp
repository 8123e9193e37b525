// The plugin's world, destroyed with its owner; errors as Failure.
#pragma once
#include "options.hpp"
#include "render.hpp"
#include <wadi/wadi.h>

namespace recorder {

class World {
  public:
    World() = default;
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    /// Messages of the library's log (validation layers included) go to standard error.
    Failure create(const Options& options);

    wadi_world_id id() const { return id_; }
    const wadi_world_info& info() const { return info_; }
    const std::vector<std::string>& warnings() const { return warnings_; }

    Failure step(std::uint32_t steps);
    /// Waits for the steps asked for; the simulated time [s].
    Failure wait(double& time);
    Failure read_stats(wadi_world_stats& stats);
    Failure read_field(wadi_field field, std::vector<float>& values);
    /// The four fields of a picture, reduced by `factor`.
    Failure read_map(int factor, MapFields& fields);
    /// The state at points, x and y of each [m], after the steps so far.
    Failure read_points(const std::vector<float>& xy, std::vector<wadi_query_result>& results);
    Failure read_timings(std::vector<wadi_stage_timing>& timings);
    std::string describe_plan() const;

  private:
    Failure fault(const char* action) const;
    wadi_world_id id_ = {0, 0};
    wadi_world_info info_ = {};
    std::vector<std::string> warnings_;
};

} // namespace recorder
