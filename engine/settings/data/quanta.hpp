// Heights in whole quanta on the host: rounding to them, and counting in them. Sums saturate, so a state that has blown up is
// counted without overflow.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wadi {

/// Largest count: 2^10 times the fullest world of 8192 x 8192 cells, whose cells hold 2^24 quanta each at most.
inline constexpr std::int64_t MOST_QUANTA = std::int64_t{1} << 60;

/// Where heights midway between two quanta go. Levels draw with `away` from zero, as edits on the device are rounded; heights
/// that a host gives go to the `even` one. Either rule for both would change the bits of worlds made the other way.
enum class Halves { even, away };

/// std::round(), without the call that it is on processors of the base instruction set.
inline double round_away(double x) {
    constexpr double whole = 4503599627370496; // 2^52: from here on there are no fractions
    const double size = std::fabs(x);
    if (!(size < whole)) return x;
    const double even = (size + whole) - whole; // halves to the even neighbour
    return std::copysign(even + (size - even == 0.5 ? 1.0 : 0.0), x);
}

/// The nearest whole quantum [m] to a height [m]; the height itself where `quantum` is 0.
inline double nearest_quantum(double height, double quantum, Halves halves) {
    if (quantum <= 0) return height;
    const double count = height / quantum;
    return (halves == Halves::even ? std::nearbyint(count) : round_away(count)) * quantum;
}

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
