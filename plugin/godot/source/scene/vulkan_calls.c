#include "vulkan_calls.h"

#include "engine/system.h"

/* The loader that the engine has open, on Linux, Windows and macOS: a system keeps one of a name. */
static SystemFunction first_call(void) {
    static const char* const loaders[] = {"libvulkan.so.1", "vulkan-1.dll", "libvulkan.1.dylib"};
    SystemFunction found = NULL;
    for (size_t n = 0; !found && n < sizeof loaders / sizeof *loaders; ++n)
        found = system_function(loaders[n], "vkGetInstanceProcAddr");
    return found;
}

bool vulkan_load(VulkanCalls* calls, VkInstance instance, VkDevice device) {
    calls->GetInstanceProcAddr = (PFN_vkGetInstanceProcAddr)first_call();
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
