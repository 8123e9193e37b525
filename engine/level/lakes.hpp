// Lakes that a level gives as a map of depths, on a grid of another size: their surface is carried over, not their depth, which
// would not fit the ground any more.
#pragma once
#include "engine/image/map.hpp"
#include <vector>

namespace wadi {

/// Columns in row-major order; `sand` and `water` may be empty for none.
struct ColumnFields {
    const std::vector<float>& terrain; // H [m]
    const std::vector<float>& sand;    // hs [m]
    std::vector<float>& water;         // W [m]
};

/// Levels the water of lakes in `cells`, nx * ny of them, which holds the depths of `samples` resampled: to the surface H + W
/// that the lake has in the samples, mx * my of them over the same rectangle. A lake is pure water whose surface is flatter than
/// its bed, with the pore water at its level beside it. Water on slopes, damp sand and fronts against lower ground keep their
/// depth.
void level_lakes(const ColumnFields& samples, int mx, int my, const ColumnFields& cells, int nx, int ny);

} // namespace wadi
