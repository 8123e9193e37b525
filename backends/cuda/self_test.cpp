#include "backends/cuda/self_test.hpp"
#include "backends/common/exact_float.hpp"
#include "backends/cuda/memory.hpp"
#include <cstring>

namespace wadi::cuda {
namespace {

constexpr unsigned group_threads = 256;

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
        const cudaError_t r = cudaLaunchKernel(self_test_kernel(), dim3(backends::exact_float_tries / group_threads),
                                               dim3(group_threads), arguments, 0, c.stream);
        if (Status s = c.check(r, "cudaLaunchKernel", "self-test"); !s) return s;
        return copy_out(c, results, 0, std::as_writable_bytes(got));
    }
};

} // namespace

Status run_self_test(Context& c) {
    const auto operands = backends::exact_float_operands();
    const auto wanted = backends::exact_float_results(operands);
    std::vector<float> got(wanted.size());
    SelfTest test{c, {}, {}};
    if (Status s = test.run(operands, got); !s) return s;
    c.capabilities.exact_float = std::memcmp(got.data(), wanted.data(), got.size() * sizeof(float)) == 0;
    if (!c.capabilities.exact_float) c.log(1, backends::inexact_float_warning(c.capabilities.name));
    return ok_status();
}

} // namespace wadi::cuda
