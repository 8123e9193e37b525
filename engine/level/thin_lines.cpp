#include "engine/level/thin_lines.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace wadi {
namespace {

/// In cells.
Point on_grid(const Point& at, const LevelGrid& grid) { return {at[0] / grid.dx, at[1] * grid.stretch_y / grid.dx}; }

bool along_axis(const Point& a, const Point& b) { return a[0] == b[0] || a[1] == b[1]; }

/// The middle line as points, in cells.
std::vector<Point> middle_of(const Shape& shape, const LevelGrid& grid) {
    std::vector<Point> line;
    if (shape.kind == ShapeKind::ridge) {
        for (const Point& point : shape.points) line.push_back(on_grid(point, grid));
        return line;
    }
    const Point from = on_grid(shape.from, grid), to = on_grid(shape.to, grid);
    const Point middle = {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2};
    if (to[0] - from[0] < to[1] - from[1]) return {{middle[0], from[1]}, {middle[0], to[1]}};
    return {{from[0], middle[1]}, {to[0], middle[1]}};
}

/// The part of a segment above the grid and a cell around it: false where there is none. Segments may be 1e9 m long.
bool clip(Point& a, Point& b, const LevelGrid& grid) {
    double begin = 0, end = 1;
    const double most[2] = {grid.nx + 1.0, grid.ny + 1.0};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double along = b[axis] - a[axis];
        if (along == 0 && (a[axis] < -1 || a[axis] > most[axis])) return false;
        if (along == 0) continue;
        const double low = (-1 - a[axis]) / along, high = (most[axis] - a[axis]) / along;
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    if (begin > end) return false;
    const Point from = a, step = {b[0] - a[0], b[1] - a[1]};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        a[axis] = from[axis] + begin * step[axis];
        b[axis] = from[axis] + end * step[axis];
    }
    return true;
}

/// Adds the cells of a segment in their order along it; from one to the next over one side, never over a corner.
void add_segment(Point a, Point b, const LevelGrid& grid, std::vector<std::size_t>& cells) {
    if (!clip(a, b, grid)) return;
    const auto add = [&](int i, int j) {
        if (i < 0 || i >= grid.nx || j < 0 || j >= grid.ny) return;
        cells.push_back(static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx) + static_cast<std::size_t>(i));
    };
    const auto cell = [](double at) { return static_cast<int>(std::floor(at)); };
    int i = cell(a[0]), j = cell(a[1]);
    const int last_i = cell(b[0]), last_j = cell(b[1]);
    const int step_i = last_i < i ? -1 : 1, step_j = last_j < j ? -1 : 1;
    add(i, j);
    // Which side comes first: by where the line is when it crosses the next one along x.
    while (i != last_i || j != last_j) {
        bool along_x = j == last_j;
        if (i != last_i && j != last_j) {
            const double side_x = step_i > 0 ? i + 1 : i, side_y = step_j > 0 ? j + 1 : j;
            along_x = std::fabs((side_x - a[0]) * (b[1] - a[1])) <= std::fabs((side_y - a[1]) * (b[0] - a[0]));
        }
        if (along_x)
            i += step_i;
        else
            j += step_j;
        add(i, j);
    }
}

/// Width across a box or ridge, of the grid's metres.
double width_of(const Shape& shape, const LevelGrid& grid) {
    if (shape.kind == ShapeKind::ridge) return shape.width;
    return std::min(shape.to[0] - shape.from[0], (shape.to[1] - shape.from[1]) * grid.stretch_y);
}

bool is_upright_line(const Layer& layer) {
    const bool line = layer.shape.kind == ShapeKind::ridge || layer.shape.kind == ShapeKind::box;
    return !layer.map && line && !has_sloping_sides(layer.shape);
}

/// Whether an upright box or ridge is narrower than a cell.
bool thinner_than_a_cell(const Layer& layer, const LevelGrid& grid) {
    return is_upright_line(layer) && width_of(layer.shape, grid) < grid.dx * (1 - 1e-9);
}

bool is_thin(const Layer& layer, const LevelGrid& grid) {
    const Shape& shape = layer.shape;
    if (!is_upright_line(layer)) return false;
    double least = grid.dx;
    for (std::size_t n = 1; n < shape.points.size(); ++n)
        if (!along_axis(shape.points[n - 1], shape.points[n])) least = std::sqrt(2.0) * grid.dx; // its cells may touch by corners
    return width_of(shape, grid) < least * (1 - 1e-9);
}

std::string thin_text(const Layer& layer, const LevelGrid& grid) {
    return layer.path + ": a width of " + number_text(width_of(layer.shape, grid)) + " m is thin for cells of " +
           number_text(grid.dx) + " m; ";
}

} // namespace

std::vector<std::size_t> thin_line(const Layer& layer, const LevelGrid& grid) {
    std::vector<std::size_t> cells;
    if (!is_thin(layer, grid)) return cells;
    const std::vector<Point> middle = middle_of(layer.shape, grid);
    for (std::size_t n = 1; n < middle.size(); ++n) add_segment(middle[n - 1], middle[n], grid, cells);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

std::int64_t thin_line_work(const Layer& layer, const LevelGrid& grid) {
    constexpr double sorting = 8; // looks at a shape that a cell of the line is worth
    double work = 0;
    if (!is_thin(layer, grid)) return 0;
    const std::vector<Point> middle = middle_of(layer.shape, grid);
    for (std::size_t n = 1; n < middle.size(); ++n) {
        Point a = middle[n - 1], b = middle[n];
        if (clip(a, b, grid)) work += sorting * (std::fabs(b[0] - a[0]) + std::fabs(b[1] - a[1]) + 1);
    }
    return static_cast<std::int64_t>(work);
}

std::optional<std::string> warning_of_thin_terrain(const Layer& layer, const LevelGrid& grid) {
    if (thin_line_work(layer, grid) == 0) return std::nullopt;
    return thin_text(layer, grid) + "it is drawn as wide as the cells that its middle runs through, without gaps";
}

std::optional<std::string> warning_of_thin_sand(const Layer& layer, const LevelGrid& grid) {
    const bool raises = layer.combine != Combine::subtract && layer.combine != Combine::min && layer.amount != Amount::wet;
    if (!raises || layer.top == 0 || !thinner_than_a_cell(layer, grid)) return std::nullopt;
    return thin_text(layer, grid) + "its sand stands as wide as its cells and lower, and holds back less";
}

} // namespace wadi
