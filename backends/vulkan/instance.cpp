#include "backends/vulkan/instance.hpp"
#include "backends/vulkan/loader.hpp"
#include <algorithm>
#include <cstring>
#include <mutex>

namespace wadi::vulkan {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

// volk keeps the loader's pointers in globals (ours alone, hidden); instances may be made by several threads.
std::mutex volk_mutex;

template <class F> void find(F& function, PFN_vkGetInstanceProcAddr entry, VkInstance instance, const char* name) {
    function = reinterpret_cast<F>(entry(instance, name));
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    Messages& messages = *static_cast<Messages*>(user);
    const bool error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
    if ((types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0) ++messages.validation;
    try {
        if (messages.log) messages.log(error ? 0 : 1, std::string("vulkan: ") + data->pMessage);
    } catch (...) {
        // No exception may unwind into the driver; the message is counted all the same.
        return VK_FALSE;
    }
    return VK_FALSE;
}

bool has_layer(PFN_vkEnumerateInstanceLayerProperties enumerate, const char* name) {
    std::uint32_t count = 0;
    if (enumerate(&count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkLayerProperties> layers(count);
    if (enumerate(&count, layers.data()) < VK_SUCCESS) return false;
    return std::any_of(layers.begin(), layers.end(), [&](const auto& l) { return std::strcmp(l.layerName, name) == 0; });
}

Status creation_error(VkResult result) {
    std::string message = "vkCreateInstance: " + std::string(result_name(result));
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        message += " (no Vulkan driver is installed; Debian package mesa-vulkan-drivers has one)";
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return error(memory ? Code::out_of_memory : Code::not_supported, message);
}

int rank(compute::DeviceKind kind) {
    switch (kind) {
    case compute::DeviceKind::discrete_gpu:
        return 0;
    case compute::DeviceKind::integrated_gpu:
        return 1;
    case compute::DeviceKind::virtual_gpu:
        return 2;
    default:
        return 3;
    }
}

compute::DeviceKind device_kind(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return compute::DeviceKind::discrete_gpu;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return compute::DeviceKind::integrated_gpu;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return compute::DeviceKind::software_gpu;
    default:
        return compute::DeviceKind::virtual_gpu;
    }
}

// A compute-only family runs beside the host's graphics and is faster for stages with shared memory (measured on an H100:
// 16 us against 25 us a pass); any family with compute will do.
bool choose_queue_family(const InstanceApi& api, PhysicalDevice& device) {
    std::uint32_t count = 0;
    api.GetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    api.GetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
    bool found = false;
    for (std::uint32_t family = 0; family < count; ++family) {
        const VkQueueFlags flags = families[family].queueFlags;
        if (families[family].queueCount == 0 || (flags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
        const bool compute_only = (flags & VK_QUEUE_GRAPHICS_BIT) == 0;
        if (found && !compute_only) continue;
        device.queue_family = family;
        device.timestamp_bits = families[family].timestampValidBits;
        found = true;
        if (compute_only) break;
    }
    return found;
}

std::uint64_t largest_device_heap(const InstanceApi& api, VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory{};
    api.GetPhysicalDeviceMemoryProperties(device, &memory);
    std::uint64_t bytes = 0;
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap) {
        if ((memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
            bytes = std::max<std::uint64_t>(bytes, memory.memoryHeaps[heap].size);
        }
    }
    return bytes;
}

void fill_info(const InstanceApi& api, const VkPhysicalDeviceProperties& properties, PhysicalDevice& device) {
    device.info.backend = "vulkan";
    device.info.name = properties.deviceName;
    device.info.kind = device_kind(properties.deviceType);
    device.info.memory_bytes = largest_device_heap(api, device.handle);
}

// The loader unloads the drivers with the last instance, and NVIDIA's cannot be loaded any number of times: each time it takes
// static thread-local storage that is never given back (seen to fail after some 20 devices). One instance that is never destroyed
// keeps them.
void keep_drivers_loaded(PFN_vkCreateInstance create_instance) {
    static const bool kept = [&] {
        auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
        application.apiVersion = required_version;
        auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
        info.pApplicationInfo = &application;
        VkInstance keeper = VK_NULL_HANDLE;
        return create_instance(&info, nullptr, &keeper) == VK_SUCCESS;
    }();
    static_cast<void>(kept);
}

} // namespace

Result<std::unique_ptr<Instance>> Instance::create(const compute::DeviceOptions& options) {
    std::unique_ptr<Instance> instance(new Instance);
    instance->messages_.log = options.log;
    if (Status s = instance->open(options); !s) return s;
    return instance;
}

Status Instance::open(const compute::DeviceOptions& options) {
    std::string why;
    {
        const std::lock_guard lock(volk_mutex);
        entry_ = loader_entry(why);
    }
    if (entry_ == nullptr) return error(Code::not_supported, why);
    PFN_vkEnumerateInstanceVersion enumerate_version = nullptr;
    PFN_vkEnumerateInstanceLayerProperties enumerate_layers = nullptr;
    PFN_vkCreateInstance create_instance = nullptr;
    find(enumerate_version, entry_, VK_NULL_HANDLE, "vkEnumerateInstanceVersion");
    find(enumerate_layers, entry_, VK_NULL_HANDLE, "vkEnumerateInstanceLayerProperties");
    find(create_instance, entry_, VK_NULL_HANDLE, "vkCreateInstance");
    std::uint32_t version = VK_API_VERSION_1_0;
    if (enumerate_version != nullptr) enumerate_version(&version);
    if (version < required_version || enumerate_layers == nullptr || create_instance == nullptr) {
        return error(Code::not_supported, "the Vulkan loader is older than Vulkan 1.1");
    }
    if (options.validate && !has_layer(enumerate_layers, validation_layer)) {
        return error(Code::not_supported, std::string("validation was asked for, but the layer ") + validation_layer +
                                              " is not installed (Debian package vulkan-validationlayers)");
    }

    auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pEngineName = "Wadi";
    application.apiVersion = required_version;
    const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    auto features = vk_struct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    auto messenger = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    messenger.pNext = &features;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = on_message;
    messenger.pUserData = &messages_;
    // The layer brings both extensions; without it neither is needed.
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    if (options.validate) {
        info.pNext = &messenger;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    keep_drivers_loaded(create_instance);
    if (const VkResult r = create_instance(&info, nullptr, &handle_); r != VK_SUCCESS) return creation_error(r);

    find_calls();
    if (options.validate) {
        find(api_.CreateDebugUtilsMessengerEXT, entry_, handle_, "vkCreateDebugUtilsMessengerEXT");
        find(api_.DestroyDebugUtilsMessengerEXT, entry_, handle_, "vkDestroyDebugUtilsMessengerEXT");
        messenger.pNext = nullptr;
        if (const VkResult r = api_.CreateDebugUtilsMessengerEXT(handle_, &messenger, nullptr, &messenger_); r != VK_SUCCESS) {
            return error(Code::internal, "vkCreateDebugUtilsMessengerEXT: " + std::string(result_name(r)));
        }
    }
    return ok_status();
}

void Instance::find_calls() {
    find(api_.DestroyInstance, entry_, handle_, "vkDestroyInstance");
    find(api_.EnumeratePhysicalDevices, entry_, handle_, "vkEnumeratePhysicalDevices");
    find(api_.GetPhysicalDeviceProperties2, entry_, handle_, "vkGetPhysicalDeviceProperties2");
    find(api_.GetPhysicalDeviceFeatures2, entry_, handle_, "vkGetPhysicalDeviceFeatures2");
    find(api_.GetPhysicalDeviceMemoryProperties, entry_, handle_, "vkGetPhysicalDeviceMemoryProperties");
    find(api_.GetPhysicalDeviceQueueFamilyProperties, entry_, handle_, "vkGetPhysicalDeviceQueueFamilyProperties");
    find(api_.EnumerateDeviceExtensionProperties, entry_, handle_, "vkEnumerateDeviceExtensionProperties");
    find(api_.CreateDevice, entry_, handle_, "vkCreateDevice");
}

Result<std::unique_ptr<Instance>> Instance::adopt(const compute::HostDevice& host, const compute::DeviceOptions& options) {
    if (host.instance == nullptr || host.physical_device == nullptr || host.device == nullptr || host.queue == nullptr ||
        host.get_instance_proc_addr == nullptr) {
        return error(Code::bad_argument, "the host's Vulkan device lacks a handle: instance, physical device, device, queue and "
                                         "vkGetInstanceProcAddr must all be given");
    }
    std::unique_ptr<Instance> instance(new Instance);
    instance->messages_.log = options.log;
    instance->ours_ = false;
    instance->entry_ = reinterpret_cast<PFN_vkGetInstanceProcAddr>(host.get_instance_proc_addr);
    instance->handle_ = static_cast<VkInstance>(host.instance);
    instance->find_calls();
    if (instance->api_.GetPhysicalDeviceProperties2 == nullptr)
        return error(Code::not_supported, "the host's Vulkan instance is older than Vulkan 1.1");
    return instance;
}

Instance::~Instance() {
    if (handle_ == VK_NULL_HANDLE || !ours_) return;
    if (messenger_ != VK_NULL_HANDLE) api_.DestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
    api_.DestroyInstance(handle_, nullptr);
}

Result<PhysicalDevice> Instance::describe(VkPhysicalDevice handle, std::uint32_t queue_family) const {
    PhysicalDevice device;
    device.handle = handle;
    device.queue_family = queue_family;
    auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    api_.GetPhysicalDeviceProperties2(handle, &properties);
    fill_info(api_, properties.properties, device);
    if (properties.properties.apiVersion < required_version)
        return error(Code::not_supported, device.info.name + " is older than Vulkan 1.1");
    std::uint32_t count = 0;
    api_.GetPhysicalDeviceQueueFamilyProperties(handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    api_.GetPhysicalDeviceQueueFamilyProperties(handle, &count, families.data());
    if (queue_family >= count || (families[queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
        return error(Code::not_supported,
                     "queue family " + std::to_string(queue_family) + " of " + device.info.name + " has no compute");
    }
    device.timestamp_bits = families[queue_family].timestampValidBits;
    return device;
}

std::vector<PhysicalDevice> Instance::devices(std::string& why_none) const {
    std::uint32_t count = 0;
    VkResult result = api_.EnumeratePhysicalDevices(handle_, &count, nullptr);
    std::vector<VkPhysicalDevice> handles(count);
    if (result == VK_SUCCESS && count > 0) result = api_.EnumeratePhysicalDevices(handle_, &count, handles.data());
    if (result < VK_SUCCESS) {
        why_none = "vkEnumeratePhysicalDevices: " + std::string(result_name(result));
        return {};
    }
    handles.resize(count);
    why_none = handles.empty() ? "no Vulkan driver reports a device" : "no Vulkan device has Vulkan 1.1 and a compute queue";
    std::vector<PhysicalDevice> found;
    for (const VkPhysicalDevice handle : handles) {
        PhysicalDevice device;
        device.handle = handle;
        auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
        api_.GetPhysicalDeviceProperties2(handle, &properties);
        if (properties.properties.apiVersion < required_version || !choose_queue_family(api_, device)) continue;
        fill_info(api_, properties.properties, device);
        found.push_back(std::move(device));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return rank(a.info.kind) < rank(b.info.kind); });
    for (std::size_t n = 0; n < found.size(); ++n) found[n].info.index = static_cast<int>(n);
    if (!found.empty()) why_none.clear();
    return found;
}

void Instance::load(VolkDeviceTable& table, VkDevice device) const {
    const std::lock_guard lock(volk_mutex);
    volkInitializeCustom(entry_);
    volkLoadInstanceOnly(handle_);
    volkLoadDeviceTable(&table, device);
}

} // namespace wadi::vulkan
