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

/// From the nearest point of the shape's middle (centre or crest line) to (x, y). `segments`: those of a ridge that may hold it,
/// by the numbers of their ends.
template <class Segments> Point offset_from_middle(const Shape& shape, double x, double y, const Segments& segments) {
    if (shape.kind != ShapeKind::ridge) return {x - shape.center[0], y - shape.center[1]};
    const auto square = [](const Point& p) { return p[0] * p[0] + p[1] * p[1]; };
    Point nearest = {x - shape.points[0][0], y - shape.points[0][1]};
    for (const std::size_t n : segments) {
        const Point offset = offset_from_segment(x, y, shape.points[n - 1], shape.points[n]);
        if (square(offset) < square(nearest)) nearest = offset;
    }
    return nearest;
}

/// Of a ridge; not std::views::iota, which clang 14 does not compile with g++ 12's library.
struct AllSegments {
    struct Number {
        std::size_t n;
        std::size_t operator*() const { return n; }
        void operator++() { ++n; }
        bool operator!=(const Number& other) const { return n != other.n; }
    };
    std::size_t points;
    Number begin() const { return {1}; }
    Number end() const { return {std::max<std::size_t>(points, 1)}; }
};
AllSegments all_segments(const Shape& shape) { return {shape.points.size()}; }

template <class Segments> double distance_from_rim(const Shape& shape, double x, double y, const Segments& segments) {
    if (shape.kind == ShapeKind::box) {
        const double dx = std::max(shape.from[0] - x, x - shape.to[0]);
        const double dy = std::max(shape.from[1] - y, y - shape.to[1]);
        return dx > 0 || dy > 0 ? length(std::max(dx, 0.0), std::max(dy, 0.0)) : std::max(dx, dy);
    }
    const Point offset = offset_from_middle(shape, x, y, segments);
    return length(offset[0], offset[1]) - (shape.kind == ShapeKind::ridge ? shape.width / 2 : shape.radius);
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

/// Values of noise at the corners of one cell of its lattice.
struct LatticeCell {
    double south_west, south_east, north_west, north_east;

    LatticeCell(std::int64_t i, std::int64_t j, std::uint32_t seed)
        : south_west(lattice_value(i, j, seed)), south_east(lattice_value(i + 1, j, seed)),
          north_west(lattice_value(i, j + 1, seed)), north_east(lattice_value(i + 1, j + 1, seed)) {}

    /// u, v: shares of the east and of the north.
    double blend(double u, double v) const {
        const double south = south_west * (1 - u) + south_east * u;
        const double north = north_west * (1 - u) + north_east * u;
        return south * (1 - v) + north * v;
    }
};

double smooth(double t) { return t * t * (3 - 2 * t); }

/// Adds `part` of value_noise() at (x * scale, y * scale) for every x of a row.
void add_noise(std::span<const double> x, double y, double scale, std::uint32_t seed, double part, std::span<double> sums) {
    const double y0 = std::floor(y * scale);
    const double v = smooth(y * scale - y0);
    const auto j = static_cast<std::int64_t>(y0);
    double x0 = std::floor(x[0] * scale);
    LatticeCell cell(static_cast<std::int64_t>(x0), j, seed);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double place = x[k] * scale;
        if (!(place >= x0 && place < x0 + 1)) {
            x0 = std::floor(place);
            cell = LatticeCell(static_cast<std::int64_t>(x0), j, seed);
        }
        sums[k] += part * cell.blend(smooth(place - x0), v);
    }
}

void noise_heights(const Shape& noise, std::span<const double> x, double y, std::span<double> heights) {
    // Each octave has half the wavelength and half the amplitude of the one before; together they stay within +-amplitude.
    double total = 0;
    double part = 1;
    double scale = 1 / noise.wavelength;
    std::fill(heights.begin(), heights.end(), 0.0);
    for (int octave = 0; octave < noise.octaves; ++octave) {
        add_noise(x, y, scale, noise.seed + static_cast<std::uint32_t>(octave), part, heights);
        total += part;
        part /= 2;
        scale *= 2;
    }
    for (double& height : heights) height = noise.amplitude * height / total;
}

double plane_height(const Shape& plane, double x, double y) { return plane.slope[0] * x + plane.slope[1] * y; }

/// Height at this distance from the rim, relative to the top.
double beyond_rim(const Shape& shape, double distance) {
    if (distance <= 0) return 0;
    return std::isfinite(shape.side_slope) ? -shape.side_slope * distance : -std::numeric_limits<double>::infinity();
}

} // namespace

double value_noise(double x, double y, std::uint32_t seed) {
    double value = 0;
    add_noise({&x, 1}, y, 1, seed, 1, {&value, 1});
    return value;
}

std::vector<std::size_t> segments_near(const Shape& shape, const Point& middle, double reach) {
    std::vector<std::size_t> near;
    if (shape.kind != ShapeKind::ridge) return near;
    // Both distances change by no more than the reach; and what rounding adds, far more than it does.
    double margin = 2 * reach + 1e-9 * (std::fabs(middle[0]) + std::fabs(middle[1]));
    for (const Point& point : shape.points) margin += 1e-9 * (std::fabs(point[0]) + std::fabs(point[1]));
    const auto distance = [](const Point& offset) { return length(offset[0], offset[1]); };
    const double nearest = distance(offset_from_middle(shape, middle[0], middle[1], all_segments(shape)));
    for (const std::size_t n : all_segments(shape)) {
        const Point offset = offset_from_segment(middle[0], middle[1], shape.points[n - 1], shape.points[n]);
        if (distance(offset) <= nearest + margin) near.push_back(n);
    }
    return near;
}

double rim_distance(const Shape& shape, double x, double y) { return distance_from_rim(shape, x, y, all_segments(shape)); }

double rim_distance(const Shape& shape, double x, double y, std::span<const std::size_t> segments) {
    return distance_from_rim(shape, x, y, segments);
}

Point rim_normal(const Shape& shape, double x, double y, std::span<const std::size_t> segments) {
    const Point offset = offset_from_middle(shape, x, y, segments);
    const double size = length(offset[0], offset[1]);
    return size > 0 ? Point{offset[0] / size, offset[1] / size} : Point{0, 0};
}

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

double relative_height(const Shape& shape, double x, double y, std::span<const std::size_t> segments) {
    if (shape.kind == ShapeKind::plane) return plane_height(shape, x, y);
    if (shape.kind != ShapeKind::noise) return beyond_rim(shape, rim_distance(shape, x, y, segments));
    double height = 0;
    noise_heights(shape, {&x, 1}, y, {&height, 1});
    return height;
}

void relative_heights(const Shape& shape, std::span<const double> x, double y, std::span<double> heights) {
    if (x.empty()) return;
    if (shape.kind == ShapeKind::noise) return noise_heights(shape, x, y, heights);
    if (shape.kind == ShapeKind::plane) {
        for (std::size_t k = 0; k < x.size(); ++k) heights[k] = plane_height(shape, x[k], y);
        return;
    }
    const auto segments = segments_near(shape, {(x.front() + x.back()) / 2, y}, (x.back() - x.front()) / 2);
    for (std::size_t k = 0; k < x.size(); ++k) heights[k] = relative_height(shape, x[k], y, segments);
}

} // namespace wadi
