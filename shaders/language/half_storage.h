// 16-bit floats of buffers of type float_or_half (NUMERICS 2.17), for all three languages. What is stored is rounded by half_of, in
// fused stages also where it stays in a register, so that every backend and every way to run a step has the same bits.

// The nearest 16-bit float (IEEE binary16), ties to even, its denormals included; at most 65504, NaN stays.
FN float half_of(float x) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    float y;
    asm("{ .reg .f32 t; .reg .b16 h; min.NaN.f32 t, %1, 0f477FE000; max.NaN.f32 t, t, 0fC77FE000; cvt.rn.f16.f32 h, t; cvt.f32.f16 %0, h; }"
        : "=f"(y) : "f"(x));
    return y + 0.0f; // no negative zero
#else
    float y = x > 65504.0f ? 65504.0f : x;
    y = y < -65504.0f ? -65504.0f : y;
    int bits = float_bits(y);
    float normal = bits_float((bits + 4095 + ((bits >> 13) & 1)) & ~8191);
    float tiny = (y + 0.75f) - 0.75f; // floats in [1/2, 1) are 2^-24 apart, as denormals of 16 bits are
    return wabs(y) < 6.103515625e-05f ? tiny : normal;
#endif
}
#ifndef WADI_GLSL

// One 16-bit float in memory.
struct Half {
    unsigned short bits;
    // From a value of half_of: nothing is left to round.
    HELPER explicit Half(float y) {
#ifdef __CUDA_ARCH__
        asm("cvt.rn.f16.f32 %0, %1;" : "=h"(bits) : "f"(y));
#else
        int size = float_bits(wabs(y) * 1.925929944387236e-34f) >> 13; // 2^-112
        int sign = y < 0.0f ? 0x8000 : 0;
        bits = static_cast<unsigned short>(y == y ? sign | size : 0x7e00);
#endif
    }
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
        return *this = Half(half_of(x));
    }
};
template <bool HALF> struct StoredType { typedef float T; };
template <> struct StoredType<true> { typedef Half T; };
template <unsigned EFFECTS> using Stored = typename StoredType<(EFFECTS & EFFECT_HALF_STORAGE) != 0>::T;
// A value as memory would give it back.
template <unsigned EFFECTS> FN float to_stored_as(float x) { return (EFFECTS & EFFECT_HALF_STORAGE) != 0 ? half_of(x) : x; }
#define to_stored(X) to_stored_as<EFFECTS>(X)
#endif
