#include "shaders/stage_table.hpp"

namespace wadi::compute {

int find_stage(std::string_view name) {
    const auto table = stage_table();
    for (std::size_t n = 0; n < table.size(); ++n) {
        if (table[n].name == name) return static_cast<int>(n);
    }
    return -1;
}

Range2 extent_range(Extent extent, const WorldParams& p, int most_points) {
    switch (extent) {
    case Extent::cells:
        return {0, 0, p.nx, p.ny};
    case Extent::faces:
        return {0, 0, p.nx + 1, p.ny + 1};
    case Extent::rim:
        return {0, 0, 2 * (p.nx + p.ny), 1};
    case Extent::strips:
        return {0, 0, p.nx + 1, p.strips};
    case Extent::source_pieces:
        return {0, 0, POINT_ROW, (p.source_pieces + POINT_ROW - 1) / POINT_ROW};
    case Extent::source_cells:
        return {0, 0, POINT_ROW, (p.source_pieces * p.source_rows + POINT_ROW - 1) / POINT_ROW};
    case Extent::tiles:
        return {0, 0, p.tile_columns, p.tile_rows};
    case Extent::tile_rows:
        return {0, 0, 1, p.tile_rows};
    case Extent::tile_lines:
        return {0, 0, p.tile_columns, p.ny + 1};
    case Extent::points:
        return {0, 0, POINT_ROW, (most_points + POINT_ROW - 1) / POINT_ROW};
    }
    return {};
}

} // namespace wadi::compute
