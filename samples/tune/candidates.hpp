// The settings to choose among and which of them are worth their time.
#pragma once
#include "model.hpp"
#include <map>
#include <string>

namespace tune {

/// A setting with what it is expected to cost and to err.
struct Candidate {
    Settings settings;
    double step_ms = 0;
    double steps_per_frame = 0;
    double frame_ms = 0;
    Errors errors; // none: cannot be told
    /// Sand's and water's together, as far as they can be told.
    double sum() const { return errors.sand.value_or(0) + errors.water.value_or(0); }
};

/// What is known of a way.
struct WayModel {
    Way way;
    TimeFit time;
    std::optional<ErrorFit> sand, water;
};

/// Ways to choose among: one or two orders where there is sand or water, substeps.
std::vector<Way> ways(const Level& level, bool has_sand, bool has_water);
/// How a reference is stepped.
Way reference_way(const Level& level, bool has_sand, bool has_water);
/// All grids from 16 cells along the shorter side to four times the level's cells along x.
std::vector<Settings> grids(const Level& level);

/// `reference_cells_x`: of the run that errors are in units of (ErrorFit). `scale`: factor on all times.
std::vector<Candidate> candidates(const Level& level, const std::vector<WayModel>& models, int reference_cells_x, double frames,
                                  double scale);
/// Those that none errs less than for as little time, by rising time. Where no error can be told more cells count as less error.
std::vector<Candidate> frontier(std::vector<Candidate> all);
/// The one of the frontier that errs least within a budget, or none.
std::optional<Candidate> best_within(const std::vector<Candidate>& frontier, double budget_ms);

/// "order 2, T 2": what a way does, in words for a table.
std::string describe(const Way& way);

} // namespace tune
