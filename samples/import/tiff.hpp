// GeoTIFF and TIFF of heights.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace import_map {

struct Heights {
    std::uint32_t nx = 0, ny = 0;
    double dx = 1, dy = 1, west = 0, south = 0; // of cells, of the corner [m]
    bool has_cells = false;
    std::vector<float> rows; // from the north; holes are NaN
    std::vector<std::string> notes;
};

/// By the tags of GeoTIFF and GDAL; degrees become metres. Ends the program where the file is no map.
Heights read_tiff(const std::string& name);

/// As an Esri ASCII grid that gives every bit back.
void write_grid(const Heights& heights, const std::string& path);

} // namespace import_map
