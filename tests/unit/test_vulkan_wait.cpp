// A wait for the queue that fails for want of memory: what the device may still use is left, not destroyed.
#ifdef WADI_HAS_VULKAN
#include "backends/vulkan/context.hpp"
#include <doctest/doctest.h>

using wadi::vulkan::Context;

namespace vulkan_wait {
namespace {

int waits = 0, waits_that_fail = 0, destroyed = 0;
VkResult failure = VK_ERROR_OUT_OF_HOST_MEMORY;

// A context without a device, whose driver is this file.
void set_up(Context& context, int failing, VkResult result) {
    waits = destroyed = 0;
    waits_that_fail = failing;
    failure = result;
    context.vk.vkQueueWaitIdle = [](VkQueue) { return ++waits > waits_that_fail ? VK_SUCCESS : failure; };
    context.vk.vkDestroyBuffer = [](VkDevice, VkBuffer, const VkAllocationCallbacks*) { ++destroyed; };
    context.vk.vkFreeMemory = [](VkDevice, VkDeviceMemory, const VkAllocationCallbacks*) { ++destroyed; };
    context.vk.vkDestroyCommandPool = [](VkDevice, VkCommandPool, const VkAllocationCallbacks*) { ++destroyed; };
}

int destroyed_after_wait(Context& context) {
    context.wait_idle();
    context.vk.vkDestroyBuffer(context.device, VK_NULL_HANDLE, nullptr);
    context.vk.vkFreeMemory(context.device, VK_NULL_HANDLE, nullptr);
    context.vk.vkDestroyCommandPool(context.device, VK_NULL_HANDLE, nullptr);
    return destroyed;
}

} // namespace

TEST_CASE("a Vulkan queue that cannot be waited for leaves what it may use; one that can, in the end, does not") {
    {
        Context context;
        set_up(context, 1000000, VK_ERROR_OUT_OF_HOST_MEMORY);
        CHECK(destroyed_after_wait(context) == 0);
        CHECK(waits < 100); // it ends
        CHECK(context.lost);
    }
    {
        Context context;
        set_up(context, 2, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        CHECK(destroyed_after_wait(context) == 3);
        CHECK_FALSE(context.lost);
    }
    {
        Context context; // a lost device uses nothing any more
        set_up(context, 1000000, VK_ERROR_DEVICE_LOST);
        CHECK(destroyed_after_wait(context) == 3);
        CHECK(waits == 1);
        CHECK(context.lost);
    }
}

} // namespace vulkan_wait
#endif
