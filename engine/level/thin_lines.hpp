// Walls and ditches of terrain that are thinner than cells. Terrain is drawn at the middles of cells, which a thin shape passes
// by or joins by their corners alone: water would pass a wall, or stand in a ditch, and on another grid would not.
#pragma once
#include "engine/level/layers.hpp"
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wadi {

/// Cells, row-major and ascending, that the middle line of a thin upright box or ridge runs through, each joined to the next by a
/// side. Empty for other layers, and for those wide enough to have no gaps.
std::vector<std::size_t> thin_line(const Layer& layer, const LevelGrid& grid);

/// What that takes, as drawing_work() counts.
std::int64_t thin_line_work(const Layer& layer, const LevelGrid& grid);

/// What to say of a layer of terrain that is drawn by its thin_line(), and of sand that is narrower than a cell; else nothing.
std::optional<std::string> warning_of_thin_terrain(const Layer& layer, const LevelGrid& grid);
std::optional<std::string> warning_of_thin_sand(const Layer& layer, const LevelGrid& grid);

} // namespace wadi
