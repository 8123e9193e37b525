#include "backends/vulkan/loader.hpp"
#include <volk.h>
#if !defined(_WIN32)
#include <dlfcn.h>
#endif

namespace wadi::vulkan {

namespace {

/// volk calls the entry point of whatever library has the loader's name, there or not.
bool loader_has_entry() {
#if !defined(_WIN32) && !defined(__APPLE__)
    for (const char* name : {"libvulkan.so.1", "libvulkan.so"})
        if (void* loader = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return dlsym(loader, "vkGetInstanceProcAddr") != nullptr;
#endif
    return true;
}

} // namespace

PFN_vkGetInstanceProcAddr loader_entry(std::string& why) {
    // volk knows the loader's name and how a library is opened on every system.
    static const bool found = loader_has_entry() && volkInitialize() == VK_SUCCESS;
    static const PFN_vkGetInstanceProcAddr entry = found ? vkGetInstanceProcAddr : nullptr;
    if (!found) why = "the Vulkan loader cannot be opened (libvulkan.so.1, Debian package libvulkan1; on Windows vulkan-1.dll)";
    return entry;
}

} // namespace wadi::vulkan
