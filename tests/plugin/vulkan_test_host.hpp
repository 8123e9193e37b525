// A Vulkan host of worlds, for tests.
#pragma once
#include "tests/plugin/abi_worlds.hpp"
#include <doctest/doctest.h>
extern "C" {
#include "samples/vulkan_host_minimal/host.h"
}

namespace wadi::test {

struct VulkanHost {
    wadi_vulkan_host vulkan = make_device(0);
    VkSemaphore semaphore = make_timeline(&vulkan, 0);
    VulkanHost() = default;
    VulkanHost(const VulkanHost&) = delete;
    VulkanHost& operator=(const VulkanHost&) = delete;
    ~VulkanHost() {
        vkDestroySemaphore(vulkan.device, semaphore, nullptr);
        destroy_device(&vulkan);
    }
};

inline bool has_vulkan() {
    for (const auto& name : abi_backends()) {
        if (name == "vulkan") return true;
    }
    MESSAGE("SKIPPED: no Vulkan device here");
    return false;
}

struct HostCommands {
    VkCommandPool pool{};
    VkCommandBuffer commands{};
};

/// A command buffer on the host's queue, begun, with a pool of its own.
inline HostCommands begin_commands(const VulkanHost& host) {
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = host.vulkan.queue_family;
    VkCommandPool pool{};
    check_vk(vkCreateCommandPool(host.vulkan.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands{};
    check_vk(vkAllocateCommandBuffers(host.vulkan.device, &allocate, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    check_vk(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    return {pool, commands};
}

/// Records calls into a command buffer of the host's, submits it and waits. `ahead` runs between the two.
template <class Calls, class Ahead>
void record(const VulkanHost& host, wadi_world_id world, std::uint64_t value, Calls calls, Ahead ahead) {
    const auto [pool, commands] = begin_commands(host);
    const wadi_vulkan_sync promise{host.semaphore, value};
    REQUIRE(wadi_vulkan_begin_recording(world, commands, &promise) == WADI_OK);
    calls(commands);
    CHECK(wadi_vulkan_end_recording(world) == WADI_OK);
    check_vk(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    ahead();
    VkTimelineSemaphoreSubmitInfo values{};
    values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
    values.signalSemaphoreValueCount = 1;
    values.pSignalSemaphoreValues = &value;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.pNext = &values;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &host.semaphore;
    check_vk(vkQueueSubmit(host.vulkan.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    wait_for(&host.vulkan, host.semaphore, value);
    vkDestroyCommandPool(host.vulkan.device, pool, nullptr);
}

template <class Calls> void record(const VulkanHost& host, wadi_world_id world, std::uint64_t value, Calls calls) {
    record(host, world, value, calls, [] {});
}

} // namespace wadi::test
