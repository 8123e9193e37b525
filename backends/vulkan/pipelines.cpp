#include "backends/vulkan/pipelines.hpp"
#include "backends/vulkan/float_modes.hpp"
#include "shaders/stage_table.hpp"
#include <cstddef>

namespace wadi::vulkan {

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
    std::vector<std::uint32_t> without;
    if (!c.float_modes) {
        without = without_float_modes(spirv);
        spirv = without;
    }
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
        if (s.module != VK_NULL_HANDLE) c_.vk.vkDestroyShaderModule(c_.device, s.module, nullptr);
    }
    if (cache_ != VK_NULL_HANDLE) c_.vk.vkDestroyPipelineCache(c_.device, cache_, nullptr);
}

// Makes what is still missing, so that a call that failed half way can be repeated.
Status Pipelines::prepare_stage(int stage) {
    const compute::StageInfo& info = compute::stage_table()[static_cast<std::size_t>(stage)];
    StageObjects& objects = stages_[static_cast<std::size_t>(stage)];
    if (info.spirv.empty()) return error(Code::not_supported, "this build has no SPIR-V for stage " + std::string(info.name));
    const auto storage = static_cast<std::uint32_t>(info.bindings.size()) + (info.marks ? active_bindings : 0);
    if (storage > c_.limits.storage_buffers) {
        return error(Code::not_supported, "stage " + std::string(info.name) + " binds " + std::to_string(storage) + " buffers; " +
                                              c_.capabilities.name + " allows " + std::to_string(c_.limits.storage_buffers));
    }
    if (objects.module == VK_NULL_HANDLE) {
        auto made = create_module(c_, info.spirv, info.name);
        if (!made) return made.status();
        objects.module = *made;
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
    const Constants constants{effects, static_cast<std::uint32_t>(group.x), static_cast<std::uint32_t>(group.y),
                              c_.corrected_division ? 1 : 0, group.tile > 0 ? 1u : 0u};
    if (Status s = prepare_stage(stage); !s) return s;
    pipelines_.reserve(pipelines_.size() + 1); // so that nothing can fail once the pipeline exists
    const StageObjects& objects = stages_[static_cast<std::size_t>(stage)];
    auto handle = create_compute_pipeline(c_, cache_, objects.module, objects.layout, constants,
                                          compute::stage_table()[static_cast<std::size_t>(stage)].name);
    if (!handle) return handle.status();
    pipelines_.push_back({constants.group_x, constants.group_y, *handle});
    return compute::Pipeline{static_cast<std::uint32_t>(pipelines_.size())};
}

} // namespace wadi::vulkan
