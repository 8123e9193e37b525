// When a command acts that waits: by step, then by player, whatever order hosts hand them over in.
#pragma once
#include <compare>
#include <cstdint>

namespace wadi {

struct TurnOfPlayer {
    std::uint64_t step = 0;
    std::uint32_t player = 0;
    friend auto operator<=>(const TurnOfPlayer&, const TurnOfPlayer&) = default;
};
/// Behind everything of that step.
constexpr TurnOfPlayer last_of(std::uint64_t step) { return {step, UINT32_MAX}; }

} // namespace wadi
