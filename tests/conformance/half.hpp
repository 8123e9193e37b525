// 16-bit floats (IEEE binary16) on the host, as publish_packed_half writes them.
#pragma once
#include <cstdint>

namespace wadi::conformance {

/// The nearest 16-bit float, ties to even; beyond 65504 that number, zero without a sign, NaN stays NaN.
std::uint16_t to_half(float value);
float from_half(std::uint16_t bits);

} // namespace wadi::conformance
