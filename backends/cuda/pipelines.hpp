// Pipelines: a stage's kernel for a mask and a group size.
#pragma once
#include "backends/cuda/context.hpp"
#include <vector>

namespace wadi::cuda {

struct StagePipeline {
    int group_x = 0, group_y = 0;
    const void* kernel = nullptr;
};

class Pipelines {
  public:
    explicit Pipelines(Context& context) : c_(context) {}
    /// Errors: not_supported (no code for this GPU), out_of_memory.
    Result<compute::Pipeline> create(int stage, std::uint32_t effects, compute::GroupSize group);
    const StagePipeline& at(compute::Pipeline pipeline) const { return pipelines_[pipeline.id - 1]; }

  private:
    Context& c_;
    std::vector<StagePipeline> pipelines_; // handle id - 1 is the place
};

} // namespace wadi::cuda
