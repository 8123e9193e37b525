#include "engine/level/ground_mask.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {
namespace {

constexpr double FADES = 0.1; // of a bound of the slope

/// The share of values spread evenly over `middle` +- `half` that lies below a bound.
double share_below(double bound, double middle, double half) {
    if (half > 0) return std::clamp((bound - middle) / (2 * half) + 0.5, 0.0, 1.0);
    return middle <= bound ? 1 : 0;
}

/// And between two, both of which belong to it. Each bound may have its own spread.
double share_between(const Point& bounds, double middle, const Point& halves) {
    return std::max(share_below(bounds[1], middle, halves[1]) + share_below(-bounds[0], -middle, halves[0]) - 1, 0.0);
}

} // namespace

double taken_share(const GroundMask& mask, const GroundAt& ground, double dx) {
    double share = 1;
    if (mask.elevation) {
        const double half = (std::fabs(ground.slope[0]) + std::fabs(ground.slope[1])) * dx / 2;
        share = share_between(*mask.elevation, ground.elevation, {half, half});
    }
    if (mask.slope) {
        const auto [least, most] = *mask.slope;
        share *= share_between(*mask.slope, std::hypot(ground.slope[0], ground.slope[1]), {FADES * least, FADES * most});
    }
    return share;
}

} // namespace wadi
