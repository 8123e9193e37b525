// Structs of a host that was compiled with an older or a newer header. They only grow, at their end: what this library knows
// beyond the host's size has its default, and what the host has beyond this library's size must be zero, which is every new
// field's old meaning.
#pragma once
#include "engine/compute/status.hpp"
#include "plugin/include/wadi/wadi.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace wadi::plugin {

/// Bytes up to the end of the last field that a struct has in the first header of this ABI version: no host has less. A field
/// that is added must begin behind what sizeof was, not in its padding, which hosts leave as it is.
template <class Struct> inline constexpr std::size_t first_bytes = 0;
#define WADI_FIRST_BYTES(STRUCT, LAST_FIELD)                                                                                     \
    template <> inline constexpr std::size_t first_bytes<STRUCT> = offsetof(STRUCT, LAST_FIELD) + sizeof(STRUCT::LAST_FIELD);
WADI_FIRST_BYTES(wadi_device_options, vulkan_host)
WADI_FIRST_BYTES(wadi_device_info, memory_bytes)
WADI_FIRST_BYTES(wadi_level_overrides, any_files)
WADI_FIRST_BYTES(wadi_world_arrays, roughness)
WADI_FIRST_BYTES(wadi_world_info, warning_count)
WADI_FIRST_BYTES(wadi_world_stats, hash)
WADI_FIRST_BYTES(wadi_update_settings, interpolate_outputs)
WADI_FIRST_BYTES(wadi_frame, dropped_nanoseconds_total)
WADI_FIRST_BYTES(wadi_output_view, finished)
WADI_FIRST_BYTES(wadi_body, samples)
WADI_FIRST_BYTES(wadi_edit, stamp)
WADI_FIRST_BYTES(wadi_device_values, row_pitch)
WADI_FIRST_BYTES(wadi_cost, commands_per_step)
WADI_FIRST_BYTES(wadi_source, player)

/// Far above any struct's: a larger struct_size is memory that nobody has set.
inline constexpr std::size_t most_struct_bytes = 4096;

/// Whether the library can take the host's struct. `what`: function and argument, for the message.
template <class Struct> Status understood(const std::string& what, const Struct* host) {
    static_assert(first_bytes<Struct> > 0 && first_bytes<Struct> <= sizeof(Struct));
    if (host == nullptr) return error(Code::bad_argument, what + " is NULL");
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, host, sizeof bytes);
    if (bytes < first_bytes<Struct> || bytes > most_struct_bytes)
        return error(Code::bad_argument, what + ".struct_size is " + std::to_string(bytes) +
                                             ", not the struct's (this library's has " + std::to_string(sizeof(Struct)) +
                                             " bytes); start from wadi_default_...()");
    const auto* const from = reinterpret_cast<const std::byte*>(host);
    if (bytes > sizeof(Struct) && std::any_of(from + sizeof(Struct), from + bytes, [](std::byte b) { return b != std::byte{0}; }))
        return error(
            Code::bad_argument,
            what + ": a field behind the first " + std::to_string(sizeof(Struct)) +
                " bytes is set, which this library does not know; it is older than the header that the host was compiled with");
    return ok_status();
}

/// The host's values over defaults. Only of what is understood.
template <class Struct> Struct taken(const Struct* host, Struct defaults) {
    std::memcpy(&defaults, host, std::min<std::size_t>(host->struct_size, sizeof(Struct)));
    defaults.struct_size = sizeof(Struct);
    return defaults;
}

/// As many of the library's values as the host's struct holds; zeros behind them. Only where that is understood.
template <class Struct> void give(Struct* host, Struct values) {
    const std::uint32_t bytes = host->struct_size;
    values.struct_size = bytes;
    auto* const to = reinterpret_cast<std::byte*>(host);
    std::memcpy(to, &values, std::min<std::size_t>(bytes, sizeof(Struct)));
    if (bytes > sizeof(Struct)) std::memset(to + sizeof(Struct), 0, bytes - sizeof(Struct));
}

/// Element n of a host's array, whose elements have the size that the first one says.
template <class Struct> auto* element(Struct* array, std::size_t n) {
    using Byte = std::conditional_t<std::is_const_v<Struct>, const std::byte, std::byte>;
    return reinterpret_cast<Struct*>(reinterpret_cast<Byte*>(array) + n * array->struct_size);
}

} // namespace wadi::plugin
