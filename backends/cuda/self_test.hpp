// Whether this GPU computes as the CPU does, with the very operations of the stage language.
#pragma once
#include "backends/cuda/context.hpp"

namespace wadi::cuda {

struct Operands {
    float a, b; // any sign; positive
};

/// Results per pair of operands: a + b, a - b, a * b, a * b + a, a / b, sqrt(b).
inline constexpr unsigned results_per_try = 6;

/// Compares 16384 random pairs bit for bit and sets capabilities.exact_float; logs a warning where they differ.
Status run_self_test(Context& context);

/// Defined in the .cu file: void (const Operands* operands, float* results, unsigned tries).
const void* self_test_kernel();

} // namespace wadi::cuda
