// What a caller's overrides do to the settings and to the grid that a level is drawn on.
#pragma once
#include "engine/level/layers.hpp"
#include "engine/level/level.hpp"

namespace wadi {

/// Changes grid, time step and method; moves sources, edits and openings of sides with the stretch in y (discs and capsules keep
/// their radius). Returns the grid to draw on. Errors: bad_argument.
Result<LevelGrid> apply_overrides(const LevelOverrides& overrides, Settings& settings);

} // namespace wadi
