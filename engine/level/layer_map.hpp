// The map of a level's layer: opened as its file has it, and its values at the middles of cells.
#pragma once
#include "engine/level/layers.hpp"
#include <string>
#include <utility>
#include <vector>

namespace wadi {

/// A layer's map as its file has it, stretched over a grid of that length [m]; of ground, odd values are noted. `path` names the
/// layer in messages.
Result<Map> open_map(const MapSource& source, const std::string& path, LevelFiles& files, double length,
                     std::vector<std::string>& warnings, bool ground = false);

/// By which a map's samples become values.
std::pair<double, double> scale_and_offset(const MapSource& source);

/// What a map says at the middles of nx * ny cells; `path` names its layer in messages. Errors: bad_file, a value outside its
/// range.
Result<std::vector<float>> values_of(const Map& map, const MapSource& source, const std::string& path, int nx, int ny);

/// Advice for a map with cells of no known height, Map::filled, and its notes.
void add_map_notes(const Map& map, const std::string& path, std::vector<std::string>& warnings);

/// Maps of 2^n + 1 samples come from engines whose samples lie at the corners of cells.
bool looks_like_corners(int nx, int ny);

} // namespace wadi
