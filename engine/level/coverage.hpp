// Cells that the edges of shapes run through, and samples of the layers inside them: sand and water are drawn by area, so that a
// shape has its volume on every grid and a round one no stairs.
#pragma once
#include "engine/level/layers.hpp"
#include <cstddef>
#include <limits>
#include <vector>

namespace wadi {

/// Cells [begin, end) of columns and rows outside which the layer changes nothing. `lowest`: no terrain is lower [m].
struct CellRange {
    int begin_x = 0, end_x = 0, begin_y = 0, end_y = 0;
};
CellRange reach_of(const Layer& layer, const LevelGrid& grid, double lowest = -std::numeric_limits<double>::infinity());

/// Middle of a column of cells [m].
inline double column_center(const LevelGrid& grid, int i) { return (i + 0.5) * grid.dx; }

/// Middle of a cell, in the level's own coordinates.
Point cell_center(const LevelGrid& grid, int i, int j);

inline constexpr int CELL_PARTS = 8; // of a cell's side

/// Cells, row-major and ascending, that an edge of these layers runs through or may touch: a rim, or the foot of a slope.
struct CutCells {
    std::vector<std::size_t> cells;
    std::vector<int> edges; // how many layers have one in the cell
};
CutCells cut_cells(const std::vector<const Layer*>& layers, const LevelGrid& grid);

/// The layers within one cell: its parts, each with a share of the area and what every layer is there. The cell is parted where
/// sides of boxes run and at eighths; a part that the rim of a vertical cylinder or ridge cuts falls into slices, as if the
/// rims of all layers ran side by side: layers of the same outline hold the same slices.
class CellSamples {
  public:
    /// `layers` must outlive it. Maps take their height from map_heights().
    CellSamples(std::vector<const Layer*> layers, const LevelGrid& grid);

    /// Heights that map layers have in the cell to be sampled, one per layer; others are not read.
    std::vector<double>& map_heights() { return map_heights_; }
    void sample(int i, int j);

    std::size_t count() const { return shares_.size(); }
    double share(std::size_t sample) const { return shares_[sample]; }
    /// The layers that are not wholly outside the cell, in their order.
    const std::vector<std::size_t>& near() const { return near_; }
    /// As relative_height(): of the layer near()[place] in this sample; of a map its height.
    double relative(std::size_t sample, std::size_t place) const { return relatives_[sample * near_.size() + place]; }

  private:
    void part_axis(std::size_t axis, int cell);
    void sample_part(const Point& center, const Point& size, double share);

    std::vector<const Layer*> layers_;
    std::vector<CellRange> reach_;
    LevelGrid grid_;
    std::vector<double> map_heights_, noise_;
    std::vector<std::size_t> near_;
    std::vector<std::vector<std::size_t>> segments_; // of ridges, near the cell
    std::vector<double> edges_[2];
    std::vector<double> relatives_, shares_, inside_, covers_, slices_;
};

/// Mean of values by their shares of the area; equal values keep every bit. The order of the terms does not count. Changes
/// `terms`.
double mean_of(const std::vector<double>& values, const CellSamples& samples, std::vector<double>& terms);

} // namespace wadi
