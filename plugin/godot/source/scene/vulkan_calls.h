/* Vulkan's functions of the renderer's instance and device. */
#ifndef WADI_GODOT_VULKAN_CALLS_H
#define WADI_GODOT_VULKAN_CALLS_H

#include <stdbool.h>
#include <vulkan/vulkan_core.h>

#define VULKAN_DEVICE_FUNCTIONS(X)                                                                                               \
    X(AllocateMemory)                                                                                                            \
    X(BindImageMemory)                                                                                                           \
    X(CreateImage)                                                                                                               \
    X(DestroyImage)                                                                                                              \
    X(FreeMemory)                                                                                                                \
    X(GetImageMemoryRequirements)                                                                                                \
    X(QueueWaitIdle)

typedef struct VulkanCalls {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr;
    PFN_vkGetPhysicalDeviceMemoryProperties GetPhysicalDeviceMemoryProperties;
#define VULKAN_FIELD(name) PFN_vk##name name;
    VULKAN_DEVICE_FUNCTIONS(VULKAN_FIELD)
#undef VULKAN_FIELD
} VulkanCalls;

/** Gets them from the loader that the engine has opened; false where one is missing. */
bool vulkan_load(VulkanCalls* calls, VkInstance instance, VkDevice device);

#endif
