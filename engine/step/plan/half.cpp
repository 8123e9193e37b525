#include "engine/step/plan/half.hpp"
#include <algorithm>
#include <cmath>

namespace wadi {

namespace {
constexpr int mantissa_bits = 10, least_exponent = -14, bias = 15;
constexpr float largest = 65504;
} // namespace

std::uint16_t to_half(float value) {
    if (std::isnan(value)) return 0x7e00;
    const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
    const float size = std::min(std::abs(value), largest);
    const int exponent = std::max(size > 0 ? std::ilogb(size) : least_exponent, least_exponent);
    // In units of the last place: below 1024 a denormal, which the sum below gets right, as it does a carry.
    const auto units = static_cast<int>(std::nearbyint(std::ldexp(size, mantissa_bits - exponent)));
    const int magnitude = ((exponent + bias - 1) << mantissa_bits) + units;
    return magnitude == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(sign | magnitude);
}

float half_at_most(float value) {
    const auto nearest = to_half(value);
    return from_half(from_half(nearest) > value ? static_cast<std::uint16_t>(nearest - 1) : nearest);
}

float from_half(std::uint16_t bits) {
    const int exponent = (bits >> mantissa_bits) & 31, mantissa = bits & 1023;
    const float size = exponent == 31  ? NAN
                       : exponent == 0 ? std::ldexp(static_cast<float>(mantissa), least_exponent - mantissa_bits)
                                       : std::ldexp(static_cast<float>(mantissa + 1024), exponent - bias - mantissa_bits);
    return (bits & 0x8000) != 0 ? -size : size;
}

} // namespace wadi
