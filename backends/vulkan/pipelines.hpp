// Compute pipelines: one layout per stage, one pipeline per stage, mask of tested effects and group size.
#pragma once
#include "backends/vulkan/context.hpp"
#include <vector>

namespace wadi::vulkan {

/// Bindings of every stage: the two parameter blocks, then one storage buffer per slot.
inline constexpr std::uint32_t world_binding = 0;
inline constexpr std::uint32_t input_binding = 1;
inline constexpr std::uint32_t first_slot_binding = 2;

/// A set layout: `uniforms` uniform buffers from binding 0, then `storage` storage buffers.
Result<VkDescriptorSetLayout> create_set_layout(Context& context, std::uint32_t uniforms, std::uint32_t storage,
                                                std::string_view label);
Result<VkPipelineLayout> create_pipeline_layout(Context& context, VkDescriptorSetLayout set, std::string_view label);
Result<VkShaderModule> create_module(Context& context, std::span<const std::uint32_t> spirv, std::string_view label);

/// Storage buffers behind the slots of a stage that can run over active tiles: their list, and their activity.
inline constexpr std::uint32_t active_bindings = 2;

/// Values of the specialisation constants 0 to 4.
struct Constants {
    std::uint32_t effects = 0;
    std::uint32_t group_x = 1, group_y = 1;
    std::int32_t corrected_division = 0;
    std::uint32_t active_tiles = 0;
};
Result<VkPipeline> create_compute_pipeline(Context& context, VkPipelineCache cache, VkShaderModule module,
                                           VkPipelineLayout layout, const Constants& constants, std::string_view label);

/// What the pipelines of one stage share.
struct StageObjects {
    VkShaderModule module = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
};

struct StagePipeline {
    std::uint32_t group_x = 0, group_y = 0;
    VkPipeline handle = VK_NULL_HANDLE;
};

/// Owns all pipelines of a device until it closes.
class Pipelines {
  public:
    explicit Pipelines(Context& context) : c_(context) {}
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;
    Status open();
    /// Errors: not_supported (no SPIR-V, too many bindings), out_of_memory.
    Result<compute::Pipeline> create(int stage, std::uint32_t effects, compute::GroupSize group);
    const StagePipeline& at(compute::Pipeline pipeline) const { return pipelines_[pipeline.id - 1]; }
    /// Of a stage that has a pipeline.
    const StageObjects& stage(int index) const { return stages_[static_cast<std::size_t>(index)]; }

  private:
    Status prepare_stage(int stage);

    Context& c_;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::vector<StageObjects> stages_;
    std::vector<StagePipeline> pipelines_; // handle id - 1 is the place
};

} // namespace wadi::vulkan
