// The kernel of self_test.cpp: every operation that stages rely on, through the prelude that stages use.
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
} // namespace wadi_self_test_cuda

namespace wadi::cuda {
const void* self_test_kernel();
const void* self_test_kernel() { return reinterpret_cast<const void*>(&wadi_self_test_cuda::run); }
} // namespace wadi::cuda
