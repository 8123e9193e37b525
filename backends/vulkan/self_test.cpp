#include "backends/vulkan/self_test.hpp"
#include "backends/common/exact_float.hpp"
#include "backends/vulkan/pipelines.hpp"
#include <cstring>

namespace wadi::vulkan {
namespace {

constexpr std::uint32_t self_test_spirv[] = {
#include "self_test.inc"
};

constexpr std::uint32_t group_threads = 64;

using backends::Operands;

struct SelfTest {
    Context& c;
    OneTimeCommands& once;
    Transfers& transfers;
    Memory operands, results;
    VkShaderModule module = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;

    ~SelfTest() {
        c.wait_idle();
        if (pipeline != VK_NULL_HANDLE) c.vk.vkDestroyPipeline(c.device, pipeline, nullptr);
        if (pool != VK_NULL_HANDLE) c.vk.vkDestroyDescriptorPool(c.device, pool, nullptr);
        if (layout != VK_NULL_HANDLE) c.vk.vkDestroyPipelineLayout(c.device, layout, nullptr);
        if (set_layout != VK_NULL_HANDLE) c.vk.vkDestroyDescriptorSetLayout(c.device, set_layout, nullptr);
        if (module != VK_NULL_HANDLE) c.vk.vkDestroyShaderModule(c.device, module, nullptr);
        release(c, operands);
        release(c, results);
    }

    template <class T> static Status take(T& into, Result<T> made) {
        if (made) into = std::move(*made);
        return made.status();
    }

    Status prepare(std::span<const Operands> values) {
        const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        const std::uint64_t result_bytes = values.size() * backends::exact_float_results_per_try * sizeof(float);
        if (Status s = take(operands, allocate(c, values.size_bytes(), usage, Place::device, "self-test operands")); !s) return s;
        if (Status s = take(results, allocate(c, result_bytes, usage, Place::device, "self-test results")); !s) return s;
        if (Status s = transfers.write(operands, 0, std::as_bytes(values)); !s) return s;
        if (Status s = take(module, create_module(c, self_test_spirv, "self-test")); !s) return s;
        if (Status s = take(set_layout, create_set_layout(c, 0, 2, "self-test")); !s) return s;
        if (Status s = take(layout, create_pipeline_layout(c, set_layout, "self-test")); !s) return s;
        return create_set();
    }

    Status create_set() {
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
        auto pool_info = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        pool_info.maxSets = 1;
        pool_info.poolSizeCount = 1;
        pool_info.pPoolSizes = &size;
        VkResult r = c.vk.vkCreateDescriptorPool(c.device, &pool_info, nullptr, &pool);
        if (Status s = c.check(r, "vkCreateDescriptorPool", "self-test"); !s) return s;
        auto set_info = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        set_info.descriptorPool = pool;
        set_info.descriptorSetCount = 1;
        set_info.pSetLayouts = &set_layout;
        r = c.vk.vkAllocateDescriptorSets(c.device, &set_info, &set);
        if (Status s = c.check(r, "vkAllocateDescriptorSets", "self-test"); !s) return s;
        const VkDescriptorBufferInfo buffers[] = {{operands.buffer, 0, VK_WHOLE_SIZE}, {results.buffer, 0, VK_WHOLE_SIZE}};
        auto write = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.descriptorCount = 2; // runs on into binding 1
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = buffers;
        c.vk.vkUpdateDescriptorSets(c.device, 1, &write, 0, nullptr);
        c.counters.descriptor_writes += 2;
        return ok_status();
    }

    /// True when every result agrees in every bit.
    Result<bool> run(bool corrected, const std::vector<float>& wanted) {
        if (pipeline != VK_NULL_HANDLE) c.vk.vkDestroyPipeline(c.device, pipeline, nullptr);
        pipeline = VK_NULL_HANDLE;
        const Constants constants{0, group_threads, 1, corrected ? 1 : 0};
        if (Status s = take(pipeline, create_compute_pipeline(c, VK_NULL_HANDLE, module, layout, constants, "self-test")); !s)
            return s;
        auto commands = once.begin();
        if (!commands) return commands.status();
        c.vk.vkCmdBindPipeline(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        c.vk.vkCmdBindDescriptorSets(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
        c.vk.vkCmdDispatch(*commands, backends::exact_float_tries / group_threads, 1, 1);
        if (Status s = once.submit(); !s) return s;
        std::vector<float> got(wanted.size());
        if (Status s = transfers.read(results, 0, std::as_writable_bytes(std::span(got))); !s) return s;
        return std::memcmp(got.data(), wanted.data(), got.size() * sizeof(float)) == 0;
    }
};

} // namespace

Status run_self_test(Context& c, OneTimeCommands& once, Transfers& transfers) {
#ifdef WADI_RELAXED_FLOAT
    return ok_status(); // native quotient and root, bits not promised
#endif
    const auto operands = backends::exact_float_operands();
    const auto wanted = backends::exact_float_results(operands);
    SelfTest test{c, once, transfers, {}, {}};
    if (Status s = test.prepare(operands); !s) return s;
    for (const bool corrected : {false, true}) {
        auto exact = test.run(corrected, wanted);
        if (!exact) return exact.status();
        if (*exact) {
            c.corrected_division = corrected;
            c.capabilities.exact_float = true;
            return ok_status();
        }
    }
    if (c.options.log) {
        const char* reason =
            c.float_modes ? "" : "; nor could it be asked for signed zeros (SignedZeroInfNanPreserve), which some need";
        c.options.log(1, "vulkan: " + backends::inexact_float_warning(c.capabilities.name) + reason);
    }
    return ok_status();
}

} // namespace wadi::vulkan
