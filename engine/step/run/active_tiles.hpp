// Active tiles: which of them the next step must run over because something from outside may have changed them. What changed by
// itself the device finds (mark_active_tiles).
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/params.hpp"
#include <array>
#include <optional>
#include <vector>

namespace wadi {

/// Without active tiles in the settings every wake is ignored.
class ActiveTiles {
  public:
    /// `settings` must stay.
    explicit ActiveTiles(const Settings& settings);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    std::uint64_t count() const { return static_cast<std::uint64_t>(columns_) * static_cast<std::uint64_t>(rows_); }

    /// Cells [i0, i1) x [j0, j1) may be another than the last steps left them.
    void wake(int i0, int j0, int i1, int j1);
    void wake_all();
    /// What the edits of a submission of apply_edits reach.
    void wake_edits(const StepInput& input);
    /// What a step's own input can change: sources with a depth, all where it rains or water evaporates, the rim of a side whose
    /// value is another than in the last step.
    void wake_inputs(const StepInput& input);
    /// Puts what is to be woken into a step's input; it stays until the step is submitted.
    void put(StepInput& input) const;
    void submitted() { wakes_.clear(); }

  private:
    using Box = std::array<int, 4>; // first column, row, last column, row of tiles
    void wake_around(double x0, double y0, double x1, double y1);
    void wake_sources(const StepInput& input);
    void wake_sides(const StepInput& input);

    const Settings& settings_;
    const int size_, columns_, rows_;
    std::vector<Box> wakes_;
    std::optional<StepInput> before_;
};

} // namespace wadi
