// The kernels of self_test.cpp: every operation that stages rely on, through the prelude that stages use.
namespace wadi_self_test_cuda {
#include "language/stage_cuda.h"

struct Operands {
    float a, b;
};

__global__ void run(const Operands* operands, float* results, unsigned tries) {
    const unsigned n = blockIdx.x * blockDim.x + threadIdx.x;
    if (n >= tries) return;
    const float a = operands[n].a;
    const float b = operands[n].b;
    float* r = results + 8 * n; // exact_float_results_per_try
    r[0] = a + b;
    r[1] = a - b;
    r[2] = a * b;
    r[3] = a * b + a; // differs if contracted
    r[4] = wdiv(a, b);
    r[5] = wsqrt(b);
    r[6] = lean_quotient(wabs(a), b);
    r[7] = lean_root(b);
}

__device__ bool differs(float got, float wanted) { return float_bits(got) != float_bits(wanted); }

// The prelude's quotient of significands a / b against the device's own, which rounds correctly.
__device__ bool wrong_quotient(float a, float b) {
    const float wanted = __fdiv_rn(a, b);
    return differs(lean_quotient(a, b), wanted) || differs(wdiv(a, b), wanted) || differs(wdiv(-a, b), -wanted);
}

// Quotients a/b = (q + c/b)/2^e of significands b and a, q/2^e being in the middle between two floats and 0 < |c| <= furthest:
// what lies further away an error of 3 2^-24 of the last place cannot round wrongly (c = 6; stage_cuda.h). With b = 2^t odd, 2^t
// divides c, and q is found by the inverse of odd modulo 2^(e - t).
__device__ unsigned wrong_quotients_by(uint b) {
    constexpr int furthest = 8;
    const int t = __ffs(static_cast<int>(b)) - 1;
    const uint odd = b >> t;
    uint inverse = odd; // each round doubles the bits that are right
    for (int round = 0; round < 5; ++round) inverse *= 2u - odd * inverse;
    unsigned wrong = 0;
    for (int e = 24; e <= 25; ++e)
        for (int c = -(furthest >> t); c <= furthest >> t; ++c) {
            if (c % 2 == 0) continue;
            const uint period = 1u << (e - t);
            for (uint q = (static_cast<uint>(-c) * inverse) % period; q < 1u << 25; q += period) {
                const long long scaled = static_cast<long long>(b) * q + c * (1 << t);
                const long long a = scaled >> e;
                if (q >= 1u << 24 && a >= 1 << 23 && a < 1 << 24)
                    wrong += wrong_quotient(static_cast<float>(a), static_cast<float>(b)) ? 1u : 0u;
            }
        }
    return wrong;
}

// One thread per significand: its reciprocal, its roots with even and odd exponent, and the quotients by it that are hardest to
// round.
__global__ void run_significands(unsigned* wrong) {
    const uint b = (1u << 23) + blockIdx.x * blockDim.x + threadIdx.x;
    const float value = static_cast<float>(b), twice = 2.0f * value;
    unsigned mine = wrong_quotients_by(b);
    mine += differs(lean_reciprocal(value), __frcp_rn(value)) ? 1u : 0u;
    mine += differs(lean_root(value), __fsqrt_rn(value)) || differs(lean_root(twice), __fsqrt_rn(twice)) ? 1u : 0u;
    mine += differs(wsqrt(value), __fsqrt_rn(value)) || differs(wsqrt(twice), __fsqrt_rn(twice)) ? 1u : 0u;
    if (mine > 0) atomicAdd(wrong, mine);
}
} // namespace wadi_self_test_cuda

namespace wadi::cuda {
const void* self_test_kernel();
const void* significands_kernel();
const void* significands_kernel() { return reinterpret_cast<const void*>(&wadi_self_test_cuda::run_significands); }
const void* self_test_kernel() { return reinterpret_cast<const void*>(&wadi_self_test_cuda::run); }
} // namespace wadi::cuda
