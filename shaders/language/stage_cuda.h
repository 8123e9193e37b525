// Prelude of the stage language for CUDA. Included inside a namespace of its own; __fdiv_rn and __fsqrt_rn are the
// correctly rounded forms whatever the compiler's flags, contraction is off by -fmad=false.

struct alignas(8) vec2 { float x, y; };
struct alignas(16) vec4 { float x, y, z, w; };
typedef unsigned int uint;

#define FN static __device__ __forceinline__
#define REF(T) T&
#include "../effects.h"
#include "../step_params.h"

#define STAGE(NAME)                                                                                                    \
    template <unsigned EFFECTS> struct NAME {                                                                          \
        WorldParams P;                                                                                                 \
        const StepInput& S;
#define EXTENT(KIND)
#define REACH(CELLS)
#define FAR_IF(BITS)
#define END_STAGE                                                                                                      \
    }                                                                                                                  \
    ;
#define HELPER __device__ __forceinline__
#define HELPER_CONST const
#define KERNEL __device__ __forceinline__ void kernel(int i, int j) const
#define IN(SLOT, T, NAME) const T* __restrict__ NAME;
#define OUT(SLOT, T, NAME) T* __restrict__ NAME;
#define INOUT(SLOT, T, NAME) T* __restrict__ NAME;
#define IN_IF(BITS, SLOT, T, NAME) IN(SLOT, T, NAME)
#define OUT_IF(BITS, SLOT, T, NAME) OUT(SLOT, T, NAME)
#define INOUT_IF(BITS, SLOT, T, NAME) INOUT(SLOT, T, NAME)
#define HAS(BITS) ((EFFECTS & (BITS)) == (BITS))
#define UNIFORM(C) (C)
#define IDX(I, J) (((J) + GHOST) * P.pitch + (I) + LEAD)

#ifdef WADI_RELAXED_FLOAT
FN float wdiv(float a, float b) { return a / b; }
FN float wsqrt(float x) { return sqrtf(x); }
FN float lean_quotient(float a, float b) { return a / b; }
FN float lean_reciprocal(float b) { return 1.0f / b; }
FN float lean_root(float x) { return sqrtf(x); }
#else
// As __fdiv_rn and __fsqrt_rn round, without their branches: a sixth of a fused stage's code. A reciprocal and a quotient, each
// corrected by a residual from fused multiply-adds (P. Markstein 1990). Every reciprocal is then rounded correctly, and of a quotient
// only what lies within three units of 2^-24 of the last place from the middle of two floats could be wrong: the self-test tries all of
// them, on each device. The powers of two keep residuals of small operands normal; what they leave out is dividends, quotients and
// radicands beyond 3e32 and divisors beyond 8e37: stages bound what they divide and root by 1e30.
FN float lean_reciprocal(float b) {
    float reciprocal;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(reciprocal) : "f"(b));
    return fmaf(fmaf(-b, reciprocal, 1.0f), reciprocal, reciprocal);
}
FN float wdiv(float a, float b) {
    const float reciprocal = lean_reciprocal(b), scaled = a * 1048576.0f; // 2^20
    const float near = scaled * reciprocal;
    float q = fmaf(fmaf(-b, near, scaled), reciprocal, near);
    q = fabsf(q) < 3.0e38f && q != 0.0f ? q : near; // infinities, and zeros with their sign
    return q * 9.53674316e-7f;                      // 2^-20
}
FN float wsqrt(float x) {
    const float scaled = x * 1048576.0f;
    float inverse;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(scaled));
    float s = scaled * inverse;
    s = fmaf(fmaf(-s, s, scaled), 0.5f * inverse, s);
    return x > 0.0f ? s * 9.765625e-4f : x; // 2^-10
}
// The same bits in half of the instructions where no residual can underflow (shaders/README: ranges).
FN float lean_quotient(float a, float b) {
    const float reciprocal = lean_reciprocal(b), near = a * reciprocal;
    return fmaf(fmaf(-b, near, a), reciprocal, near);
}
FN float lean_root(float x) {
    float inverse;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(x));
    const float near = x * inverse;
    return fmaf(fmaf(-near, near, x), 0.5f * inverse, near);
}
#endif
FN float wabs(float x) { return fabsf(x); }
#define HAS_MIN_MAX // one instruction each; which of two zeros wins reaches no stored bit (shaders/README, rule 11)
FN float wmin(float a, float b) { return fminf(a, b); }
FN float wmax(float a, float b) { return fmaxf(a, b); }
FN float wtrunc(float x) { return truncf(x); }
FN float wfloor(float x) { return floorf(x); }
FN int float_bits(float x) { return __float_as_int(x); }
FN float bits_float(int x) { return __int_as_float(x); }
FN bool both(bool a, bool b) { return a && b; }
FN bool either(bool a, bool b) { return a || b; }
FN float choose(bool c, float a, float b) { return c ? a : b; }
