// SignedZeroInfNanPreserve: every stage asks for it, and a device gets it only where it may be asked.
#ifdef WADI_HAS_VULKAN
#include "backends/vulkan/device.hpp"
#include "backends/vulkan/float_modes.hpp"
#include "backends/vulkan/loader.hpp"
#include "shaders/stage_table.hpp"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

using wadi::vulkan::vk_struct;
using wadi::vulkan::without_float_modes;

namespace vulkan_float_modes {
namespace {

using Words = std::vector<std::uint32_t>;

// What declares the mode in a module of one entry point, of id 4: three instructions, as the specification writes them.
const Words capability{2u << 16 | 17, 4466};
const Words extension{7u << 16 | 10, 0x5f565053, 0x5f52484b, 0x616f6c66,
                      0x6f635f74,    0x6f72746e, 0x0000736c}; // SPV_KHR_float_controls
bool is_mode(std::span<const std::uint32_t> words) { return words[0] == (4u << 16 | 16) && words[2] == 4461 && words[3] == 32; }

// Taken out by searching: every place in the module where these words follow each other.
Words searched(Words words) {
    for (const Words& wanted : {capability, extension}) {
        const auto found = std::search(words.begin(), words.end(), wanted.begin(), wanted.end());
        if (found != words.end()) words.erase(found, found + static_cast<std::ptrdiff_t>(wanted.size()));
    }
    for (std::size_t at = 5; at + 4 <= words.size(); ++at) {
        if (!is_mode(std::span(words).subspan(at, 4))) continue;
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(at), words.begin() + static_cast<std::ptrdiff_t>(at) + 4);
        break;
    }
    return words;
}

bool valid(std::span<const std::uint32_t> module, const std::string& name) {
    const std::string path = (std::filesystem::temp_directory_path() / ("wadi_float_modes_" + name + ".spv")).string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(module.data()), static_cast<std::streamsize>(module.size_bytes()));
    const int status = std::system((WADI_SPIRV_VAL " --target-env vulkan1.1 \"" + path + "\"").c_str());
    std::filesystem::remove(path);
    return status == 0;
}

} // namespace

TEST_CASE("the float mode is taken out of every stage's module, and nothing else") {
    int modules = 0;
    for (const auto& stage : wadi::compute::stage_table()) {
        if (stage.spirv.empty()) continue;
        CAPTURE(stage.name);
        ++modules;
        const Words with(stage.spirv.begin(), stage.spirv.end()), without = without_float_modes(with);
        CHECK(without.size() + capability.size() + extension.size() + 4 == with.size());
        CHECK((without == searched(with))); // no list of words for doctest to print
        CHECK((without_float_modes(without) == without));
        if (modules % 16 == 1) CHECK(valid(without, std::string(stage.name)));
    }
    CHECK(modules > 50);
    // What is no mode of zeros stays, and so does what is no SPIR-V.
    const Words other{0x07230203, 0x00010300, 0, 9, 0, 2u << 16 | 17, 1, 2u << 16 | 10, 0x00585053, 6u << 16 | 16,
                      4,          17,         8, 8, 1};
    CHECK((without_float_modes(other) == other));
    const Words broken{0x07230203, 0x00010300, 0, 9, 0, 2u << 16 | 17, 4466, 0, 2u << 16 | 17, 4466};
    CHECK((without_float_modes(broken) == Words{0x07230203, 0x00010300, 0, 9, 0, 0, 2u << 16 | 17, 4466}));
    CHECK((without_float_modes(Words{1, 2}) == Words{1, 2}));
    const Words cut{0x07230203, 0x00010300, 0, 9, 0, 7u << 16 | 10, 0x5f565053, 0x5f52484b};
    CHECK((without_float_modes(cut) == cut));
}

namespace {

// A host's device, whose driver answers as told about its version and its float modes.
struct Told {
    std::uint32_t instance_version, device_version;
    VkBool32 preserves;
};
Told told{};
int modules_with = 0, modules_without = 0, messages = 0;
PFN_vkGetInstanceProcAddr entry = nullptr;
PFN_vkGetDeviceProcAddr device_entry = nullptr;
PFN_vkGetPhysicalDeviceProperties2 properties_of = nullptr;
PFN_vkCreateShaderModule create_module = nullptr;
VkDebugUtilsMessengerEXT listener = VK_NULL_HANDLE; // where the validation layer is

VKAPI_ATTR void VKAPI_CALL answer_properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    properties_of(device, properties);
    properties->properties.apiVersion = std::min(properties->properties.apiVersion, told.device_version);
    for (auto* next = static_cast<VkBaseOutStructure*>(properties->pNext); next != nullptr; next = next->pNext) {
        if (next->sType != VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES) continue;
        auto& modes = *reinterpret_cast<VkPhysicalDeviceFloatControlsProperties*>(next);
        modes.shaderSignedZeroInfNanPreserveFloat32 &= told.preserves;
    }
}

