#include "backends/cuda/self_test.hpp"
#include "backends/cuda/memory.hpp"
#include <cmath>
#include <cstring>

namespace wadi::cuda {
namespace {

constexpr unsigned tries = 16384;
constexpr unsigned group_threads = 256;

// Random mantissas with exponents that no result of the test takes out of the normal range, since stages keep denormals
// out. The generator is splitmix64: the same values everywhere.
std::vector<Operands> make_operands() {
    std::uint64_t state = 1;
    const auto draw = [&state](int exponents) {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t bits = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        bits ^= bits >> 31;
        const float mantissa = 1.0f + static_cast<float>(bits & 0x7fffffu) * 0x1p-23f;
        const int exponent = static_cast<int>((bits >> 32) % static_cast<std::uint64_t>(2 * exponents)) - exponents;
        return std::ldexp((bits >> 31 & 1u) != 0 ? -mantissa : mantissa, exponent);
    };
    std::vector<Operands> operands(tries);
    for (unsigned n = 0; n < tries; ++n) {
        // A quarter of the pairs are far apart, the others as close as the terms of one equation are.
        const int exponents = n % 4 == 0 ? 40 : 6;
        operands[n].a = n % 64 == 1 ? 0.0f : n % 64 == 2 ? -0.0f : draw(exponents);
        operands[n].b = std::fabs(draw(exponents));
    }
    return operands;
}

// Rounds after every operation: contraction is off in the whole build.
std::vector<float> expected(const std::vector<Operands>& operands) {
    std::vector<float> results;
    results.reserve(operands.size() * results_per_try);
    for (const auto& [a, b] : operands) {
        const float product = a * b;
        results.insert(results.end(), {a + b, a - b, product, product + a, a / b, std::sqrt(b)});
    }
    return results;
}

struct SelfTest {
    Context& c;
    Memory operands, results;

    ~SelfTest() {
        release(c, operands);
        release(c, results);
    }

    Status run(std::span<const Operands> values, std::span<float> got) {
        auto in = allocate(c, values.size_bytes(), "self-test operands");
        if (!in) return in.status();
        operands = std::move(*in);
        auto out = allocate(c, got.size_bytes(), "self-test results");
        if (!out) return out.status();
        results = std::move(*out);
        if (Status s = copy_in(c, operands, 0, std::as_bytes(values)); !s) return s;
        unsigned count = tries;
        void* arguments[] = {&operands.data, &results.data, &count};
        const cudaError_t r =
            cudaLaunchKernel(self_test_kernel(), dim3(tries / group_threads), dim3(group_threads), arguments, 0, c.stream);
        if (Status s = c.check(r, "cudaLaunchKernel", "self-test"); !s) return s;
        return copy_out(c, results, 0, std::as_writable_bytes(got));
    }
};

} // namespace

Status run_self_test(Context& c) {
    const std::vector<Operands> operands = make_operands();
    const std::vector<float> wanted = expected(operands);
    std::vector<float> got(wanted.size());
    SelfTest test{c, {}, {}};
    if (Status s = test.run(operands, got); !s) return s;
    c.capabilities.exact_float = std::memcmp(got.data(), wanted.data(), got.size() * sizeof(float)) == 0;
    if (!c.capabilities.exact_float) {
        c.log(1, c.capabilities.name + " does not compute + - * / sqrt as the CPU does; results will differ in their last bits");
    }
    return ok_status();
}

} // namespace wadi::cuda
