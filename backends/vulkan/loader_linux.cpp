#include "backends/vulkan/loader.hpp"
#include <cstring>
#include <dlfcn.h>

namespace wadi::vulkan {
namespace {

struct Loader {
    PFN_vkGetInstanceProcAddr entry = nullptr;
    std::string why;
};

Loader open_loader() {
    Loader loader;
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        const char* reason = dlerror();
        loader.why = std::string("the Vulkan loader cannot be opened (Debian package libvulkan1): ") +
                     (reason != nullptr ? reason : "libvulkan.so.1");
        return loader;
    }
    void* symbol = dlsym(library, "vkGetInstanceProcAddr");
    if (symbol == nullptr) {
        loader.why = "libvulkan.so.1 has no vkGetInstanceProcAddr";
        return loader;
    }
    static_assert(sizeof(symbol) == sizeof(loader.entry));
    std::memcpy(&loader.entry, &symbol, sizeof(symbol));
    return loader;
}

} // namespace

PFN_vkGetInstanceProcAddr loader_entry(std::string& why) {
    static const Loader loader = open_loader();
    why = loader.why;
    return loader.entry;
}

} // namespace wadi::vulkan
