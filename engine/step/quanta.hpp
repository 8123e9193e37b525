// Counting heights in whole quanta on the host: sums saturate, so a state that has blown up is counted without overflow.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wadi {

/// Largest count: 2^10 times the fullest world of 8192 x 8192 cells, whose cells hold 2^24 quanta each at most.
inline constexpr std::int64_t MOST_QUANTA = std::int64_t{1} << 60;

/// Height [m] in quanta [m], to the nearest; +-MOST_QUANTA beyond them, 0 for NaN.
inline std::int64_t to_quanta(double height, double quantum) {
    const double count = height / quantum, most = static_cast<double>(MOST_QUANTA);
    return std::isnan(count) ? 0 : std::llrint(std::clamp(count, -most, most));
}

/// Sum of two counts, kept within +-MOST_QUANTA.
inline std::int64_t add_quanta(std::int64_t a, std::int64_t b) {
    const auto bounded = [](std::int64_t n) { return std::clamp(n, -MOST_QUANTA, MOST_QUANTA); };
    return bounded(bounded(a) + bounded(b));
}

} // namespace wadi
