// Four numbers of a cell as one texel, of 32-bit or of 16-bit floats.
#ifndef PHYSICS_TEXEL
#define PHYSICS_TEXEL
#include "../physics/scalar.glsl"

#ifdef WADI_GLSL
#define TEXEL(T) out T
#else
#define TEXEL(T) T&
struct alignas(8) uvec2 { uint x, y; };
#endif

// The nearest 16-bit float (IEEE binary16) as bits, ties to even, its denormals included; at most 65504, NaN stays.
FN uint half_bits(float x) {
    float size = wabs(x);
    float least = size < 65504.0f ? size : 65504.0f;
    int bits = float_bits(least);
    int normal = ((bits + 4095 + ((bits >> 13) & 1)) >> 13) - 114688; // the exponents' biases differ by 112
    int tiny = float_bits(least + 0.5f) - 1056964608;                 // floats in [1/2, 1) are 2^-24 apart, as denormals of 16 bits are
    int found = least < 6.103515625e-05f ? tiny : normal;
    return uint(x == x ? (x < 0.0f ? found + 32768 : found) : 32256);
}

FN void put_texel(TEXEL(vec4) texel, float x, float y, float z, float w) {
    texel.x = x;
    texel.y = y;
    texel.z = z;
    texel.w = w;
}
FN void put_texel(TEXEL(uvec2) texel, float x, float y, float z, float w) {
    texel.x = half_bits(x) + (half_bits(y) << 16);
    texel.y = half_bits(z) + (half_bits(w) << 16);
}

#endif
