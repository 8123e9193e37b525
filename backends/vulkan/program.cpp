#include "backends/vulkan/program.hpp"
#include "backends/vulkan/plan.hpp"

namespace wadi::vulkan {

Result<std::unique_ptr<CompiledProgram>>
CompiledProgram::compile(const ProgramParts& parts, const compute::ProgramBuilder& builder, const WorldParams& params) {
    std::unique_ptr<CompiledProgram> program(new CompiledProgram(parts.context, params));
    program->label_ = builder.label();
    if (Status s = program->create_params(); !s) return s;
    Plan plan;
    const Status planned = plan_commands(parts, builder, program->params_.buffer, plan);
    program->descriptors_ = plan.descriptors;
    program->commands_ = std::move(plan.commands);
    if (!planned) return planned;
    if (Status s = program->create_queries(builder); !s) return s;
    if (!parts.context.options.no_replay) {
        if (Status s = program->record_replays(program->replays_, VK_COMMAND_BUFFER_LEVEL_PRIMARY); !s) return s;
    }
    return program;
}

CompiledProgram::~CompiledProgram() {
    if (pool_ != VK_NULL_HANDLE) c_.vk.vkDestroyCommandPool(c_.device, pool_, nullptr);
    if (queries_ != VK_NULL_HANDLE) c_.vk.vkDestroyQueryPool(c_.device, queries_, nullptr);
    if (descriptors_ != VK_NULL_HANDLE) c_.vk.vkDestroyDescriptorPool(c_.device, descriptors_, nullptr);
    release(c_, params_);
}

Status CompiledProgram::create_params() {
    auto memory = allocate(c_, sizeof(values_), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Place::device, label_ + " parameters");
    if (!memory) return memory.status();
    params_ = std::move(*memory);
    return ok_status();
}

Submissions::Update CompiledProgram::first_update() const {
    if (parameters_sent_) return {};
    return {params_.buffer, std::as_bytes(std::span(&values_, 1))};
}

Status CompiledProgram::create_queries(const compute::ProgramBuilder& builder) {
    for (const compute::Op& op : builder.ops()) {
        if (const auto* t = std::get_if<compute::Timestamp>(&op)) timestamps_.push_back(t->label);
    }
    // A queue without timestamps runs the program all the same; timings() then says not_supported.
    if (timestamps_.empty() || !c_.capabilities.timestamps) return ok_status();
    auto info = vk_struct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = static_cast<std::uint32_t>(timestamps_.size()) * Submissions::most_in_flight;
    return c_.check(c_.vk.vkCreateQueryPool(c_.device, &info, nullptr, &queries_), "vkCreateQueryPool", label_);
}

Status CompiledProgram::record_replays(std::vector<VkCommandBuffer>& replays, VkCommandBufferLevel level) {
    if (pool_ == VK_NULL_HANDLE) {
        auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        pool.queueFamilyIndex = c_.queue_family;
        if (Status s = c_.check(c_.vk.vkCreateCommandPool(c_.device, &pool, nullptr, &pool_), "vkCreateCommandPool", label_); !s)
            return s;
    }
    std::vector<VkCommandBuffer> made(queries_ != VK_NULL_HANDLE ? Submissions::most_in_flight : 1);
    auto info = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool_;
    info.level = level;
    info.commandBufferCount = static_cast<std::uint32_t>(made.size());
    const VkResult r = c_.vk.vkAllocateCommandBuffers(c_.device, &info, made.data());
    if (Status s = c_.check(r, "vkAllocateCommandBuffers", label_); !s) return s;
    for (std::uint32_t slot = 0; slot < made.size(); ++slot) {
        if (Status s = record(made[slot], slot, VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT); !s) return s;
    }
    replays = std::move(made);
    return ok_status();
}

Status CompiledProgram::record(VkCommandBuffer commands, std::uint32_t slot, VkCommandBufferUsageFlags usage) {
    // Read for secondary command buffers only.
    const auto inheritance = vk_struct<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO);
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = usage;
    info.pInheritanceInfo = &inheritance;
    if (Status s = c_.check(c_.vk.vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer", label_); !s) return s;
    if (queries_ != VK_NULL_HANDLE) {
        const auto count = static_cast<std::uint32_t>(timestamps_.size());
        c_.vk.vkCmdResetQueryPool(commands, queries_, slot * count, count);
    }
    bound_pipeline_ = VK_NULL_HANDLE;
    bound_set_ = VK_NULL_HANDLE;
    for (const Command& command : commands_) record_command(commands, command, slot);
    if (Status s = c_.check(c_.vk.vkEndCommandBuffer(commands), "vkEndCommandBuffer", label_); !s) return s;
    ++c_.counters.recordings;
    return ok_status();
}

void CompiledProgram::record_command(VkCommandBuffer commands, const Command& command, std::uint32_t slot) {
    if (const auto* barrier = std::get_if<BarrierCommand>(&command)) {
        record_barrier(c_, commands, barrier->before, barrier->after);
    } else if (const auto* d = std::get_if<DispatchCommand>(&command)) {
        if (d->pipeline != bound_pipeline_) c_.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, d->pipeline);
        if (d->set != bound_set_) {
            c_.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, d->layout, 0, 1, &d->set, 0, nullptr);
        }
        bound_pipeline_ = d->pipeline;
        bound_set_ = d->set;
        if (d->groups != VK_NULL_HANDLE) {
            c_.vk.vkCmdDispatchIndirect(commands, d->groups, d->groups_offset);
        } else {
            c_.vk.vkCmdDispatch(commands, d->groups_x, d->groups_y, 1);
        }
    } else if (const auto* copy = std::get_if<CopyCommand>(&command)) {
        c_.vk.vkCmdCopyBuffer(commands, copy->from, copy->to, 1, &copy->region);
    } else if (const auto* fill = std::get_if<FillCommand>(&command)) {
        c_.vk.vkCmdFillBuffer(commands, fill->buffer, 0, VK_WHOLE_SIZE, fill->word);
    } else if (const auto* t = std::get_if<TimestampCommand>(&command); t != nullptr && queries_ != VK_NULL_HANDLE) {
        const std::uint32_t query = slot * static_cast<std::uint32_t>(timestamps_.size()) + t->number;
        c_.vk.vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, query);
    }
}

