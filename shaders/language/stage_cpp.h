// Prelude of the stage language for C++. Included inside a namespace of its own per instruction set, so that
// code compiled for a higher one shares no inline function with baseline code: it must include no standard header.
// WADI_STAGE_CHECKED (debug builds) checks every index against the buffer's size.

struct alignas(8) vec2 { float x, y; };
struct alignas(16) vec4 { float x, y, z, w; };
typedef unsigned int uint;

// Vector code needs each function inside its loop. What is there to be checked, or for masks that vector code lacks, compiles in a
// quarter of the time with calls.
#ifdef WADI_STAGE_CALLS
#define HELPER
#define FN [[maybe_unused]] static
#define LEAF [[maybe_unused]] static inline __attribute__((always_inline)) // less code than a call of it
#else
#define HELPER inline __attribute__((always_inline))
#define FN static HELPER
#define LEAF FN
#endif
#define REF(T) T&
#include "../effects.h"
#include "../step_params.h"

#ifdef WADI_STAGE_CHECKED
[[noreturn]] void stage_index_error(const char* stage, const char* buffer, long index, unsigned long long size);
template <class T> struct StageBuffer {
    T* data;
    unsigned long long size;
    const char* stage;
    const char* name;
    inline __attribute__((always_inline)) T& operator[](long index) const {
        if (index < 0 || static_cast<unsigned long long>(index) >= size) stage_index_error(stage, name, index, size);
        return data[index];
    }
};
#define WADI_BUFFER(T) StageBuffer<T>
#else
#define WADI_BUFFER(T) T* __restrict
#endif

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
#define HELPER_CONST const
#define KERNEL HELPER void kernel([[maybe_unused]] int i, [[maybe_unused]] int j) const
#define IN(SLOT, T, NAME) WADI_BUFFER(const T) NAME;
#define OUT(SLOT, T, NAME) WADI_BUFFER(T) NAME;
#define INOUT(SLOT, T, NAME) WADI_BUFFER(T) NAME;
#define IN_IF(BITS, SLOT, T, NAME) IN(SLOT, T, NAME)
#define OUT_IF(BITS, SLOT, T, NAME) OUT(SLOT, T, NAME)
#define INOUT_IF(BITS, SLOT, T, NAME) INOUT(SLOT, T, NAME)
#define HAS(BITS) ((EFFECTS & (BITS)) == (BITS))
#define IDX(I, J) (((J) + GHOST) * P.pitch + (I) + LEAD)
#define UNIFORM(C) true // a branch would keep the loop over i from vectorising
#ifdef WADI_GPU_DIVISION // for tests: beyond the ranges of the functions what stage_cuda.h computes there, so that no GPU is needed to find such operands
FN float fused(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
FN float no_denormal(float x) { return __builtin_fabsf(x) < 1.17549435e-38f ? __builtin_copysignf(0.0f, x) : x; }
FN float reciprocal_of(float b) {
    float r = no_denormal(1.0f / no_denormal(b));
    return fused(fused(-b, r, 1.0f), r, r);
}
FN float root_of(float x) {
    float inverse = 1.0f / __builtin_sqrtf(no_denormal(x));
    float s = x * inverse;
    return fused(fused(-s, s, x), 0.5f * inverse, s);
}
FN bool in_range(float x) { return x == 0.0f || (__builtin_fabsf(x) > 1.0e-30f && __builtin_fabsf(x) < 1.0e30f); }
FN float lean_quotient(float a, float b) {
    float reciprocal = reciprocal_of(b);
    float near = a * reciprocal;
    float q = fused(fused(-b, near, a), reciprocal, near);
    return in_range(a) && in_range(b) && in_range(a / b) ? a / b : q;
}
FN float lean_reciprocal(float b) { return in_range(b) ? 1.0f / b : reciprocal_of(b); }
FN float lean_root(float x) { return in_range(x) && x != 0.0f ? __builtin_sqrtf(x) : root_of(x); }
FN float wdiv(float a, float b) {
    float reciprocal = reciprocal_of(b);
    float scaled = a * 1048576.0f;
    float near = scaled * reciprocal;
    float q = fused(fused(-b, near, scaled), reciprocal, near);
    q = (__builtin_fabsf(q) < 3.0e38f && q != 0.0f ? q : near) * 9.53674316e-7f;
    return in_range(a) && in_range(b) && in_range(a / b) ? a / b : q;
}
FN float wsqrt(float x) {
    float s = in_range(x) ? __builtin_sqrtf(x) : root_of(x * 1048576.0f) * 9.765625e-4f;
    return x > 0.0f ? s : x;
}
#else
LEAF float wdiv(float a, float b) { return a / b; }
LEAF float wsqrt(float x) { return __builtin_sqrtf(x); }
LEAF float lean_quotient(float a, float b) { return a / b; }
LEAF float lean_reciprocal(float b) { return lean_quotient(1.0f, b); }
LEAF float lean_root(float x) { return __builtin_sqrtf(x); }
#endif
#ifdef WADI_STAGE_CALLS
#define HAS_MIN_MAX // as in scalar.glsl
LEAF float wmin(float a, float b) { return b < a ? b : a; }
LEAF float wmax(float a, float b) { return a < b ? b : a; }
#endif
LEAF float wabs(float x) { return __builtin_fabsf(x); }
LEAF float wtrunc(float x) { return __builtin_truncf(x); }
LEAF float wfloor(float x) { return __builtin_floorf(x); }
LEAF int float_bits(float x) { int r; __builtin_memcpy(&r, &x, 4); return r; }
LEAF float bits_float(int x) { float r; __builtin_memcpy(&r, &x, 4); return r; }
// Without short circuits: a branch inside a stage would stop the loop from vectorising.
LEAF bool both(bool a, bool b) { return static_cast<bool>(static_cast<int>(a) & static_cast<int>(b)); }
LEAF bool either(bool a, bool b) { return static_cast<bool>(static_cast<int>(a) | static_cast<int>(b)); }
// By bits: behind a condition g++ would sink the load of a or b, and the row would not vectorise.
LEAF float choose(bool c, float a, float b) {
    int mask = -static_cast<int>(c);
    return bits_float((float_bits(a) & mask) | (float_bits(b) & ~mask));
}
