#include "backends/cuda/pipelines.hpp"
#include "backends/cuda/stages.hpp"
#include "shaders/stage_table.hpp"

namespace wadi::cuda {

Result<compute::Pipeline> Pipelines::create(int stage, std::uint32_t effects, compute::GroupSize group) {
    const auto place = static_cast<std::size_t>(stage);
    const auto& info = compute::stage_table()[place];
    const StagePipeline made{group.x, group.y,
                             group.tile > 0 ? active_kernels()[place](effects) : kernels()[place](effects, group.x, group.y)};
    if (made.kernel == nullptr) {
        return error(Code::internal,
                     "stage " + std::string(info.name) + " has no kernel for the effects " + std::to_string(effects));
    }
    // Loads the code now, not in the first step, and finds out whether this GPU has any.
    cudaFuncAttributes attributes{};
    if (Status s = c_.check(cudaFuncGetAttributes(&attributes, made.kernel), "loading the kernel", info.name); !s) return s;
    if (made.group_x * made.group_y > attributes.maxThreadsPerBlock) {
        return error(Code::not_supported, "stage " + std::string(info.name) + " runs with at most " +
                                              std::to_string(attributes.maxThreadsPerBlock) + " threads a group on " +
                                              c_.capabilities.name + ", " + std::to_string(made.group_x * made.group_y) +
                                              " were asked for");
    }
    pipelines_.push_back(made);
    return compute::Pipeline{static_cast<std::uint32_t>(pipelines_.size())};
}

} // namespace wadi::cuda