Result<VkCommandBuffer> CompiledProgram::commands_for(std::uint32_t slot, VkCommandBuffer own) {
    if (!replays_.empty()) return replays_[replays_.size() == 1 ? 0 : slot];
    if (Status s = record(own, slot, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT); !s) return s;
    return own;
}

Result<VkCommandBuffer> CompiledProgram::secondary_for(std::uint32_t slot) {
    if (secondaries_.empty()) {
        if (Status s = record_replays(secondaries_, VK_COMMAND_BUFFER_LEVEL_SECONDARY); !s) return s;
    }
    return secondaries_[secondaries_.size() == 1 ? 0 : slot];
}

Result<std::vector<compute::Timing>> CompiledProgram::timings(std::uint32_t slot) {
    if (timestamps_.empty()) return std::vector<compute::Timing>{};
    if (queries_ == VK_NULL_HANDLE)
        return error(Code::not_supported, c_.capabilities.name + " has no timestamps on its compute queue");
    const auto count = static_cast<std::uint32_t>(timestamps_.size());
    std::vector<std::uint64_t> ticks(count);
    const VkResult r = c_.vk.vkGetQueryPoolResults(c_.device, queries_, slot * count, count, count * sizeof(ticks[0]),
                                                   ticks.data(), sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT);
    if (Status s = c_.check(r, "vkGetQueryPoolResults", label_); !s) return s;
    std::vector<compute::Timing> timings;
    for (std::uint32_t n = 1; n < count; ++n) {
        const std::uint64_t elapsed = (ticks[n] - ticks[n - 1]) & c_.limits.timestamp_mask;
        timings.push_back({timestamps_[n], static_cast<double>(elapsed) * c_.limits.timestamp_nanoseconds * 1e-6});
    }
    return timings;
}

} // namespace wadi::vulkan
