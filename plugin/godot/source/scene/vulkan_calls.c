#include "vulkan_calls.h"

#include <dlfcn.h>

bool vulkan_load(VulkanCalls* calls, VkInstance instance, VkDevice device) {
    void* loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL); /* the engine's own: the system keeps one of a name */
    if (!loader) return false;
    *(void**)&calls->GetInstanceProcAddr = dlsym(loader, "vkGetInstanceProcAddr");
    if (!calls->GetInstanceProcAddr) return false;
    calls->GetPhysicalDeviceMemoryProperties =
        (PFN_vkGetPhysicalDeviceMemoryProperties)calls->GetInstanceProcAddr(instance, "vkGetPhysicalDeviceMemoryProperties");
    const PFN_vkGetDeviceProcAddr get = (PFN_vkGetDeviceProcAddr)calls->GetInstanceProcAddr(instance, "vkGetDeviceProcAddr");
    if (!calls->GetPhysicalDeviceMemoryProperties || !get) return false;
#define VULKAN_LOAD(name)                                                                                                        \
    calls->name = (PFN_vk##name)get(device, "vk" #name);                                                                         \
    if (!calls->name) return false;
    VULKAN_DEVICE_FUNCTIONS(VULKAN_LOAD)
#undef VULKAN_LOAD
    return true;
}
