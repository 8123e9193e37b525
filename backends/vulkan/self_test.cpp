#include "backends/vulkan/self_test.hpp"
#include "backends/vulkan/pipelines.hpp"
#include <cmath>
#include <cstring>

namespace wadi::vulkan {
namespace {

constexpr std::uint32_t self_test_spirv[] = {
#include "self_test.inc"
};

constexpr std::uint32_t tries = 16384;
constexpr std::uint32_t results_per_try = 6; // RESULTS in self_test.comp
constexpr std::uint32_t group_threads = 64;

struct Operands {
    float a, b;
};

// Quotients as near to the middle between two floats as quotients come, where the smallest error rounds the wrong way: Q is odd
// and has 25 bits, and a = (Q b - s) / 2^25 is whole, so that a/b = (Q - s/b) / 2^25 with s = +-1.
Operands hard_quotient(std::uint64_t random) {
    const std::uint64_t modulus = std::uint64_t{1} << 25;
    for (std::uint64_t b = (random & 0x7fffffu) | 0x800001u;; b += 2) {
        if (b >= std::uint64_t{1} << 24) b = 0x800001u;
        std::uint64_t inverse = b; // of b modulo 2^25: each round doubles the bits that are right
        for (int round = 0; round < 5; ++round) inverse = inverse * (2 - b * inverse) % modulus;
        const bool minus = (random >> 40 & 1u) != 0;
        const std::uint64_t q = minus ? (modulus - inverse) % modulus : inverse;
        if (q < modulus / 2) continue; // a float, not the middle between two
        const std::uint64_t a = (minus ? q * b + 1 : q * b - 1) / modulus;
        return {static_cast<float>(a), static_cast<float>(b)};
    }
}

// Random mantissas with exponents that no result of the test takes out of the normal range, since devices may flush
// denormals (stages keep them out). The generator is splitmix64: the same values everywhere.
std::vector<Operands> make_operands() {
    std::uint64_t state = 1;
    const auto random = [&state] {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t bits = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        return bits ^ (bits >> 31);
    };
    const auto draw = [&random](int exponents) {
        const std::uint64_t bits = random();
        const float mantissa = 1.0f + static_cast<float>(bits & 0x7fffffu) * 0x1p-23f;
        const int exponent = static_cast<int>((bits >> 32) % static_cast<std::uint64_t>(2 * exponents)) - exponents;
        return std::ldexp((bits >> 31 & 1u) != 0 ? -mantissa : mantissa, exponent);
    };
    std::vector<Operands> operands(tries);
    for (std::uint32_t n = 0; n < tries; ++n) {
        // A quarter of the pairs are far apart, the others as close as the terms of one equation are.
        const int exponents = n % 4 == 0 ? 40 : 6;
        operands[n].a = n % 64 == 0 ? 0.0f : n % 64 == 2 ? -0.0f : draw(exponents);
        operands[n].b = std::fabs(draw(exponents));
        if (n % 2 == 1) operands[n] = hard_quotient(random());
    }
    return operands;
}

// Rounds after every operation: contraction is off in the whole build.
std::vector<float> expected(const std::vector<Operands>& operands) {
    std::vector<float> results;
    results.reserve(operands.size() * results_per_try);
    for (const auto& [a, b] : operands) {
        const float product = a * b;
        results.insert(results.end(), {a + b, a - b, product, product + a, a / b, std::sqrt(b)});
    }
    return results;
}

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
        const std::uint64_t result_bytes = values.size() * results_per_try * sizeof(float);
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
        c.vk.vkCmdDispatch(*commands, tries / group_threads, 1, 1);
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
    const std::vector<Operands> operands = make_operands();
    const std::vector<float> wanted = expected(operands);
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
        c.options.log(1, "vulkan: " + c.capabilities.name +
                             " does not compute + - * / sqrt as the CPU does; results will differ in their last bits");
    }
    return ok_status();
}

} // namespace wadi::vulkan
