#include "engine/level/coverage.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace wadi {
namespace {

constexpr int BLOCK = 64;       // cells: where the search for edges begins
constexpr double SLIVER = 1e-6; // of a cell's side, or share of a part: rounding of positions makes no film
constexpr double NOWHERE = -std::numeric_limits<double>::infinity();

bool has_edges(const Layer& layer) { return !layer.map && has_rim(layer.shape); }

bool is_vertical(const Shape& shape) { return !std::isfinite(shape.side_slope); }

/// Distance from the rim to where the sides end [m]; infinite where the ground decides it. `lowest`: no ground is lower.
double foot_of(const Layer& layer, double lowest = NOWHERE) {
    if (is_vertical(layer.shape)) return 0;
    if (layer.amount == Amount::wet) return std::numeric_limits<double>::infinity();
    const double bottom = layer.amount == Amount::surface ? std::min(lowest, layer.top) : 0;
    return (layer.top - bottom) / layer.shape.side_slope;
}

double half_diagonal(const LevelGrid& grid, int cells) {
    const double y = 1 / grid.stretch_y;
    return cells * grid.dx / 2 * std::sqrt(1 + y * y) * (1 + SLIVER);
}

void search(const Layer& layer, const LevelGrid& grid, int i, int j, int cells, std::vector<std::size_t>& found) {
    if (i >= grid.nx || j >= grid.ny) return;
    const double x = (i + 0.5 * cells) * grid.dx;
    const double y = (j + 0.5 * cells) * grid.dx / grid.stretch_y;
    const double rim = rim_distance(layer.shape, x, y);
    const double reach = half_diagonal(grid, cells);
    if (std::fabs(rim) > reach && !(std::fabs(rim - foot_of(layer)) <= reach)) return;
    if (cells == 1) {
        found.push_back(static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx) + static_cast<std::size_t>(i));
        return;
    }
    const int half = cells / 2;
    for (const int b : {0, half})
        for (const int a : {0, half}) search(layer, grid, i + a, j + b, half, found);
}

/// Share of a rectangle of this size that lies on the inner side of a straight edge: `inside` is how far its middle lies within,
/// `normal` the edge's direction outward, or (0, 0).
double covered_share(double inside, const Point& normal, const Point& size) {
    const double a = std::fabs(normal[0]) * size[0];
    const double b = std::fabs(normal[1]) * size[1];
    const double most = std::max(a, b);
    const double least = std::min(a, b);
    const double left = (a + b) / 2 - std::fabs(inside); // what of the rectangle's width lies beyond the edge
    if (left <= 0) return inside > 0 ? 1 : 0;
    const double tail = left < least ? left * left / (2 * a * b) : (left - least / 2) / most;
    if (tail < SLIVER) return inside > 0 ? 1 : 0;
    return inside > 0 ? 1 - tail : tail;
}

} // namespace

Point cell_center(const LevelGrid& grid, int i, int j) { return {column_center(grid, i), (j + 0.5) * grid.dx / grid.stretch_y}; }

CellRange reach_of(const Layer& layer, const LevelGrid& grid, double lowest) {
    const CellRange all = {0, grid.nx, 0, grid.ny};
    if (!has_edges(layer)) return all;
    const double foot = foot_of(layer, lowest);
    if (!std::isfinite(foot)) return all;
    const auto [west, south, east, north] = rim_bounds(layer.shape);
    // A cell more on either side, so that rounding leaves none out.
    const auto low = [](double position, double cell, int most) {
        return static_cast<int>(std::clamp(std::floor(position / cell) - 1, 0.0, static_cast<double>(most)));
    };
    const auto high = [](double position, double cell, int most) {
        return static_cast<int>(std::clamp(std::floor(position / cell) + 2, 0.0, static_cast<double>(most)));
    };
    const double height = grid.dx / grid.stretch_y;
    return {low(west - foot, grid.dx, grid.nx), high(east + foot, grid.dx, grid.nx), low(south - foot, height, grid.ny),
            high(north + foot, height, grid.ny)};
}

CutCells cut_cells(const std::vector<const Layer*>& layers, const LevelGrid& grid) {
    std::vector<std::size_t> found;
    for (const Layer* layer : layers) {
        if (!has_edges(*layer)) continue;
        const CellRange range = reach_of(*layer, grid);
        for (int j = range.begin_y / BLOCK * BLOCK; j < range.end_y; j += BLOCK)
            for (int i = range.begin_x / BLOCK * BLOCK; i < range.end_x; i += BLOCK) search(*layer, grid, i, j, BLOCK, found);
    }
    std::sort(found.begin(), found.end());
    CutCells cut;
    for (const std::size_t cell : found) {
        if (cut.cells.empty() || cut.cells.back() != cell) {
            cut.cells.push_back(cell);
            cut.edges.push_back(0);
        }
        ++cut.edges.back();
    }
    return cut;
}

