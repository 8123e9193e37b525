#include "engine/level/shapes.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi {
namespace {

double length(double x, double y) { return std::sqrt(x * x + y * y); }

double distance_to_segment(double x, double y, const Point& a, const Point& b) {
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const double square = dx * dx + dy * dy;
    const double along = square > 0 ? std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0.0, 1.0) : 0;
    return length(x - a[0] - along * dx, y - a[1] - along * dy);
}

double distance_to_line(const std::vector<Point>& points, double x, double y) {
    double least = length(x - points[0][0], y - points[0][1]);
    for (std::size_t n = 1; n < points.size(); ++n) least = std::min(least, distance_to_segment(x, y, points[n - 1], points[n]));
    return least;
}

/// How far (x, y) lies outside the top region of the shape [m]; 0 inside.
double distance_from_top(const Shape& shape, double x, double y) {
    switch (shape.kind) {
    case ShapeKind::box: {
        const double dx = std::max({shape.from[0] - x, x - shape.to[0], 0.0});
        const double dy = std::max({shape.from[1] - y, y - shape.to[1], 0.0});
        return length(dx, dy);
    }
    case ShapeKind::cylinder:
    case ShapeKind::cone:
        return std::max(length(x - shape.center[0], y - shape.center[1]) - shape.radius, 0.0);
    case ShapeKind::ridge:
        return std::max(distance_to_line(shape.points, x, y) - shape.width / 2, 0.0);
    case ShapeKind::plane:
    case ShapeKind::noise:
        break;
    }
    return 0;
}

/// A well-mixed 32-bit hash of a lattice point ("lowbias32" of C. Wellons), as a number in -1 ... 1.
double lattice_value(std::int64_t i, std::int64_t j, std::uint32_t seed) {
    const auto mix = [](std::uint32_t h) {
        h = (h ^ (h >> 16)) * 0x7feb352du;
        h = (h ^ (h >> 15)) * 0x846ca68bu;
        return h ^ (h >> 16);
    };
    std::uint32_t h = mix(seed + 0x9e3779b9u);
    h = mix(h ^ static_cast<std::uint32_t>(i));
    h = mix(h ^ static_cast<std::uint32_t>(j));
    return h / 2147483647.5 - 1;
}

} // namespace

double value_noise(double x, double y, std::uint32_t seed) {
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const auto i = static_cast<std::int64_t>(x0);
    const auto j = static_cast<std::int64_t>(y0);
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double u = smooth(x - x0);
    const double v = smooth(y - y0);
    const double south = lattice_value(i, j, seed) * (1 - u) + lattice_value(i + 1, j, seed) * u;
    const double north = lattice_value(i, j + 1, seed) * (1 - u) + lattice_value(i + 1, j + 1, seed) * u;
    return south * (1 - v) + north * v;
}

bool has_sloping_sides(const Shape& shape) {
    return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::noise && std::isfinite(shape.side_slope);
}

double relative_height(const Shape& shape, double x, double y) {
    if (shape.kind == ShapeKind::plane) return shape.slope[0] * x + shape.slope[1] * y;
    if (shape.kind == ShapeKind::noise) {
        // Each octave has half the wavelength and half the amplitude of the one before; together they stay within +-amplitude.
        double sum = 0;
        double total = 0;
        double part = 1;
        double scale = 1 / shape.wavelength;
        for (int octave = 0; octave < shape.octaves; ++octave) {
            sum += part * value_noise(x * scale, y * scale, shape.seed + static_cast<std::uint32_t>(octave));
            total += part;
            part /= 2;
            scale *= 2;
        }
        return shape.amplitude * sum / total;
    }
    const double distance = distance_from_top(shape, x, y);
    if (distance == 0) return 0;
    return std::isfinite(shape.side_slope) ? -shape.side_slope * distance : -std::numeric_limits<double>::infinity();
}

} // namespace wadi
