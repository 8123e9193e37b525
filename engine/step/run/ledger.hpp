// The ledger: what was really added and taken, in quanta, as stages count it on the device. Every call waits for the device.
#pragma once
#include "engine/step/run/world_state.hpp"
#include <span>

namespace wadi {

/// Quanta moved since creation.
struct Ledger {
    std::int64_t water_in = 0, water_out = 0, sand_in = 0, sand_out = 0, refused = 0;
};

/// Sources, rain, edits and sides together.
Result<Ledger> read_ledger(WorldState& state);
/// What went in and out through the open sides alone; zero where the plan has no such ledger.
Result<std::pair<std::int64_t, std::int64_t>> read_side_ledger(WorldState& state, const char* field);
/// Adds to entries (LEDGER_WATER_IN, ...) of the ledger of sources and edits: to all of them, or to none where that fails. The
/// world is given up where it can be neither.
struct LedgerChange {
    int entry = 0;
    std::int64_t quanta = 0;
};
Status count_in_ledger(WorldState& state, std::span<const LedgerChange> changes);

} // namespace wadi
