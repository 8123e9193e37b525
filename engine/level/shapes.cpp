#include "engine/level/shapes.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wadi {
namespace {

double length(double x, double y) { return std::sqrt(x * x + y * y); }

Point offset_from_segment(double x, double y, const Point& a, const Point& b) {
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const double square = dx * dx + dy * dy;
    const double along = square > 0 ? std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0.0, 1.0) : 0;
    return {x - a[0] - along * dx, y - a[1] - along * dy};
}

/// From the nearest point of the shape's middle (centre or crest line) to (x, y).
Point offset_from_middle(const Shape& shape, double x, double y) {
    if (shape.kind != ShapeKind::ridge) return {x - shape.center[0], y - shape.center[1]};
    const auto square = [](const Point& p) { return p[0] * p[0] + p[1] * p[1]; };
    Point nearest = {x - shape.points[0][0], y - shape.points[0][1]};
    for (std::size_t n = 1; n < shape.points.size(); ++n) {
        const Point offset = offset_from_segment(x, y, shape.points[n - 1], shape.points[n]);
        if (square(offset) < square(nearest)) nearest = offset;
    }
    return nearest;
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

double rim_distance(const Shape& shape, double x, double y) {
    if (shape.kind == ShapeKind::box) {
        const double dx = std::max(shape.from[0] - x, x - shape.to[0]);
        const double dy = std::max(shape.from[1] - y, y - shape.to[1]);
        return dx > 0 || dy > 0 ? length(std::max(dx, 0.0), std::max(dy, 0.0)) : std::max(dx, dy);
    }
    const Point offset = offset_from_middle(shape, x, y);
    return length(offset[0], offset[1]) - (shape.kind == ShapeKind::ridge ? shape.width / 2 : shape.radius);
}

Point rim_normal(const Shape& shape, double x, double y) {
    const Point offset = offset_from_middle(shape, x, y);
    const double size = length(offset[0], offset[1]);
    return size > 0 ? Point{offset[0] / size, offset[1] / size} : Point{0, 0};
}

bool has_rim(const Shape& shape) { return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::noise; }

std::array<double, 4> rim_bounds(const Shape& shape) {
    if (shape.kind == ShapeKind::box) return {shape.from[0], shape.from[1], shape.to[0], shape.to[1]};
    const bool ridge = shape.kind == ShapeKind::ridge;
    const double reach = ridge ? shape.width / 2 : shape.radius;
    Point low = ridge ? shape.points[0] : shape.center;
    Point high = low;
    for (const Point& point : shape.points)
        for (std::size_t axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    return {low[0] - reach, low[1] - reach, high[0] + reach, high[1] + reach};
}

bool has_sloping_sides(const Shape& shape) { return has_rim(shape) && std::isfinite(shape.side_slope); }

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
    const double distance = rim_distance(shape, x, y);
    if (distance <= 0) return 0;
    return std::isfinite(shape.side_slope) ? -shape.side_slope * distance : -std::numeric_limits<double>::infinity();
}

} // namespace wadi
