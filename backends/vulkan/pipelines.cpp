#include "backends/vulkan/pipelines.hpp"
#include "engine/compute/stage_table.hpp"
#include <algorithm>
#include <cstddef>

namespace wadi::vulkan {
namespace {

// Threads of a group where the caller leaves it open: 64x4 suits stencils (GPU measurements), rim stages have one row.
Constants default_group(compute::Extent extent, const Limits& limits) {
    Constants group;
    group.group_x = std::min({64u, limits.group_size[0], limits.group_threads});
    const std::uint32_t rows = extent == compute::Extent::rim ? 1u : 4u;
    group.group_y = std::min({rows, limits.group_size[1], limits.group_threads / group.group_x});
    return group;
}

Result<Constants> choose_group(const compute::StageInfo& info, compute::GroupSize asked, const Limits& limits) {
    Constants group = default_group(info.extent, limits);
    if (asked.tile > 0 && !info.marks)
        return error(Code::bad_argument, "stage " + std::string(info.name) + " cannot run over active tiles");
    group.active_tiles = asked.tile > 0 ? 1 : 0;
    if (info.fused())
        asked = {int{compute::fused_group_x}, int{compute::fused_group_y}, 0}; // the only groups that it is written for
    // As list_active_tiles counts the groups of a tile.
    if (asked.tile > 0 && info.extent != compute::Extent::rim)
        asked = {asked.tile, std::min(asked.tile, 256 / asked.tile), asked.tile};
    const bool negative = asked.x < 0 || asked.y < 0;
    if (asked.x > 0) group.group_x = static_cast<std::uint32_t>(asked.x);
    if (asked.y > 0) group.group_y = static_cast<std::uint32_t>(asked.y);
    const bool fits = group.group_x <= limits.group_size[0] && group.group_y <= limits.group_size[1] &&
                      std::uint64_t{group.group_x} * group.group_y <= limits.group_threads;
    if (!negative && fits) return group;
    return error(Code::bad_argument, "group size of stage " + std::string(info.name) + " is " + std::to_string(asked.x) + " x " +
                                         std::to_string(asked.y) + "; allowed are 0 to " + std::to_string(limits.group_size[0]) +
                                         " x 0 to " + std::to_string(limits.group_size[1]) + " and at most " +
                                         std::to_string(limits.group_threads) + " threads");
}

} // namespace

Result<VkDescriptorSetLayout> create_set_layout(Context& c, std::uint32_t uniforms, std::uint32_t storage,
                                                std::string_view label) {
    std::vector<VkDescriptorSetLayoutBinding> bindings(uniforms + storage);
    for (std::uint32_t b = 0; b < bindings.size(); ++b) {
        bindings[b].binding = b;
        bindings[b].descriptorType = b < uniforms ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[b].descriptorCount = 1;
        bindings[b].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    auto info = vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    info.bindingCount = uniforms + storage;
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    const VkResult r = c.vk.vkCreateDescriptorSetLayout(c.device, &info, nullptr, &layout);
    if (Status s = c.check(r, "vkCreateDescriptorSetLayout", label); !s) return s;
    return layout;
}

Result<VkPipelineLayout> create_pipeline_layout(Context& c, VkDescriptorSetLayout set, std::string_view label) {
    auto info = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = 1;
    info.pSetLayouts = &set;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkResult r = c.vk.vkCreatePipelineLayout(c.device, &info, nullptr, &layout);
    if (Status s = c.check(r, "vkCreatePipelineLayout", label); !s) return s;
    return layout;
}

Result<VkShaderModule> create_module(Context& c, std::span<const std::uint32_t> spirv, std::string_view label) {
    auto info = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    const VkResult r = c.vk.vkCreateShaderModule(c.device, &info, nullptr, &module);
    if (Status s = c.check(r, "vkCreateShaderModule", label); !s) return s;
    return module;
}

Result<VkPipeline> create_compute_pipeline(Context& c, VkPipelineCache cache, VkShaderModule module, VkPipelineLayout layout,
                                           const Constants& constants, std::string_view label) {
    const VkSpecializationMapEntry entries[] = {
        {0, offsetof(Constants, effects), sizeof(constants.effects)},
        {1, offsetof(Constants, group_x), sizeof(constants.group_x)},
        {2, offsetof(Constants, group_y), sizeof(constants.group_y)},
        {3, offsetof(Constants, corrected_division), sizeof(constants.corrected_division)},
        {4, offsetof(Constants, active_tiles), sizeof(constants.active_tiles)},
    };
    const VkSpecializationInfo specialization{5, entries, sizeof(constants), &constants};
    auto info = vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = vk_struct<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult r = c.vk.vkCreateComputePipelines(c.device, cache, 1, &info, nullptr, &pipeline);
    if (Status s = c.check(r, "vkCreateComputePipelines", label); !s) return s;
    return pipeline;
}

Status Pipelines::open() {
    stages_.resize(compute::stage_table().size());
    const auto info = vk_struct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    return c_.check(c_.vk.vkCreatePipelineCache(c_.device, &info, nullptr, &cache_), "vkCreatePipelineCache");
}

Pipelines::~Pipelines() {
    for (const auto& p : pipelines_) c_.vk.vkDestroyPipeline(c_.device, p.handle, nullptr);
    for (const auto& s : stages_) {
        if (s.layout != VK_NULL_HANDLE) c_.vk.vkDestroyPipelineLayout(c_.device, s.layout, nullptr);
        if (s.set_layout != VK_NULL_HANDLE) c_.vk.vkDestroyDescriptorSetLayout(c_.device, s.set_layout, nullptr);
        for (const auto module : {s.module, s.half_module})
            if (module != VK_NULL_HANDLE) c_.vk.vkDestroyShaderModule(c_.device, module, nullptr);
    }
    if (cache_ != VK_NULL_HANDLE) c_.vk.vkDestroyPipelineCache(c_.device, cache_, nullptr);
}

// Makes what is still missing, so that a call that failed half way can be repeated.
Status Pipelines::prepare_stage(int stage, bool half) {
    const compute::StageInfo& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    StageObjects& objects = stages_[static_cast<std::size_t>(stage)];
    if (info.spirv.empty()) return error(Code::not_supported, "this build has no SPIR-V for stage " + std::string(info.name));
    const auto storage = static_cast<std::uint32_t>(info.bindings.size()) + (info.marks ? active_bindings : 0);
    if (storage > c_.limits.storage_buffers) {
        return error(Code::not_supported, "stage " + std::string(info.name) + " binds " + std::to_string(storage) + " buffers; " +
                                              c_.capabilities.name + " allows " + std::to_string(c_.limits.storage_buffers));
    }
    auto& module = half ? objects.half_module : objects.module;
    if (module == VK_NULL_HANDLE) {
        auto made = create_module(c_, half ? info.half_spirv : info.spirv, info.name);
        if (!made) return made.status();
        module = *made;
    }
    if (objects.set_layout == VK_NULL_HANDLE) {
        auto layout = create_set_layout(c_, first_slot_binding, storage, info.name);
        if (!layout) return layout.status();
        objects.set_layout = *layout;
    }
    if (objects.layout == VK_NULL_HANDLE) {
        auto layout = create_pipeline_layout(c_, objects.set_layout, info.name);
        if (!layout) return layout.status();
        objects.layout = *layout;
    }
    return ok_status();
}

Result<compute::Pipeline> Pipelines::create(int stage, std::uint32_t effects, compute::GroupSize group) {
    const auto table = compute::stage_table();
    if (stage < 0 || stage >= static_cast<int>(table.size())) {
        return error(Code::bad_argument, "stage index " + std::to_string(stage) + " is outside 0 to " +
                                             std::to_string(static_cast<int>(table.size()) - 1));
    }
    const compute::StageInfo& info = table[static_cast<std::size_t>(stage)];
    auto constants = choose_group(info, group, c_.limits);
    if (!constants) return constants.status();
    constants->effects = effects & info.tested_effects;
    constants->corrected_division = c_.corrected_division ? 1 : 0;
    const auto same = [&](const StagePipeline& p) {
        return p.stage == stage && p.effects == constants->effects && p.group_x == constants->group_x &&
               p.group_y == constants->group_y && p.active_tiles == (constants->active_tiles != 0);
    };
    const auto known = std::find_if(pipelines_.begin(), pipelines_.end(), same);
    if (known != pipelines_.end()) return compute::Pipeline{static_cast<std::uint32_t>(known - pipelines_.begin()) + 1};

    const bool half = (constants->effects & EFFECT_HALF_STORAGE) != 0; // no stage asks for it but those with a module for it
    if (half && !c_.capabilities.half_storage)
        return error(Code::not_supported, c_.capabilities.name + " has no buffers of 16-bit floats, or no leave to use them");
    if (Status s = prepare_stage(stage, half); !s) return s;
    pipelines_.reserve(pipelines_.size() + 1); // so that nothing can fail once the pipeline exists
    const StageObjects& objects = stages_[static_cast<std::size_t>(stage)];
    auto handle =
        create_compute_pipeline(c_, cache_, half ? objects.half_module : objects.module, objects.layout, *constants, info.name);
    if (!handle) return handle.status();
    pipelines_.push_back(
        {stage, constants->effects, constants->group_x, constants->group_y, constants->active_tiles != 0, *handle});
    return compute::Pipeline{static_cast<std::uint32_t>(pipelines_.size())};
}

const StagePipeline* Pipelines::find(compute::Pipeline pipeline) const {
    return pipeline.id == 0 || pipeline.id > pipelines_.size() ? nullptr : &pipelines_[pipeline.id - 1];
}

} // namespace wadi::vulkan
