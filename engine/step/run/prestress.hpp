// The strain that sand at rest begins with.
#pragma once
#include "engine/step/run/region.hpp"
#include "engine/step/run/world_state.hpp"

namespace wadi {

enum class Balance : std::int8_t { take = -1, add = 1 };

/// Adds to a region's strain that at which its sand, as it lies there now, is in balance (NUMERICS 2.20), or takes it. Nothing
/// without method.prestress or strain. Waits for the device.
Status change_balance(WorldState& state, const Region& region, Balance change);
/// Adds it everywhere.
Status put_in_balance(WorldState& state);
/// Leaves no other strain: of sand that has not moved yet, under another material than it was drawn with. Taking the balance of
/// the one before would leave the rounding of 16-bit storage.
Status balance_anew(WorldState& state);

} // namespace wadi
