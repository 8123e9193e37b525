#include "engine/saves/sealed_bytes.hpp"
#include <bit>
#include <string>

namespace wadi {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as the processor holds them");

constexpr std::size_t version_at = 8, bytes_at = 16, checksum_at = 24;

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
    Checksum sum;
    sum.add(bytes.first(checksum_at));
    sum.add(bytes.subspan(checksum_at + 8));
    return sum.value();
}

} // namespace

void begin_sealed(std::span<std::byte> bytes, const char (&name)[9], std::uint32_t version) {
    std::memcpy(bytes.data(), name, 8);
    std::size_t at = version_at;
    put(bytes, at, version);
    at = bytes_at;
    put(bytes, at, std::uint64_t{bytes.size()});
    put(bytes, at, std::uint64_t{0});
}

void seal(std::span<std::byte> bytes) {
    std::size_t at = checksum_at;
    put(bytes, at, checksum_of(bytes));
}

Status check_sealed(const char* what, std::span<const std::byte> bytes, const char (&name)[9], SealedVersions versions,
                    std::size_t least) {
    const auto broken = [&](const std::string& text) { return error(Code::bad_file, what + (": " + text)); };
    if (bytes.size() < least)
        return broken(std::to_string(bytes.size()) + " bytes are fewer than the " + std::to_string(least) + " of a header");
    if (std::memcmp(bytes.data(), name, 8) != 0) return broken(std::string("it does not begin with ") + name);
    const auto found = get<std::uint32_t>(bytes, version_at);
    if (found > versions.newest || found < versions.oldest) {
        const bool newer = found > versions.newest;
        return broken("version " + std::to_string(found) + (newer ? " is newer than" : " is older than") + " the version " +
                      std::to_string(newer ? versions.newest : versions.oldest) + " that this library reads");
    }
    const auto size = get<std::uint64_t>(bytes, bytes_at);
    if (size != bytes.size())
        return broken("it says that it has " + std::to_string(size) + " bytes, but there are " + std::to_string(bytes.size()));
    if (get<std::uint64_t>(bytes, checksum_at) != checksum_of(bytes)) return broken("its checksum is wrong: bytes were changed");
    return ok_status();
}

std::uint32_t sealed_version(std::span<const std::byte> bytes) { return get<std::uint32_t>(bytes, version_at); }

} // namespace wadi
