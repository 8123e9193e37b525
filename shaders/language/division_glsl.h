// Quotient and root of the stage language in GLSL. Vulkan lets a driver be a few ULP off; where it is, the residual from a
// fused multiply-add corrects both: a quotient by a reciprocal that is itself corrected, twice, which rounds correctly (P. Markstein
// 1990); with the native reciprocal, once, about one quotient in 1e9 stayed wrong. Which of the two a device needs is found by its
// self-test (backends/vulkan) with this very code: 0 = native, 1 = corrected.
#ifndef CORRECTED_DIVISION // a test compiles this text for a processor
layout(constant_id = 3) const int CORRECTED_DIVISION = 0;
#endif

// A zero residual leaves signed zeros alone, an infinite or undefined one infinities and NaN.
bool correctable(float residual) { return abs(residual) > 0.0f && abs(residual) < 1.0e38f; }

float wdiv(float a, float b) {
    float q = a / b;
    if (CORRECTED_DIVISION != 0) {
        float reciprocal = 1.0f / b;
        reciprocal = fma(fma(-b, reciprocal, 1.0f), reciprocal, reciprocal);
        float residual = fma(-q, b, a);
        q = correctable(residual) ? fma(residual, reciprocal, q) : q;
        residual = fma(-q, b, a);
        q = correctable(residual) ? fma(residual, reciprocal, q) : q;
    }
    return q;
}
// The same bits in half of the instructions where no residual can underflow (shaders/README: ranges).
float lean_quotient(float a, float b) {
    if (CORRECTED_DIVISION == 0) return a / b;
    float reciprocal = 1.0f / b;
    reciprocal = fma(fma(-b, reciprocal, 1.0f), reciprocal, reciprocal);
    float q = a * reciprocal;
    q = fma(fma(-b, q, a), reciprocal, q);
    return fma(fma(-b, q, a), reciprocal, q);
}
float lean_reciprocal(float b) { return lean_quotient(1.0f, b); }
// The half reciprocal is corrected before the root is: with the native one the roots of 1 + 2^-23 and of a few more mantissas, which lie
// nearest to the middle between two floats, rounded wrong.
float lean_root(float x) {
    if (CORRECTED_DIVISION == 0) return sqrt(x);
    float inverse = inversesqrt(x);
    float s = x * inverse;
    float half_inverse = 0.5f * inverse;
    float off = fma(-s, half_inverse, 0.5f);
    s = fma(s, off, s);
    half_inverse = fma(half_inverse, off, half_inverse);
    return fma(fma(-s, s, x), half_inverse, s);
}
// Scaled by powers of 4, so that the residual neither underflows nor overflows.
float wsqrt(float x) {
    bool small = x < 1.0e-12f;
    bool large = x > 1.0e20f;
    float s = lean_root(small ? x * 1.09951163e12f : large ? x * 9.09494702e-13f : x);
    s = small ? s * 9.53674316e-7f : large ? s * 1048576.0f : s;
    return x > 0.0f && x < 3.4e38f ? s : sqrt(x);
}
