#include "backends/cuda/self_test.hpp"
#include "backends/common/exact_float.hpp"
#include "backends/cuda/memory.hpp"
#include <cstring>

namespace wadi::cuda {
namespace {

constexpr unsigned group_threads = 256, significands = 1u << 23;

using backends::Operands;

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
        unsigned count = backends::exact_float_tries;
        void* arguments[] = {&operands.data, &results.data, &count};
        if (Status s = launch(self_test_kernel(), backends::exact_float_tries, arguments); !s) return s;
        return copy_out(c, results, 0, std::as_writable_bytes(got));
    }

    /// How many significands have a wrong reciprocal, root or quotient; after run().
    Result<unsigned> wrong_significands() {
        unsigned wrong = 0;
        if (Status s = copy_in(c, results, 0, std::as_bytes(std::span(&wrong, 1))); !s) return s;
        void* arguments[] = {&results.data};
        if (Status s = launch(significands_kernel(), significands, arguments); !s) return s;
        if (Status s = copy_out(c, results, 0, std::as_writable_bytes(std::span(&wrong, 1))); !s) return s;
        return wrong;
    }

    Status launch(const void* kernel, unsigned threads, void** arguments) {
        const cudaError_t r =
            cudaLaunchKernel(kernel, dim3(threads / group_threads), dim3(group_threads), arguments, 0, c.stream);
        return c.check(r, "cudaLaunchKernel", "self-test");
    }
};

} // namespace

Status run_self_test(Context& c) {
    const auto operands = backends::exact_float_operands();
    const auto wanted = backends::exact_float_results(operands);
    std::vector<float> got(wanted.size());
    SelfTest test{c, {}, {}};
    if (Status s = test.run(operands, got); !s) return s;
    const auto wrong = test.wrong_significands();
    if (!wrong) return wrong.status();
    c.capabilities.exact_float = *wrong == 0 && std::memcmp(got.data(), wanted.data(), got.size() * sizeof(float)) == 0;
    if (!c.capabilities.exact_float) c.log(1, backends::inexact_float_warning(c.capabilities.name));
    return ok_status();
}

} // namespace wadi::cuda
