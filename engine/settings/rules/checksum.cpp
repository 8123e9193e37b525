#include "engine/settings/rules/checksum.hpp"
#include <algorithm>
#include <bit>
#include <cstring>

namespace wadi {

namespace {

std::uint64_t word(std::span<const std::byte> bytes) {
    std::uint64_t w = 0;
    std::memcpy(&w, bytes.data(), bytes.size());
    return w;
}

std::uint64_t turn(std::uint64_t lane, std::uint64_t w) {
    return std::rotl((lane ^ w) * 0x9e3779b97f4a7c15ull, 29) + 0xd1b54a32d192ed03ull;
}

} // namespace

void Checksum::add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + 32 <= bytes.size(); at += 32) {
        for (std::size_t n = 0; n < 4; ++n) lane_[n] = turn(lane_[n], word(bytes.subspan(at + 8 * n, 8)));
    }
    for (std::size_t n = 0; at < bytes.size(); n = (n + 1) % 4) {
        const std::size_t left = std::min<std::size_t>(8, bytes.size() - at);
        lane_[n] = turn(lane_[n], word(bytes.subspan(at, left)));
        at += left;
    }
    lane_[0] = turn(lane_[0], bytes.size());
}

std::uint64_t Checksum::value() const {
    std::uint64_t sum = 0;
    for (const auto lane : lane_) sum = turn(sum, lane);
    return sum;
}

} // namespace wadi
