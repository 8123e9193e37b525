// Fields as files of geographic information systems: rows from the north, placed on a map.
#pragma once
#include <string>
#include <vector>

namespace common {

/// Cells of side `dx`, and where their south-west corner lies [m].
struct GridPlace {
    int nx = 0, ny = 0;
    double dx = 1, west = 0, south = 0;
};

/// An Esri ASCII grid; each value has the digits that give its bits back.
std::string encode_asc(const std::vector<float>& values, const GridPlace& place);

/// A GeoTIFF of 32-bit floats, not packed. It says where it lies, but in no named system of coordinates: none is known.
std::string encode_geotiff(const std::vector<float>& values, const GridPlace& place);

} // namespace common
