// The self-test of devices: operands, and what a processor makes of them. Whoever gets other bits is not exact.
#pragma once
#include <string>
#include <vector>

namespace wadi::backends {

struct Operands {
    float a, b; // any sign; positive
};

inline constexpr unsigned exact_float_tries = 16384;

/// Of each pair, in this order: a + b, a - b, a * b, a * b + a in two roundings, a / b, sqrt(b), and the lean forms of |a| /
/// b and sqrt(b).
inline constexpr unsigned exact_float_results_per_try = 8;

/// Random pairs, half of them quotients and a sixteenth roots that are hard to round; the same on every machine.
std::vector<Operands> exact_float_operands();
std::vector<float> exact_float_results(const std::vector<Operands>& operands);

/// For the log of a device that is not exact.
std::string inexact_float_warning(const std::string& device);

} // namespace wadi::backends
