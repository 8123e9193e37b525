// What snapshots and command logs have in common: bytes with a name, a version and a checksum, little-endian:
//      0  char[8]  name
//      8  u32      version
//     16  u64      bytes in all
//     24  u64      checksum of all other bytes
#pragma once
#include "engine/compute/status.hpp"
#include "engine/settings/rules/checksum.hpp"
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace wadi {

constexpr std::size_t sealed_header_bytes = 32;

/// Writes name, version and size; seal() sets the checksum once everything is in place.
void begin_sealed(std::span<std::byte> bytes, const char (&name)[9], std::uint32_t version);
void seal(std::span<std::byte> bytes);
/// Versions of a format that this library reads.
struct SealedVersions {
    std::uint32_t oldest, newest;
};
/// ok, or bad_file: another name, another version, truncated, changed, or fewer than `least` bytes. `what` begins the message.
Status check_sealed(const char* what, std::span<const std::byte> bytes, const char (&name)[9], SealedVersions versions,
                    std::size_t least);
/// The version that checked bytes have.
std::uint32_t sealed_version(std::span<const std::byte> bytes);

template <class T> T get(std::span<const std::byte> from, std::size_t at) {
    T value;
    std::memcpy(&value, from.data() + at, sizeof value);
    return value;
}

template <class T> void put(std::span<std::byte> to, std::size_t& at, T value) {
    std::memcpy(to.data() + at, &value, sizeof value);
    at += sizeof value;
}

} // namespace wadi
