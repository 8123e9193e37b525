// From operations to CUDA calls: handles resolved, grids computed, and for each call those that it must wait for.
#pragma once
#include "backends/cuda/memory.hpp"
#include "backends/cuda/pipelines.hpp"
#include "engine/compute/program.hpp"
#include <array>
#include <variant>
#include <vector>

namespace wadi::cuda {

struct KernelCall {
    const void* kernel;
    dim3 groups, threads;
    std::vector<void*> slots;           // device addresses; null where the condition is off
    std::array<const void*, 3> tiles{}; // list, count and activity of active tiles; null without
    std::size_t input = 0;              // of the submission
};
struct CopyCall {
    void* to;
    const void* from;
    std::size_t bytes;
};
struct FillCall {
    void* to;
    std::size_t words;
    std::uint32_t word;
};
struct TimestampCall {
    std::size_t number; // among the program's timestamps
};
struct NoCall {}; // an operation over nothing: it keeps its place among the edges
using Call = std::variant<KernelCall, CopyCall, FillCall, TimestampCall, NoCall>;

struct Plan {
    std::vector<Call> calls;             // one per operation
    std::vector<std::vector<int>> waits; // for each call the earlier calls it waits for
};

/// Errors: not_supported (too many groups).
Result<Plan> plan_calls(const Context& context, const Buffers& buffers, const Pipelines& pipelines,
                        const compute::ProgramBuilder& builder);

} // namespace wadi::cuda
