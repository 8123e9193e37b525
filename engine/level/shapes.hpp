// The shapes that levels are drawn with: a top region, with vertical or sloping sides.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace wadi {

using Point = std::array<double, 2>; // x to the east, y to the north [m], from the south-west corner of the grid

enum class ShapeKind { plane, box, cylinder, cone, ridge, noise };

struct Shape {
    ShapeKind kind = ShapeKind::plane;
    Point slope = {0, 0}; // plane: rise per metre to the east and to the north
    Point from = {0, 0};  // box
    Point to = {0, 0};
    Point center = {0, 0};                                       // cylinder, cone
    double radius = 0;                                           // cylinder [m]
    std::vector<Point> points;                                   // ridge: its crest line
    double width = 0;                                            // ridge: of the crest [m]
    double side_slope = std::numeric_limits<double>::infinity(); // fall per metre beyond the top; infinite = vertical
    double amplitude = 0;                                        // noise [m]
    double wavelength = 1;                                       // noise: of the first octave [m]
    int octaves = 1;
    std::uint32_t seed = 0;
};

/// Distance from (x, y) to the rim of the top region of a box, cylinder, cone or ridge, negative inside [m].
double rim_distance(const Shape& shape, double x, double y);

/// Numbers of the points where those segments of a ridge end that may hold the point of its crest line nearest to a place within
/// `reach` [m] of the middle. The functions that take them give there what all of them would; other shapes have none.
std::vector<std::size_t> segments_near(const Shape& shape, const Point& middle, double reach);
double rim_distance(const Shape& shape, double x, double y, std::span<const std::size_t> segments);

/// The direction in which rim_distance() of a cylinder or ridge grows fastest, of length 1; (0, 0) on its middle.
Point rim_normal(const Shape& shape, double x, double y, std::span<const std::size_t> segments);

/// True for the shapes that have a rim.
inline bool has_rim(const Shape& shape) { return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::noise; }

/// West, south, east and north bound of the top region of a shape with a rim [m].
std::array<double, 4> rim_bounds(const Shape& shape);

/// Height of the shape at (x, y) relative to its top [m]: 0 on top, negative on the sides, -infinity where it is not.
/// A plane gives its rise from the south-west corner, noise a value within +-amplitude.
double relative_height(const Shape& shape, double x, double y, std::span<const std::size_t> segments);

/// relative_height() at places of one row, in the order of their x and close together: what they share is computed once.
void relative_heights(const Shape& shape, std::span<const double> x, double y, std::span<double> heights);

/// True where the side falls away for ever, so that the shape ends where it meets the ground.
inline bool has_sloping_sides(const Shape& shape) { return has_rim(shape) && std::isfinite(shape.side_slope); }

/// Value noise in -1 ... 1: the same on every machine for the same seed.
double value_noise(double x, double y, std::uint32_t seed);

} // namespace wadi
