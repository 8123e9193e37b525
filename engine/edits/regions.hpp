// Rectangles of cells written by the host, between two steps. Every call waits for the device.
#pragma once
#include "engine/edits/edits.hpp"
#include "engine/step/run/region.hpp"
#include <span>

namespace wadi {

/// Overwrites heights of a layer, rounded to whole quanta; `values` row-major, row 0 in the south. Sand and water that this adds
/// or takes is in the ledger, added sand is unstrained or in balance (NUMERICS 2.20), velocities stay. Promotes the world where
/// the material is new. Errors: bad_argument (check_region; NaN, a negative depth, a column above the declared largest height:
/// with its cell; a material that the level forces off), out_of_memory: nothing is changed but the plan, which may be larger
/// then.
Status write_region(WorldState& state, Stepper& stepper, EditLayer layer, const Region& region, std::span<const float> values);

/// Drops the effects of materials that the state no longer holds. What went through open sides stays in the ledger.
Status trim(WorldState& state, Stepper& stepper);

} // namespace wadi