VKAPI_ATTR VkResult VKAPI_CALL look_at_module(VkDevice device, const VkShaderModuleCreateInfo* info,
                                              const VkAllocationCallbacks* with, VkShaderModule* module) {
    const std::span words(info->pCode, info->codeSize / 4);
    const bool asks = std::search(words.begin(), words.end(), capability.begin(), capability.end()) != words.end();
    ++(asks ? modules_with : modules_without);
    return create_module(device, info, with, module);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_call(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = device_entry(device, name);
    if (std::strcmp(name, "vkCreateShaderModule") != 0) return real;
    create_module = reinterpret_cast<PFN_vkCreateShaderModule>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(look_at_module);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_call(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = entry(instance, name);
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        device_entry = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(device_call);
    }
    if (std::strcmp(name, "vkGetPhysicalDeviceProperties2") == 0) {
        properties_of = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(answer_properties);
    }
    return real;
}

VKAPI_ATTR VkBool32 VKAPI_CALL count_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    ++messages;
    MESSAGE(std::string(data->pMessage));
    return VK_FALSE;
}

template <class Call> Call find(VkInstance instance, const char* name) { return reinterpret_cast<Call>(entry(instance, name)); }

// An instance of the version told, with the validation layer where that is installed.
VkInstance make_instance() {
    auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = told.instance_version;
    auto messenger = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = count_message;
    const char* const layer = "VK_LAYER_KHRONOS_validation";
    const char* const utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pNext = &messenger;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = info.enabledExtensionCount = 1;
    info.ppEnabledLayerNames = &layer;
    info.ppEnabledExtensionNames = &utils;
    const auto create = find<PFN_vkCreateInstance>(VK_NULL_HANDLE, "vkCreateInstance");
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult made = create(&info, nullptr, &instance);
    if (made == VK_SUCCESS) {
        find<PFN_vkCreateDebugUtilsMessengerEXT>(instance, "vkCreateDebugUtilsMessengerEXT")(instance, &messenger, nullptr,
                                                                                             &listener);
        return instance;
    }
    if (made != VK_ERROR_LAYER_NOT_PRESENT && made != VK_ERROR_EXTENSION_NOT_PRESENT) return VK_NULL_HANDLE;
    info.pNext = nullptr;
    info.enabledLayerCount = info.enabledExtensionCount = 0;
    return create(&info, nullptr, &instance) == VK_SUCCESS ? instance : VK_NULL_HANDLE;
}

// Opens a device on a host's and runs its self-test. False where there is no Vulkan device.
bool open_on_host(Told what) {
    told = what;
    modules_with = modules_without = messages = 0;
    const VkInstance instance = make_instance();
    if (instance == VK_NULL_HANDLE) return false;
    std::uint32_t count = 1;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    find<PFN_vkEnumeratePhysicalDevices>(instance, "vkEnumeratePhysicalDevices")(instance, &count, &physical);
    VkDevice device = VK_NULL_HANDLE;
    if (count == 1) {
        const float priority = 1;
        auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        find<PFN_vkCreateDevice>(instance, "vkCreateDevice")(physical, &info, nullptr, &device);
    }
    if (device != VK_NULL_HANDLE) {
        VkQueue queue = VK_NULL_HANDLE;
        find<PFN_vkGetDeviceQueue>(instance, "vkGetDeviceQueue")(device, 0, 0, &queue);
        wadi::compute::DeviceOptions options;
        options.host = {instance, physical, device, queue, reinterpret_cast<void*>(instance_call), 0, {}, false};
        {
            const auto opened = wadi::vulkan::open_device(-1, options);
            CHECK_MESSAGE(opened, opened.status().message);
            if (opened) CHECK((*opened)->capabilities().exact_float);
        }
        find<PFN_vkDestroyDevice>(instance, "vkDestroyDevice")(device, nullptr);
    }
    if (listener != VK_NULL_HANDLE) {
        find<PFN_vkDestroyDebugUtilsMessengerEXT>(instance, "vkDestroyDebugUtilsMessengerEXT")(instance, listener, nullptr);
        listener = VK_NULL_HANDLE;
    }
    find<PFN_vkDestroyInstance>(instance, "vkDestroyInstance")(instance, nullptr);
    return device != VK_NULL_HANDLE;
}

} // namespace

TEST_CASE("a host's Vulkan device gets modules with the float mode where it has it, and nobody objects") {
    std::string why;
    entry = wadi::vulkan::loader_entry(why);
    const std::uint32_t v1_1 = VK_API_VERSION_1_1, v1_2 = VK_API_VERSION_1_2, newest = ~0u;
    if (entry == nullptr || !open_on_host({v1_2, newest, VK_TRUE})) {
        MESSAGE("skipped: no Vulkan device");
        return;
    }
    CHECK(modules_with == 1); // a device of this machine that has no such mode is none that the tests know
    CHECK(modules_without == 0);
    CHECK(messages == 0);
    for (const Told& without : {Told{v1_2, newest, VK_FALSE}, Told{v1_2, v1_1, VK_TRUE}}) {
        CAPTURE(without.device_version);
        CHECK(open_on_host(without));
        CHECK(modules_with == 0);
        CHECK(modules_without == 1);
        CHECK(messages == 0);
    }
    // A host that asked for Vulkan 1.1 of a device that has more. NVIDIA's driver takes the words there, too; the validation
    // layer would object.
    CHECK(open_on_host({v1_1, newest, VK_TRUE}));
    CHECK(modules_with + modules_without == 1);
    CHECK(messages == 0);
}

} // namespace vulkan_float_modes
#endif
