// Whether a map is what its reader takes it for: holes under other numbers than the file says, and what else is worth a note.
#pragma once
#include "engine/image/map.hpp"

namespace wadi {

/// The largest float, as programs print it: no ground.
bool is_float_limit(double value);

/// Makes holes of values that programs write for them and no ground has, such as -9999, with a note; then gives each hole (NaN)
/// the height of the nearest cell that has one, by steps between neighbours: flat ground, no cliffs. Errors: bad_file (nothing
/// else is there).
Status fill_holes(Map& map, const std::string& name);

/// Notes of a map of ground: values far outside the rest, neighbours that differ as in noise, terraces of few levels, a sea.
void note_odd_ground(Map& map);

/// Mean difference of neighbours over the range of values, 0 for a constant map.
double roughness_of(const Map& map);

} // namespace wadi
