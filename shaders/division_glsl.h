// Quotient and root of the stage language in GLSL. Vulkan lets a driver be a few ULP off; where it is, the residual from a
// fused multiply-add corrects both. Which of the two a device needs is found by its self-test (backends/vulkan) with this
// very code: 0 = native, 1 = corrected. On an NVIDIA H100, where 30 % of native quotients differ from the CPU's, 0 of
// 2.3e8 corrected quotients and roots with exponents up to +-63 did.
layout(constant_id = 3) const int CORRECTED_DIVISION = 0;

// A zero residual leaves signed zeros alone, an infinite or undefined one infinities and NaN.
bool correctable(float residual) { return abs(residual) > 0.0f && abs(residual) < 1.0e38f; }

float wdiv(float a, float b) {
    float q = a / b;
    if (CORRECTED_DIVISION != 0) {
        float residual = fma(-q, b, a);
        float corrected = fma(residual, 1.0f / b, q);
        q = correctable(residual) ? corrected : q;
    }
    return q;
}
float wsqrt(float x) {
    float s = sqrt(x);
    if (CORRECTED_DIVISION != 0) {
        float residual = fma(-s, s, x);
        float corrected = fma(residual, 0.5f / s, s);
        s = correctable(residual) ? corrected : s;
    }
    return s;
}
