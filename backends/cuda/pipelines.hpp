// Pipelines: a stage's kernel for a mask and a group size.
#pragma once
#include "backends/cuda/context.hpp"
#include <vector>

namespace wadi::cuda {

struct StagePipeline {
    int stage = -1;
    std::uint32_t effects = 0; // those that the stage tests
    int group_x = 0, group_y = 0;
    bool active_tiles = false;
    const void* kernel = nullptr;
};

class Pipelines {
  public:
    explicit Pipelines(Context& context) : c_(context) {}
    /// Errors: bad_argument (stage, group size), not_supported (no code for this GPU), out_of_memory.
    Result<compute::Pipeline> create(int stage, std::uint32_t effects, compute::GroupSize group);
    /// Null for a handle that was never given out.
    const StagePipeline* find(compute::Pipeline pipeline) const;

  private:
    Context& c_;
    std::vector<StagePipeline> pipelines_; // handle id - 1 is the place
};

} // namespace wadi::cuda
