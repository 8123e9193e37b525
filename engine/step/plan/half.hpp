// 16-bit floats (IEEE binary16) on the host, for fields of a world with half storage (NUMERICS 2.17).
#pragma once
#include <cstdint>

namespace wadi {

/// The nearest 16-bit float, ties to even; beyond 65504 that number, zero without a sign, NaN stays NaN.
std::uint16_t to_half(float value);
float from_half(std::uint16_t bits);
/// The largest 16-bit float that is not above a positive value.
float half_at_most(float value);

} // namespace wadi
