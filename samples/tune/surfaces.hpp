// How far the surfaces of one run are from those of a finer one.
#pragma once
#include "measure.hpp"
#include <optional>

namespace tune {

/// Of sand and of the visible surface (water where there is any), in percent of the range over which the finer run moved it; none
/// where that is nothing.
struct Errors {
    std::optional<double> sand, water;
};

/// A field as means over the cells of another grid of the same extent.
std::vector<float> averaged(const std::vector<float>& field, int nx, int ny, int to_nx, int to_ny);

/// Mean absolute difference, over all cells and checkpoints, of how far a surface has moved since the start: what a grid makes of
/// walls and edges that stand still is no error of its steps. Both runs must have kept their surfaces at the same times, of which
/// the first `checkpoints` count.
Errors errors_against(const Run& run, const Run& reference, int checkpoints = CHECKPOINTS);

} // namespace tune
