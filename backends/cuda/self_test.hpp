// Whether this GPU computes as the CPU does, with the very operations of the stage language.
#pragma once
#include "backends/cuda/context.hpp"

namespace wadi::cuda {

/// Compares the pairs of backends/common/exact_float.hpp bit for bit, then reciprocal, roots and the hardest quotients of every
/// significand with the device's own, and sets capabilities.exact_float; logs a warning where they differ.
Status run_self_test(Context& context);

/// Defined in the .cu file: void (const Operands* operands, float* results, unsigned tries).
const void* self_test_kernel();
/// void (unsigned* wrong), a thread per significand of 24 bits: adds how many are wrong.
const void* significands_kernel();

} // namespace wadi::cuda
