// The level that is made of a map, and what the library makes of it.
#pragma once
#include "request.hpp"
#include <cstdint>
#include <vector>

namespace import_map {

/// Ground as the library has it, row 0 in the south.
struct Ground {
    int nx = 0, ny = 0;
    double dx = 1, origin[2] = {0, 0}; // [m]
    std::vector<float> heights;
    std::vector<std::string> warnings;
};

/// Grid, cells and origin of a map that lies in the folder; heights as `--terrain` has them.
Ground look_at(const Request& request, const std::string& file);

/// The ground that a level of this map has. `holes`: what becomes of them.
Ground ground_of(const Request& request, const std::string& file, const Ground& grid, const std::string& holes);

/// level.json: rain runs down the ground and out over all sides. As `--terrain` makes it, but in words to change.
void write_level(const Request& request, const std::string& file, const Ground& ground);

/// preview.png: shaded relief, holes in red.
void write_preview(const Request& request, const std::string& file, const Ground& ground);

} // namespace import_map
