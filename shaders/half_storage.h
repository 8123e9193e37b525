// 16-bit floats of buffers of type float_or_half (NUMERICS 2.17), for all three languages. What is stored is rounded by half_of, in
// fused stages also where it stays in a register, so that every backend and every way to run a step has the same bits.

// The nearest 16-bit float (IEEE binary16), ties to even, its denormals included; at most 65504, NaN stays.
FN float half_of(float x) {
    float y = x > 65504.0f ? 65504.0f : x;
    y = y < -65504.0f ? -65504.0f : y;
    int bits = float_bits(y);
    float normal = bits_float((bits + 4095 + ((bits >> 13) & 1)) & ~8191);
    float tiny = (y + 0.75f) - 0.75f; // floats in [1/2, 1) are 2^-24 apart, as denormals of 16 bits are
    return wabs(y) < 6.103515625e-05f ? tiny : normal;
}
#ifndef WADI_GLSL

// One 16-bit float in memory. Values are those of half_of, so that nothing is left to round.
struct Half {
    unsigned short bits;
    HELPER explicit Half(float x) { *this = x; }
    HELPER operator float() const {
#ifdef __CUDA_ARCH__
        float x;
        asm("cvt.f32.f16 %0, %1;" : "=f"(x) : "h"(bits));
        return x;
#else
        float size = bits_float((bits & 0x7fff) << 13) * 5.192296858534828e+33f; // 2^112: the exponents' biases differ by it
        float x = (bits & 0x7fff) < 0x7c00 ? size : bits_float(0x7fc00000);
        return (bits & 0x8000) != 0 ? -x : x;
#endif
    }
    HELPER Half& operator=(float x) {
        float y = half_of(x);
#ifdef __CUDA_ARCH__
        asm("cvt.rn.f16.f32 %0, %1;" : "=h"(bits) : "f"(y));
#else
        int size = float_bits(wabs(y) * 1.925929944387236e-34f) >> 13; // 2^-112
        int sign = y < 0.0f ? 0x8000 : 0;
        bits = static_cast<unsigned short>(y == y ? sign | size : 0x7e00);
#endif
        return *this;
    }
};
template <bool HALF> struct StoredType { typedef float T; };
template <> struct StoredType<true> { typedef Half T; };
template <unsigned EFFECTS> using Stored = typename StoredType<(EFFECTS & EFFECT_HALF_STORAGE) != 0>::T;
// A value as memory would give it back.
template <unsigned EFFECTS> FN float to_stored_as(float x) { return (EFFECTS & EFFECT_HALF_STORAGE) != 0 ? half_of(x) : x; }
#define to_stored(X) to_stored_as<EFFECTS>(X)
#endif
