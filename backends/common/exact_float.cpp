#include "backends/common/exact_float.hpp"
#include <cmath>
#include <cstdint>

namespace wadi::backends {

namespace {

// Quotients as near to the middle between two floats as quotients come, where the smallest error rounds the wrong way: Q is odd
// and has 25 bits, and a = (Q b - s) / 2^25 is whole, so that a/b = (Q - s/b) / 2^25 with s = +-1.
Operands hard_quotient(std::uint64_t random) {
    const std::uint64_t modulus = std::uint64_t{1} << 25;
    for (std::uint64_t b = (random & 0x7fffffu) | 0x800001u;; b += 2) {
        if (b >= std::uint64_t{1} << 24) b = 0x800001u;
        std::uint64_t inverse = b; // of b modulo 2^25: each round doubles the bits that are right
        for (int round = 0; round < 5; ++round) inverse = inverse * (2 - b * inverse) % modulus;
        const bool minus = (random >> 40 & 1u) != 0;
        const std::uint64_t q = minus ? (modulus - inverse) % modulus : inverse;
        if (q < modulus / 2) continue; // a float, not the middle between two
        const std::uint64_t a = (minus ? q * b + 1 : q * b - 1) / modulus;
        return {static_cast<float>(a), static_cast<float>(b)};
    }
}

// Radicands whose roots come as near to that: of 1 + k 2^-23 and 4 (1 - k 2^-24), k odd, they miss it by k^2 2^-26 of the last
// place. What strains a little roots them all the time.
float hard_root(std::uint64_t random) {
    const float k = static_cast<float>(2 * (random & 15u) + 1);
    const float mantissa = (random >> 4 & 1u) != 0 ? 1.0f + k * 0x1p-23f : 4.0f * (1.0f - k * 0x1p-24f);
    return std::ldexp(mantissa, 2 * (static_cast<int>(random >> 5 & 31u) - 16));
}

// One of them of the size of 2^exponent, up to the ends of what stages divide and root, and the other so that neither product nor
// quotient leaves the range of the functions.
Operands far_out(float a, float b, int exponent, bool root) {
    if (root) return {std::ldexp(a, exponent / 5), std::ldexp(std::fabs(b), exponent)};
    return {std::ldexp(a, exponent), std::ldexp(std::fabs(b), exponent / 5)};
}

} // namespace

// Random mantissas with exponents that no result of the test takes out of the normal range, since devices may flush
// denormals (stages keep them out). The generator is splitmix64: the same values everywhere.
std::vector<Operands> exact_float_operands() {
    std::uint64_t state = 1;
    const auto random = [&state] {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t bits = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        return bits ^ (bits >> 31);
    };
    const auto draw = [&random](int exponents) {
        const std::uint64_t bits = random();
        const float mantissa = 1.0f + static_cast<float>(bits & 0x7fffffu) * 0x1p-23f;
        const int exponent = static_cast<int>((bits >> 32) % static_cast<std::uint64_t>(2 * exponents)) - exponents;
        return std::ldexp((bits >> 31 & 1u) != 0 ? -mantissa : mantissa, exponent);
    };
    std::vector<Operands> operands(exact_float_tries);
    for (std::size_t n = 0; n < exact_float_tries; ++n) {
        // A quarter of the pairs are far apart, the others as close as the terms of one equation are.
        const int exponents = n % 4 == 0 ? 40 : 6;
        operands[n].a = n % 64 == 0 ? 0.0f : n % 64 == 2 ? -0.0f : draw(exponents);
        operands[n].b = std::fabs(draw(exponents));
        if (n % 16 == 8) operands[n] = far_out(draw(6), draw(6), static_cast<int>(random() % 173) - 74, (random() & 1u) != 0);
        if (n % 16 == 4) operands[n].b = hard_root(random());
        if (n % 2 == 1) operands[n] = hard_quotient(random());
    }
    return operands;
}

// Rounds after every operation: contraction is off in the whole build.
std::vector<float> exact_float_results(const std::vector<Operands>& operands) {
    std::vector<float> results;
    results.reserve(operands.size() * exact_float_results_per_try);
    for (const auto& [a, b] : operands) {
        const float product = a * b;
        results.insert(results.end(), {a + b, a - b, product, product + a, a / b, std::sqrt(b), std::fabs(a) / b, std::sqrt(b)});
    }
    return results;
}

std::string inexact_float_warning(const std::string& device) {
    return device + " does not compute + - * / sqrt as the CPU does; results will differ in their last bits";
}

} // namespace wadi::backends
