#include "backends/cuda/pipelines.hpp"
#include "backends/cuda/stages.hpp"
#include "engine/compute/stage_table.hpp"
#include <algorithm>

namespace wadi::cuda {
namespace {

// Threads of a group where the caller leaves it open: 64x4 suits stencils (GPU measurements), rim stages have one row.
// Both are among the sizes that stagec compiles for.
Result<compute::GroupSize> choose_group(const compute::StageInfo& info, compute::GroupSize asked) {
    compute::GroupSize group = info.extent == compute::Extent::rim ? compute::GroupSize{256, 1} : compute::GroupSize{64, 4};
    if (asked.tile > 0) { // active_kernels() are compiled for groups of at most 256 threads
        if (info.extent != compute::Extent::rim) group = {asked.tile, std::min(asked.tile, 256 / asked.tile)};
        asked = {};
    }
    if (info.fused())
        asked = {int{compute::fused_group_x}, int{compute::fused_group_y}, 0}; // the only groups that it is written for
    if (asked.x > 0) group.x = asked.x;
    if (asked.y > 0) group.y = asked.y;
    const bool negative = asked.x < 0 || asked.y < 0;
    if (!negative && group.x <= largest_group && group.y <= largest_group / group.x) return group;
    return error(Code::bad_argument, "group size of stage " + std::string(info.name) + " is " + std::to_string(asked.x) + " x " +
                                         std::to_string(asked.y) + "; allowed are 0 to " + std::to_string(largest_group) +
                                         " each and at most " + std::to_string(largest_group) + " threads in all");
}

} // namespace

Result<compute::Pipeline> Pipelines::create(int stage, std::uint32_t effects, compute::GroupSize asked) {
    const auto table = compute::stage_table();
    if (stage < 0 || stage >= static_cast<int>(table.size())) {
        return error(Code::bad_argument, "stage index " + std::to_string(stage) + " is outside 0 to " +
                                             std::to_string(static_cast<int>(table.size()) - 1));
    }
    const compute::StageInfo& info = table[static_cast<std::size_t>(stage)];
    auto group = choose_group(info, asked);
    if (!group) return group.status();
    StagePipeline made{stage, effects & info.tested_effects, group->x, group->y, asked.tile > 0, nullptr};
    const auto same = [&](const StagePipeline& p) {
        return p.stage == made.stage && p.effects == made.effects && p.group_x == made.group_x && p.group_y == made.group_y &&
               p.active_tiles == made.active_tiles;
    };
    const auto known = std::find_if(pipelines_.begin(), pipelines_.end(), same);
    if (known != pipelines_.end()) return compute::Pipeline{static_cast<std::uint32_t>(known - pipelines_.begin()) + 1};

    made.kernel = made.active_tiles ? active_kernels()[static_cast<std::size_t>(stage)](made.effects)
                                    : kernels()[static_cast<std::size_t>(stage)](made.effects, made.group_x, made.group_y);
    if (made.kernel == nullptr && made.active_tiles && !info.marks)
        return error(Code::bad_argument, "stage " + std::string(info.name) + " cannot run over active tiles");
    if (made.kernel == nullptr) {
        return error(Code::internal,
                     "stage " + std::string(info.name) + " has no kernel for the effects " + std::to_string(made.effects));
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

const StagePipeline* Pipelines::find(compute::Pipeline pipeline) const {
    return pipeline.id == 0 || pipeline.id > pipelines_.size() ? nullptr : &pipelines_[pipeline.id - 1];
}

} // namespace wadi::cuda
