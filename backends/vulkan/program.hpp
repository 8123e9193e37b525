// A compiled program: descriptor sets written once, a flat list of commands, and the command buffers that replay it.
#pragma once
#include "backends/vulkan/buffers.hpp"
#include "backends/vulkan/pipelines.hpp"
#include "backends/vulkan/submissions.hpp"
#include "engine/compute/program.hpp"
#include <variant>
#include <vector>

namespace wadi::vulkan {

struct BarrierCommand {
    Kinds before, after;
};
struct DispatchCommand {
    VkPipeline pipeline;
    VkPipelineLayout layout;
    VkDescriptorSet set;
    std::uint32_t groups_x, groups_y;
    VkBuffer groups = VK_NULL_HANDLE; // read on the device in place of the two, at `groups_offset`
    VkDeviceSize groups_offset = 0;
};
struct CopyCommand {
    VkBuffer from, to;
    VkBufferCopy region;
};
struct FillCommand {
    VkBuffer buffer;
    std::uint32_t word;
};
struct TimestampCommand {
    std::uint32_t number; // among the program's timestamps
};
using Command = std::variant<BarrierCommand, DispatchCommand, CopyCommand, FillCommand, TimestampCommand>;

/// What a program refers to.
struct ProgramParts {
    Context& context;
    const Buffers& buffers;
    const Pipelines& pipelines;
    const Submissions& submissions;
};

class CompiledProgram : public backends::Retirable<CompiledProgram> {
  public:
    /// Errors: not_supported (too many groups), out_of_memory.
    static Result<std::unique_ptr<CompiledProgram>> compile(const ProgramParts& parts, const compute::ProgramBuilder& builder,
                                                            const WorldParams& params);
    ~CompiledProgram();
    CompiledProgram(const CompiledProgram&) = delete;
    CompiledProgram& operator=(const CompiledProgram&) = delete;

    /// The commands to submit in a submission slot: the recorded ones, or `own` recorded anew.
    Result<VkCommandBuffer> commands_for(std::uint32_t slot, VkCommandBuffer own);
    /// The same as a secondary command buffer, for the host's to execute; recorded when first asked for.
    Result<VkCommandBuffer> secondary_for(std::uint32_t slot);
    /// The parameters, for the first submission; nothing once that has gone out.
    Submissions::Update first_update() const;
    void submitted() { parameters_sent_ = true; }
    /// Of a finished submission that ran in `slot`.
    Result<std::vector<compute::Timing>> timings(std::uint32_t slot);

  private:
    CompiledProgram(Context& context, const WorldParams& values) : c_(context), values_(values) {}
    Status create_params();
    Status create_queries(const compute::ProgramBuilder& builder);
    Status record_replays(std::vector<VkCommandBuffer>& replays, VkCommandBufferLevel level);
    Status record(VkCommandBuffer commands, std::uint32_t slot, VkCommandBufferUsageFlags usage);
    void record_command(VkCommandBuffer commands, const Command& command, std::uint32_t slot);

    Context& c_;
    std::string label_;
    const WorldParams values_;
    Memory params_; // values_, from the first submission on
    bool parameters_sent_ = false;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    std::vector<Command> commands_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<VkCommandBuffer> replays_;       // one, or one per submission slot where each has queries of its own
    std::vector<VkCommandBuffer> secondaries_;   // likewise
    VkQueryPool queries_ = VK_NULL_HANDLE;       // timestamps_.size() per submission slot
    std::vector<std::string> timestamps_;        // labels
    VkPipeline bound_pipeline_ = VK_NULL_HANDLE; // while recording
    VkDescriptorSet bound_set_ = VK_NULL_HANDLE;
};

} // namespace wadi::vulkan
