// Reading a world's state between two steps on the host: fields, ledger, statistics, hash. Every call waits for the device.
#pragma once
#include "engine/reads/limits.hpp"
#include "engine/step/run/ledger.hpp"
#include "engine/step/run/region.hpp"
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"
#include <functional>
#include <span>

namespace wadi {

/// The state now; see wadi_world_stats in the plugin's header for meaning and units.
struct WorldStats {
    std::int64_t sand_quanta = 0, water_quanta = 0, sand_initial = 0, water_initial = 0;
    Ledger ledger;
    double quantum = 0;
    double largest_sand = 0, largest_water = 0, largest_water_speed = 0, largest_sand_speed = 0, smallest_height = 0;
    LimitCounts limits;
    std::uint64_t not_finite = 0, hash = 0;
    std::uint64_t tiles = 0, active_tiles = 0,
                  active_sand_tiles = 0; // of the newest step, in the longer of its lists and in the sand's; 0 without
};

class StateReader {
  public:
    StateReader(WorldState& state, Stepper& stepper, Limits& limits) : state_(state), stepper_(stepper), limits_(limits) {}

    /// The floats in a region of a field by its plan name ("water_height", ...), at cell centres for velocities, or of a
    /// published field ("water_depth", "free_surface", "surface_saturation", "limits"). A field the mask lacks is zero.
    /// Errors: bad_argument for any other name, and those of check_region(); device_lost.
    Status read(const std::string& name, const Region& region, std::span<float> values);
    /// All cells.
    Status read(const std::string& name, std::span<float> values);
    Result<WorldStats> stats();
    /// The hash of the statistics alone: fields are read, nothing is run.
    Result<std::uint64_t> hash();
    /// The raw field with ghosts at its current parity.
    Result<std::vector<float>> read_raw(const std::string& field);

  private:
    Status publish(const std::string& stage, const std::map<std::string, std::string>& fields,
                   const std::vector<const char*>& outputs);
    /// Reads numbers from element `first` on.
    using Rows = std::function<Status(std::size_t first, std::span<float> rows)>;
    Rows rows_of(compute::Buffer from);
    Rows rows_of(const std::string& field);
    Status read_cells(const Rows& rows_from, const Region& region, std::span<float> values);
    /// Figures of values, summed up in any order.
    struct Figures;
    /// Adds what look(j, row, figures) finds in the first `nx` values of the rows 0 ... ny - 1, on several threads.
    using Look = std::function<void(int j, std::span<const float> row, Figures& figures)>;
    Status look_at(const Rows& rows_from, int nx, int ny, const Look& look, Figures& figures);
    /// Reads every hashed field; returns the hash, and adds the other figures to `stats` if there is one.
    Result<std::uint64_t> hash_fields(WorldStats* stats);

    WorldState& state_;
    Stepper& stepper_;
    Limits& limits_;
    std::array<compute::Buffer, 2> output_{}; // of publish stages, made when first asked for
    std::map<std::string, std::unique_ptr<StateProgram>> programs_;
};

} // namespace wadi
