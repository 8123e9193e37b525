// Walls and ditches of terrain that are thinner than cells. Terrain is drawn at the middles of cells, which a thin shape passes
// by or joins by their corners alone: water would pass a wall, or stand in a ditch, and on another grid would not.
#pragma once
#include "engine/level/layers.hpp"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wadi {

/// Width across a box or ridge, of the grid's metres.
double width_of(const Shape& shape, const LevelGrid& grid);

/// Cells, row-major and ascending, that the middle line of a thin upright box or ridge runs through, each joined to the next by a
/// side. Empty for other layers, and for those wide enough to have no gaps.
std::vector<std::size_t> thin_line(const Layer& layer, const LevelGrid& grid);

/// Whether an upright box or ridge is narrower than a cell.
bool thinner_than_a_cell(const Layer& layer, const LevelGrid& grid);

/// What that takes, as drawing_work() counts.
std::int64_t thin_line_work(const Layer& layer, const LevelGrid& grid);

} // namespace wadi
