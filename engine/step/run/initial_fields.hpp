// The fields that a world begins with: whole quanta, ghosts around, velocities on faces.
#pragma once
#include "engine/step/run/world_state.hpp"

namespace wadi {

/// Writes the level's fields and the shapes of its sources into a new world, whose ledger begins with them. Waits for the device.
Status upload(WorldState& state, const InitialFields& fields);

} // namespace wadi
