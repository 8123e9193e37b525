#include "backends/vulkan/loader.hpp"
#include <volk.h>

namespace wadi::vulkan {

PFN_vkGetInstanceProcAddr loader_entry(std::string& why) {
    // volk knows the loader's name and how a library is opened on every system.
    static const bool found = volkInitialize() == VK_SUCCESS;
    static const PFN_vkGetInstanceProcAddr entry = found ? vkGetInstanceProcAddr : nullptr;
    if (!found) why = "the Vulkan loader cannot be opened (libvulkan.so.1, Debian package libvulkan1; on Windows vulkan-1.dll)";
    return entry;
}

} // namespace wadi::vulkan
