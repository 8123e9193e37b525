// Steps count in 64 bits, but stages get an int.
#pragma once
#include <cstdint>

namespace wadi {

/// The numbers that stages get are those of the steps below twice this, and from there on lie between it and twice it: they count
/// on by one, but begin anew every STEP_TURN steps, where all active tiles wake (Stepper).
inline constexpr std::uint64_t STEP_TURN = std::uint64_t{1} << 30;

constexpr int stage_step(std::uint64_t step) {
    return static_cast<int>(step < 2 * STEP_TURN ? step : STEP_TURN + step % STEP_TURN);
}
/// Whether the numbers that stages get begin anew with this step.
constexpr bool turns(std::uint64_t step) { return step >= 2 * STEP_TURN && step % STEP_TURN == 0; }

/// The newest step up to `now` that stages know as `number`: a number older than STEP_TURN steps counts as newer than it is.
constexpr std::int64_t step_behind(std::int32_t number, std::uint64_t now) {
    if (now < 2 * STEP_TURN || number < static_cast<std::int64_t>(STEP_TURN)) return number;
    const std::uint64_t age = (now - static_cast<std::uint64_t>(number)) % STEP_TURN;
    return static_cast<std::int64_t>(now - age);
}

/// What a step adds to its fluxes, in quanta, before they are cut to whole ones: multiples of the golden ratio less their whole
/// part, which are spread over [0, 1) as evenly as numbers that come one by one can be (Weyl 1916; Knuth, TAOCP 3, 6.4).
constexpr float rounding_phase(std::uint64_t step) {
    return static_cast<float>((static_cast<std::uint32_t>(stage_step(step)) * 0x9E3779B9U) >> 8U) / static_cast<float>(1U << 24U);
}

} // namespace wadi
