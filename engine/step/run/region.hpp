// A rectangle of cells.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/params.hpp"
#include <cstddef>

namespace wadi {

/// Cells [i0, i0 + nx) x [j0, j0 + ny).
struct Region {
    int i0 = 0, j0 = 0, nx = 0, ny = 0;
    std::size_t cells() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
};

/// ok, or bad_argument that names `function`: a region outside the grid, empty, or with another number of values.
Status check_region(const char* function, const Region& region, const Grid& grid, std::size_t values);

/// Makes it the rectangle of an edit.
void cover(const Region& region, EditInput& edit);

} // namespace wadi
