// What a setting costs and errs, from a few runs.
#pragma once
#include "surfaces.hpp"
#include <array>

namespace tune {

/// Time of a step = fixed + per_cell * cells [s].
struct TimeFit {
    double fixed = 0, per_cell = 0;
    double step(double cells) const { return fixed + per_cell * cells; }
};
struct TimePoint {
    double cells, step; // [s]
};
/// Least squares of relative deviations; neither number below 0.
TimeFit fit_time(const std::vector<TimePoint>& points);

/// Error = factor * h^order [percent], h the size of a cell in units of the reference's.
struct ErrorFit {
    double factor = 0, order = 0;
    double scatter = 0; // root mean square of the points' relative deviations
    double at(double h) const;
    /// Whether differences from the reference fall with cells, and as a power of them.
    bool converges() const;
};
struct ErrorPoint {
    double h, difference; // from the reference [percent]
};
/// From differences to a reference of the same kind, whose own error is at(1).
ErrorFit fit_own(const std::vector<ErrorPoint>& points);
/// The order at which runs come closer to each other: cells of sizes `coarse`, `middle` and 1, differences of the first two and
/// of the last two. Below 0 where they come apart.
double order_among(double coarse, double middle, double first, double second);
/// From differences of another kind to that reference. `order`: where it is known from runs of a kin (above 0), one point is
/// enough.
ErrorFit fit_other(const std::vector<ErrorPoint>& points, double reference_error, double order);
/// The error of a run that differs so much from a reference of this error [percent]. Where that is not known (0), what it is at
/// least if the reference errs no more than the run: two errors add up to their difference or more.
double error_of(double difference, double reference_error);

} // namespace tune
