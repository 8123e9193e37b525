// A snapshot as bytes: what lies where, the checksum, and for which level it is.
//
// Little-endian, version 7:
//      0  char[8]  "WADISNAP"
//      8  u32      version
//     12  u32      number of fields
//     16  u64      bytes in all
//     24  u64      checksum of all other bytes
//     32  i32[2]   cells along x and y
//     40  u32      effects: those of shaders/effect_rows.hpp from bit 0 up, choices from bit 31 down; up to version 6 choices from bit 16 up
//     44  u32      number of running totals
//     48  u64      digest of the level's settings
//     56  u64      steps
//     64  i64[2]   quanta of sand and water that the ledger began with
//     80  f64      per number of material_keys(): its value; 23 of them in version 4, 27 in 5, 28 in 6
//      .  u64      0, or the number of sources and 1 where a host has changed those of the level; not in versions up to 6
//      .  per source: source_format.hpp
//      .  f64[2]   per running total: metres, whole quanta
//      .  per field: char[32] name, u64 bytes
//      .  the fields in that order, as they lie on the device, ghosts and padding included
#pragma once
#include "engine/saves/sealed_bytes.hpp"
#include "engine/saves/source_format.hpp"
#include "engine/step/run/stepper.hpp"
#include <cstddef>
#include <span>

namespace wadi {

constexpr std::uint32_t snapshot_version = 7, oldest_snapshot_version = 4;

/// Bytes of what lies in memory already: they fit, also where size_t has 32 bits.
constexpr std::size_t in_memory(std::uint64_t bytes) { return static_cast<std::size_t>(bytes); }

struct SnapshotHeader {
    int nx = 0, ny = 0;
    std::uint32_t effects = 0;
    std::uint64_t level = 0;                    // level_digest()
    Material material;                          // the level's, as the host changed it since
    std::optional<std::vector<Source>> sources; // none: those of the level
    HostTotals totals;
    std::vector<KeptField> fields;
    std::uint32_t version = snapshot_version; // of the bytes that it was read from

    /// Bytes of the snapshot and where the contents of a field begin.
    std::uint64_t bytes() const { return begin_of(fields.size()); }
    std::uint64_t begin_of(std::size_t field) const;
};

/// Writes all but the fields' contents and the checksum, which seal() sets in the end; `to` has header.bytes().
void write_header(const SnapshotHeader& header, std::span<std::byte> to);
/// Errors: bad_file (no snapshot, a newer version, truncated, changed).
Result<SnapshotHeader> read_header(std::span<const std::byte> snapshot);

} // namespace wadi
