// Heights of a file that the library does not read itself, on their way to a grid that it reads.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace import_map {

inline constexpr std::uint32_t MOST_SAMPLES = 16384; // along one side, as maps of levels

struct Heights {
    std::uint32_t nx = 0, ny = 0;
    double dx = 1, dy = 1, west = 0, south = 0; // of cells, of the corner [m]
    bool has_cells = false;
    std::vector<float> rows; // from the north; holes are NaN
    std::vector<std::string> notes;
};

/// Ends the program where a file's sides are not those of a map.
void check_sides(const std::string& name, std::int64_t nx, std::int64_t ny);

/// As an Esri ASCII grid that gives every bit back.
void write_grid(const Heights& heights, const std::string& path);

} // namespace import_map
