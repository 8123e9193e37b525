#include "engine/step/run/region.hpp"

namespace wadi {

Status check_region(const char* function, const Region& region, const Grid& grid, std::size_t values) {
    const auto inside = [](int first, int count, int all) {
        return first >= 0 && count >= 1 && count <= all && first <= all - count;
    };
    if (!inside(region.i0, region.nx, grid.nx) || !inside(region.j0, region.ny, grid.ny)) {
        return error(Code::bad_argument, std::string(function) + ": region of " + std::to_string(region.nx) + " x " +
                                             std::to_string(region.ny) + " cells at (" + std::to_string(region.i0) + ", " +
                                             std::to_string(region.j0) + ") is empty or not within the grid of " +
                                             std::to_string(grid.nx) + " x " + std::to_string(grid.ny));
    }
    if (values == region.cells()) return ok_status();
    return error(Code::bad_argument, std::string(function) + ": count is " + std::to_string(values) + ", the region has " +
                                         std::to_string(region.cells()) + " cells");
}

void cover(const Region& region, EditInput& edit) {
    edit.from_x = static_cast<float>(region.i0);
    edit.from_y = static_cast<float>(region.j0);
    edit.along_x = static_cast<float>(region.nx);
    edit.along_y = static_cast<float>(region.ny);
}

} // namespace wadi
