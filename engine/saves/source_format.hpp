// A source as bytes, as snapshots and command logs hold it, little-endian:
//      0  u32      shape, material, drain, set_velocity
//     16  f64      centre x, y; radius; box x0, y0, x1, y1; velocity x, y
//     88  u64      samples of rate, discharge, level
//    112  f64[2]   per sample, in that order: time, value
#pragma once
#include "engine/settings/data/settings.hpp"
#include <cstddef>
#include <optional>
#include <span>

namespace wadi {

/// Samples of a series that a host may give to a source of a running world.
inline constexpr std::uint32_t SOURCE_SAMPLES_MOST = 4096;

std::uint64_t source_bytes(const Source& source);
/// The most that a source of a host's takes.
inline constexpr std::uint64_t SOURCE_BYTES_MOST = 112 + 3 * 16 * std::uint64_t{SOURCE_SAMPLES_MOST};
/// Writes source_bytes() at `at`, and moves it behind them.
void put_source(std::span<std::byte> to, std::size_t& at, const Source& source);
/// Reads one at `at`, and moves it behind. None, where the bytes end before it does or name no shape or material.
std::optional<Source> get_source(std::span<const std::byte> from, std::size_t& at);

} // namespace wadi
