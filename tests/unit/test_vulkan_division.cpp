// The corrected quotient and root of Vulkan's stages, their very text, with native ones that are a few units off.
#include "backends/common/exact_float.hpp"
#include <bit>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>

namespace glsl {

int units_off = 0; // units of the last place by which the device's own functions err

float erring(float exact) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(exact) + static_cast<std::uint32_t>(units_off));
}
float inversesqrt(float x) { return erring(static_cast<float>(1 / std::sqrt(static_cast<double>(x)))); }
float sqrt(float x) { return std::sqrt(x); }
using std::abs;
using std::fma;

#define CORRECTED_DIVISION 1
#include "shaders/language/division_glsl.h"
#undef CORRECTED_DIVISION

// As it was: the half inverse is the native one in both corrections.
float uncorrected_inverse(float x) {
    const float inverse = inversesqrt(x);
    float s = x * inverse;
    s = fma(fma(-s, s, x), 0.5f * inverse, s);
    return fma(fma(-s, s, x), 0.5f * inverse, s);
}

} // namespace glsl

TEST_CASE("Vulkan's corrected root and quotient round right where the device's own inverse is up to 4 units off") {
    int wrong = 0, wrong_before = 0;
    for (glsl::units_off = -4; glsl::units_off <= 4; ++glsl::units_off) {
        for (const auto& [a, b] : wadi::backends::exact_float_operands()) {
            const float root = std::sqrt(b);
            wrong += glsl::lean_root(b) != root || glsl::wsqrt(b) != root || glsl::lean_reciprocal(b) != 1 / b;
            wrong += glsl::lean_quotient(std::fabs(a), b) != std::fabs(a) / b || glsl::wdiv(a, b) != a / b;
            wrong_before += glsl::uncorrected_inverse(b) != root;
        }
    }
    glsl::units_off = 0;
    CHECK(wrong == 0);
    CHECK(wrong_before > 0);
    // Beyond the range of the lean root, where a residual would be a denormal or infinite.
    for (const float x : {1.0e-37f, 3.3e-33f, 7.7e-20f, 5.5e20f, 3.0e38f}) CHECK(glsl::wsqrt(x) == std::sqrt(x));
    CHECK(glsl::wsqrt(0.0f) == 0);
}
