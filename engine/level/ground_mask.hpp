// Where a layer lies by the ground that it falls on: between two elevations, as steep as this.
#pragma once
#include "engine/level/shapes.hpp"
#include <optional>

namespace wadi {

struct GroundMask {
    std::optional<Point> elevation; // least and most [m]
    std::optional<Point> slope;     // least and most rise per metre, whichever way
};

/// The ground of a cell as a plane [m], rise per metre.
struct GroundAt {
    double elevation = 0;
    Point slope = {0, 0};
};

/// The share of a cell of side `dx` [m] that the mask takes, 0 ... 1: where a bound runs through it as contour lines do, so that
/// masks make no stairs; a bound of the slope fades over a tenth of it on both sides.
double taken_share(const GroundMask& mask, const GroundAt& ground, double dx);

} // namespace wadi
