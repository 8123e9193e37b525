// Crests of a map that cells of the grid are too wide for: dams, dikes and walls. The mean over a cell is lower than a crest that
// is narrower than it, and water would pass where the map holds it back.
#pragma once
#include "engine/image/map.hpp"
#include "engine/level/layers.hpp"
#include <cstddef>
#include <vector>

namespace wadi {

/// What was raised, and where most.
struct KeptCrests {
    std::size_t cells = 0;
    std::size_t where = 0; // row-major
    double most = 0;       // [m]
};

/// Raises cells of `heights`, drawn from the samples value * scale + offset of a finer map, so that no way from cell to cell
/// crosses lower ground than every way through the samples of both cells does, from the lowest in one to the lowest in the other.
/// That is for crests that stand out of the ground beside them: where slopes meet in a ridge the mean is as good as anywhere.
/// Left out are losses no larger than what noise makes, and grids as fine as the map.
KeptCrests keep_crests(const Map& map, double scale, double offset, const LevelGrid& grid, std::vector<float>& heights);

} // namespace wadi
