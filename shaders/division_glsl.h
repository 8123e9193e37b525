// Quotient and root of the stage language in GLSL. Vulkan lets a driver be a few ULP off; where it is, the residual from a
// fused multiply-add corrects both. A device's exact-float self-test decides (backends/vulkan), with this very code.
// 0 = native, 1 = corrected.
layout(constant_id = 3) const int CORRECTED_DIVISION = 0;

float wdiv(float a, float b) {
    float q = a / b;
    if (CORRECTED_DIVISION != 0) {
        q = fma(fma(-q, b, a), 1.0f / b, q);
    }
    return q;
}
float wsqrt(float x) {
    float s = sqrt(x);
    if (CORRECTED_DIVISION != 0) {
        s = s > 0.0f ? fma(fma(-s, s, x), 0.5f / s, s) : 0.0f;
    }
    return s;
}
