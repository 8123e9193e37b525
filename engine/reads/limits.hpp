// Limits at work: where guards hold a flow back, counted on the device. Statistics ask for it; a world with a log looks now and
// then by itself, never waiting for the device, and tells once of each limit that changes what the world does.
#pragma once
#include "engine/step/run/region.hpp"
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"
#include <array>
#include <optional>
#include <span>

namespace wadi {

/// Of one layer. Faces beside cells deeper than method.dry_threshold; faces at the velocity clamp (water: of both its layers);
/// faces whose gravity the next step caps; cells whose outflow the next step limits.
struct LayerLimits {
    std::uint64_t wet_faces = 0, clamped_faces = 0, capped_faces = 0, limited_cells = 0;
};

struct LimitCounts {
    std::uint64_t step = 0; // that they are of
    LayerLimits water, sand;
    std::uint64_t high_columns = 0; // above method.largest_height
    double clamped_speed = 0;       // to which clamped water would be driven, 0 without any [m/s]
    double wave_speed = 0;          // speed and celerity where the gravity of water is capped [m/s]
    double capped_sand = 0;         // deepest sand where its gravity is capped [m]
    double highest_column = 0;      // [m]
    /// The middle of the tile with most of it, from the grid's south-west corner [m].
    struct Place {
        std::uint64_t most = 0;
        double x = 0, y = 0;
    };
    Place water_clamped_at, water_capped_at, water_limited_at, sand_clamped_at, sand_capped_at, sand_limited_at, high_at;
};

/// The largest time step with which neither the clamp nor the cap would hold water, as far as these counts tell; the world's own
/// where none does [s].
double unlimited_dt(const Settings& settings, const LimitCounts& counts);

/// What holds a cell, of water; of sand the same three bits higher; of its whole column.
inline constexpr std::uint32_t HELD_SPEED = 1, HELD_GRAVITY = 2, HELD_OUTFLOW = 4, HELD_HIGH = 64;
inline constexpr int HELD_SAND = 3;

class Limits {
  public:
    static constexpr std::uint64_t interval = 64; // steps between two looks

    explicit Limits(WorldState& state) : state_(state) {}

    /// Now; waits for the device. Between two steps only.
    Result<LimitCounts> count();

    /// Which of the guards hold the cells of a region in the next step, or its faces: for each a sum of HELD_... by rows.
    /// Waits for the device. Between two steps only. Errors: as count().
    Status read(const Region& region, std::span<float> values);

    /// From now on the world looks by itself. Allocates and records. Errors: out_of_memory; it does not look then.
    Status watch();
    /// The newest look that has arrived; none where the world does not look, or has not yet.
    const std::optional<LimitCounts>& newest() const { return newest_; }

    /// Stepper::Hooks.
    void after_step();
    std::uint64_t undisturbed(std::uint64_t most) const;
    /// The world went to another step: a look under way is of another past.
    void jumped() { pending_ = {}; }

  private:
    enum Told { water_clamp, water_gravity, water_outflow, sand_clamp, sand_gravity, sand_outflow, high_columns, kinds };

    Status prepare();
    Status run();
    LimitCounts counts(std::uint64_t step) const;
    void look();
    void collect();
    void stop(const Status& why);
    void tell(const LimitCounts& counts);
    void tell_once(Told kind, bool due, const LimitCounts& counts, const std::function<std::string()>& text);

    WorldState& state_;
    std::array<compute::Buffer, 4> buffers_{}; // marks, counts of columns and of tiles, their readback
    std::unique_ptr<StateProgram> program_;
    bool watching_ = false;
    compute::Ticket pending_;                   // a look that has not been collected; 0 = none
    std::uint64_t pending_step_ = 0, seen_ = 0; // its step; submissions so far, this one included
    Material material_;                         // of the program: what the bed holds depends on it
    std::optional<LimitCounts> newest_;
    std::array<bool, kinds> told_{};
};

} // namespace wadi
