// Whether what a snapshot holds makes sense: its checksum says that it is whole, not where it comes from.
#pragma once
#include "engine/saves/snapshot_format.hpp"

namespace wadi {

/// ok, or bad_file that names field and cell, or the number: every value finite, heights, speeds and strain within what any world
/// of these settings can reach, running totals whole.
Status check_contents(const SnapshotHeader& header, std::span<const std::byte> snapshot, const Settings& settings);

/// Quanta of sand and water that it holds beyond those that its books say, as wadi_world_stats counts them.
struct Drift {
    std::int64_t sand = 0, water = 0;
};
Drift drift_of(const SnapshotHeader& header, std::span<const std::byte> snapshot, const Settings& settings);

} // namespace wadi