CellSamples::CellSamples(std::vector<const Layer*> layers, const LevelGrid& grid)
    : layers_(std::move(layers)), grid_(grid), map_heights_(layers_.size()), noise_(layers_.size()), segments_(layers_.size()),
      inside_(layers_.size()), covers_(layers_.size()) {
    for (const Layer* layer : layers_) reach_.push_back(reach_of(*layer, grid));
}

/// Edges of the parts along an axis, in cells from the cell's low side.
void CellSamples::part_axis(std::size_t axis, int cell) {
    std::vector<double>& edges = edges_[axis];
    edges.clear();
    for (int n = 0; n <= CELL_PARTS; ++n) edges.push_back(static_cast<double>(n) / CELL_PARTS);
    const double size = axis == 0 ? grid_.dx : grid_.dx / grid_.stretch_y;
    for (const std::size_t n : near_) {
        const Shape& shape = layers_[n]->shape;
        if (!has_edges(*layers_[n]) || shape.kind != ShapeKind::box) continue;
        for (const double side : {shape.from[axis], shape.to[axis]}) {
            const double edge = side / size - cell;
            const auto close = [&](double other) { return std::fabs(edge - other) < SLIVER; };
            if (edge > 0 && edge < 1 && std::none_of(edges.begin(), edges.end(), close)) edges.push_back(edge);
        }
    }
    std::sort(edges.begin(), edges.end());
}

void CellSamples::sample_part(const Point& center, const Point& size, double share) {
    slices_.assign({0.0, 1.0});
    for (const std::size_t n : near_) {
        const Layer& layer = *layers_[n];
        const Shape& shape = layer.shape;
        covers_[n] = 1;
        if (layer.map) {
            inside_[n] = map_heights_[n];
        } else if (shape.kind == ShapeKind::noise) {
            inside_[n] = noise_[n];
        } else if (is_vertical(shape) && (shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::ridge)) {
            inside_[n] = 0;
            covers_[n] = covered_share(-rim_distance(shape, center[0], center[1], segments_[n]),
                                       rim_normal(shape, center[0], center[1], segments_[n]), size);
            slices_.push_back(covers_[n]);
        } else {
            inside_[n] = relative_height(shape, center[0], center[1], segments_[n]);
        }
    }
    std::sort(slices_.begin(), slices_.end());
    for (std::size_t slice = 0; slice + 1 < slices_.size(); ++slice) {
        const double width = slices_[slice + 1] - slices_[slice];
        if (width < SLIVER) continue;
        shares_.push_back(share * width);
        for (const std::size_t n : near_) relatives_.push_back(covers_[n] > slices_[slice] ? inside_[n] : NOWHERE);
    }
}

void CellSamples::sample(int i, int j) {
    shares_.clear();
    relatives_.clear();
    near_.clear();
    const Point middle = cell_center(grid_, i, j);
    const double reach = half_diagonal(grid_, 1);
    for (std::size_t n = 0; n < layers_.size(); ++n) {
        const Layer& layer = *layers_[n];
        const CellRange& range = reach_[n];
        if (i < range.begin_x || i >= range.end_x || j < range.begin_y || j >= range.end_y) continue;
        if (!layer.map) segments_[n] = segments_near(layer.shape, middle, reach);
        const bool outside =
            has_edges(layer) && rim_distance(layer.shape, middle[0], middle[1], segments_[n]) > foot_of(layer) + reach;
        if (!outside) near_.push_back(n);
        if (!layer.map && layer.shape.kind == ShapeKind::noise)
            noise_[n] = relative_height(layer.shape, middle[0], middle[1], {});
    }
    part_axis(0, i);
    part_axis(1, j);
    const Point unit = {grid_.dx, grid_.dx / grid_.stretch_y};
    for (std::size_t b = 0; b + 1 < edges_[1].size(); ++b)
        for (std::size_t a = 0; a + 1 < edges_[0].size(); ++a) {
            const double west = edges_[0][a], east = edges_[0][a + 1];
            const double south = edges_[1][b], north = edges_[1][b + 1];
            sample_part({(i + (west + east) / 2) * unit[0], (j + (south + north) / 2) * unit[1]},
                        {(east - west) * unit[0], (north - south) * unit[1]}, (east - west) * (north - south));
        }
}

double mean_of(const std::vector<double>& values, const CellSamples& samples, std::vector<double>& terms) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low == *high) return *low;
    terms.clear();
    for (std::size_t n = 0; n < values.size(); ++n) terms.push_back(values[n] * samples.share(n));
    // Sorted, so that a mirrored or transposed cell has the same bits.
    std::sort(terms.begin(), terms.end());
    double sum = 0;
    for (const double term : terms) sum += term;
    return sum;
}

} // namespace wadi
