#include "model.hpp"
#include <algorithm>
#include <cmath>

namespace tune {
namespace {

// Twice the cells leave 0.47 to 0.77 of the error (tests/lab/report/sweep at commit 5d34f0a). Points say more than this
// where they fit, but they scatter, and an order from noise would be carried on to other sizes.
constexpr double USUAL_ORDER = 0.8, ORDER_SPREAD = 0.4, POINT_SPREAD = 0.06;
// Two runs err in part alike: seen as vectors, the cosine of the angle between their errors. 1 is Richardson's extrapolation,
// where a reference's error is all missing in a difference, 0 errors that have nothing in common. Of 0, 0.5, 0.75 and 1 this
// suited the differences between grids of dam_break and castle (96 to 800 cells).
constexpr double ALIKE = 0.75;
constexpr double LEAST_ORDER = 0.2;
// Of runs that differ in nothing but cells this is at most 0.07 on castle, dam_break, flush, letters and wadi, at least 0.22 on
// spring.
constexpr double MOST_SCATTER = 0.12;

/// The difference of two runs in units of the finer one's error.
double apart(double ratio, double order) {
    const double error = std::pow(ratio, order);
    return std::sqrt(error * error + 1 - 2 * ALIKE * error);
}

/// The factor that fits best for an order, and how badly the two fit.
template <class Shape>
ErrorFit best_factor(const std::vector<ErrorPoint>& points, double order, double& badness, const Shape& shape) {
    double mean = 0, squares = 0;
    for (const ErrorPoint& point : points)
        mean += std::log(point.difference / shape(point.h, order)) / static_cast<double>(points.size());
    for (const ErrorPoint& point : points) {
        const double off = std::log(point.difference / shape(point.h, order)) - mean;
        squares += off * off;
    }
    const double unusual = (order - USUAL_ORDER) / ORDER_SPREAD;
    badness = squares / (POINT_SPREAD * POINT_SPREAD) + unusual * unusual;
    return {std::exp(mean), order, std::sqrt(squares / static_cast<double>(points.size()))};
}

template <class Shape> ErrorFit best_order(const std::vector<ErrorPoint>& points, const Shape& shape) {
    ErrorFit best;
    double least = HUGE_VAL;
    for (double order = 0.05; order < 2.5; order += 0.01) {
        double badness = 0;
        const ErrorFit fit = best_factor(points, order, badness, shape);
        if (badness < least) {
            least = badness;
            best = fit;
        }
    }
    return best;
}

} // namespace

TimeFit fit_time(const std::vector<TimePoint>& points) {
    // step/step = 1 = fixed * (1/step) + per_cell * (cells/step) for each point
    double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
    for (const TimePoint& point : points) {
        const double a = 1 / point.step, b = point.cells / point.step;
        aa += a * a, ab += a * b, bb += b * b, a1 += a, b1 += b;
    }
    const double determinant = aa * bb - ab * ab;
    TimeFit fit{0, bb > 0 ? b1 / bb : 0};
    if (points.size() < 2 || determinant <= 1e-12 * aa * bb) return fit;
    const TimeFit both{(a1 * bb - b1 * ab) / determinant, (b1 * aa - a1 * ab) / determinant};
    if (both.fixed >= 0 && both.per_cell > 0) return both;
    return both.per_cell <= 0 ? TimeFit{a1 / aa, 0} : fit;
}

bool ErrorFit::converges() const { return order > LEAST_ORDER && scatter < MOST_SCATTER; }

double ErrorFit::at(double h) const { return factor * std::pow(h, order); }

ErrorFit fit_own(const std::vector<ErrorPoint>& points) { return best_order(points, apart); }

double order_among(double coarse, double middle, double first, double second) {
    double best = 0, least = HUGE_VAL;
    for (double order = -2; order < 2.5; order += 0.01) {
        const double ratio = std::pow(middle, order) * apart(coarse / middle, order) / apart(middle, order);
        const double off = std::abs(std::log(first / second / ratio));
        if (off < least) {
            least = off;
            best = order;
        }
    }
    return best;
}

double error_of(double difference, double reference_error) {
    if (reference_error <= 0) return difference / 2;
    const double across = (1 - ALIKE * ALIKE) * reference_error * reference_error; // square of what cannot point the same way
    return ALIKE * reference_error + std::sqrt(std::max(difference * difference - across, 0.0));
}

ErrorFit fit_other(const std::vector<ErrorPoint>& points, double reference_error, double order) {
    std::vector<ErrorPoint> whole = points;
    for (ErrorPoint& point : whole) point.difference = error_of(point.difference, reference_error);
    const auto shape = [](double h, double p) { return std::pow(h, p); };
    double badness = 0;
    return order > 0 ? best_factor(whole, order, badness, shape) : best_order(whole, shape);
}

} // namespace tune
