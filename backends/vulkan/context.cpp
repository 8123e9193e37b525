#include "backends/vulkan/context.hpp"
#include "shaders/stage_table.hpp"
#include <algorithm>
#include <cstring>

namespace wadi::vulkan {
namespace {

Result<PhysicalDevice> choose(const Instance& instance, int index) {
    std::string why;
    std::vector<PhysicalDevice> devices = instance.devices(why);
    if (devices.empty()) return error(Code::not_found, "no Vulkan device: " + why);
    const int wanted = index < 0 ? 0 : index;
    if (wanted < static_cast<int>(devices.size())) return std::move(devices[static_cast<std::size_t>(wanted)]);
    std::string list;
    for (const auto& d : devices) list += (list.empty() ? "" : ", ") + std::to_string(d.info.index) + " = " + d.info.name;
    return error(Code::not_found, "no Vulkan device " + std::to_string(index) + "; there is " + list);
}

bool has_extension(const InstanceApi& api, VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    if (api.EnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkExtensionProperties> extensions(count);
    if (api.EnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) < VK_SUCCESS) return false;
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

std::string version_text(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

void read_properties(Context& c, const PhysicalDevice& chosen) {
    const InstanceApi& api = c.instance->api();
    const bool names_driver = has_extension(api, chosen.handle, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME);
    auto driver = vk_struct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto sizes = vk_struct<VkPhysicalDeviceMaintenance3Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES);
    sizes.pNext = names_driver ? &driver : nullptr;
    auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &sizes;
    api.GetPhysicalDeviceProperties2(chosen.handle, &properties);
    api.GetPhysicalDeviceMemoryProperties(chosen.handle, &c.memory);

    c.limits.api_version = properties.properties.apiVersion;
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    for (int axis = 0; axis < 2; ++axis) {
        c.limits.group_count[axis] = limits.maxComputeWorkGroupCount[axis];
    }
    const auto number = [](std::uint32_t limit) { return static_cast<int>(std::min(limit, std::uint32_t{1} << 30)); };
    auto& groups = c.capabilities.groups;
    groups = {number(limits.maxComputeWorkGroupSize[0]), number(limits.maxComputeWorkGroupSize[1]),
              number(limits.maxComputeWorkGroupInvocations), 64};
    c.limits.storage_buffers = std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
    c.limits.timestamp_nanoseconds = static_cast<double>(limits.timestampPeriod);
    const std::uint32_t bits = chosen.timestamp_bits;
    c.limits.timestamp_mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;

    std::size_t bindings = 0;
    for (const auto& stage : compute::stage_table()) bindings = std::max(bindings, stage.fused() ? stage.bindings.size() : 0);
    c.capabilities.fused_stages = groups.x >= int{compute::fused_group_x} && groups.y >= int{compute::fused_group_y} &&
                                  groups.threads >= int{compute::fused_group_x * compute::fused_group_y} &&
                                  limits.maxComputeSharedMemorySize >= compute::fused_shared_bytes &&
                                  c.limits.storage_buffers >= bindings;
    // H100: below it too few groups fill the GPU (engine/step/README.md). A software device gains nothing.
    const bool gpu = chosen.info.kind != compute::DeviceKind::software_gpu && chosen.info.kind != compute::DeviceKind::cpu;
    c.tuning.fused_gain_cells = gpu ? std::int64_t{1} << 18 : 0;
    c.tuning.tiles_gain_cells = gpu ? std::int64_t{1} << 20 : 0;
    c.capabilities.backend = "vulkan";
    c.capabilities.name = chosen.info.name;
    c.capabilities.driver = names_driver ? std::string(driver.driverName) + " " + driver.driverInfo
                                         : "driver version " + version_text(properties.properties.driverVersion);
    c.capabilities.driver += ", Vulkan " + version_text(properties.properties.apiVersion);
    c.capabilities.kind = chosen.info.kind;
    c.capabilities.memory_bytes = chosen.info.memory_bytes;
    // Whole words: fills work on words.
    c.capabilities.largest_buffer_bytes =
        std::min<std::uint64_t>({limits.maxStorageBufferRange, sizes.maxMemoryAllocationSize, chosen.info.memory_bytes}) / 4 * 4;
    c.capabilities.timestamps = c.limits.timestamp_mask != 0;
}

// Timeline semaphores by extension: drivers of Vulkan 1.2 and later keep listing it.
bool has_timeline(const InstanceApi& api, VkPhysicalDevice device) {
    if (!has_extension(api, device, VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME)) return false;
    auto timeline =
        vk_struct<VkPhysicalDeviceTimelineSemaphoreFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES);
    auto features = vk_struct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    features.pNext = &timeline;
    api.GetPhysicalDeviceFeatures2(device, &features);
    return timeline.timelineSemaphore == VK_TRUE;
}

// Whether shaders may ask that signs of zeros, infinities and NaN be kept, which is what turns fast math off.
bool preserves_signed_zero(const InstanceApi& api, VkPhysicalDevice device) {
    auto modes = vk_struct<VkPhysicalDeviceFloatControlsProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES);
    auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &modes;
    api.GetPhysicalDeviceProperties2(device, &properties);
    return modes.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE;
}

VkResult create_device(Context& c) {
    const InstanceApi& api = c.instance->api();
    const float priority = 1.0f;
    auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = c.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    auto timeline =
        vk_struct<VkPhysicalDeviceTimelineSemaphoreFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES);
    timeline.timelineSemaphore = VK_TRUE;
    std::vector<const char*> extensions;
    if (c.float_modes) extensions.push_back(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME);
    auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    if (c.timeline) {
        info.pNext = &timeline;
        extensions.push_back(VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME);
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    return api.CreateDevice(c.physical, &info, nullptr, &c.device);
}

// Runs on the host's device and queue. Its timeline semaphores may be those of Vulkan 1.2 or of the extension.
Result<std::unique_ptr<Context>> adopt_device(std::unique_ptr<Context> context, const compute::HostDevice& host) {
    Context& c = *context;
    c.device = static_cast<VkDevice>(host.device);
    c.queue = static_cast<VkQueue>(host.queue);
    c.timeline = host.timeline_semaphore;
    for (const std::uint32_t family : host.sharing_families) {
        if (family != host.queue_family) c.sharing_families.push_back(family);
    }
    if (!c.sharing_families.empty()) c.sharing_families.push_back(host.queue_family);
    c.instance->load(c.vk, c.device);
    // A host may have asked for Vulkan 1.1 of a device that has 1.2: calls of 1.2 are then missing, at least where a validation
    // layer would object (NVIDIA's driver has them, and takes such modules).
    c.float_modes = c.limits.api_version >= VK_API_VERSION_1_2 && c.vk.vkGetSemaphoreCounterValue != nullptr &&
                    preserves_signed_zero(c.instance->api(), c.physical);
    if (c.vk.vkGetSemaphoreCounterValueKHR == nullptr) c.vk.vkGetSemaphoreCounterValueKHR = c.vk.vkGetSemaphoreCounterValue;
    if (c.vk.vkWaitSemaphoresKHR == nullptr) c.vk.vkWaitSemaphoresKHR = c.vk.vkWaitSemaphores;
    if (c.timeline && (c.vk.vkGetSemaphoreCounterValueKHR == nullptr || c.vk.vkWaitSemaphoresKHR == nullptr))
        return error(Code::not_supported, "the host's Vulkan device has no timeline semaphores, though the host says so");
    return context;
}

} // namespace

Result<std::unique_ptr<Context>> Context::open(int index, const compute::DeviceOptions& options) {
    auto context = std::make_unique<Context>();
    Context& c = *context;
    c.options = options;
    const auto& host = options.host;
    auto instance = host ? Instance::adopt(*host, options) : Instance::create(options);
    if (!instance) return instance.status();
    c.instance = std::move(*instance);
    auto chosen = host ? c.instance->describe(static_cast<VkPhysicalDevice>(host->physical_device), host->queue_family)
                       : choose(*c.instance, index);
    if (!chosen) return chosen.status();
    c.physical = chosen->handle;
    c.queue_family = chosen->queue_family;
    read_properties(c, *chosen);
    if (host) return adopt_device(std::move(context), *host);
    c.timeline = has_timeline(c.instance->api(), c.physical);
    c.float_modes = has_extension(c.instance->api(), c.physical, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME) &&
                    preserves_signed_zero(c.instance->api(), c.physical);
    if (Status s = c.check(create_device(c), "vkCreateDevice", c.capabilities.name); !s) return s;
    c.instance->load(c.vk, c.device);
    c.vk.vkGetDeviceQueue(c.device, c.queue_family, 0, &c.queue);
    return context;
}

Context::~Context() {
    if (left) static_cast<void>(instance.release());
    if (device != VK_NULL_HANDLE && !options.host) vk.vkDestroyDevice(device, nullptr);
}

Status Context::check(VkResult result, std::string_view what, std::string_view label) {
    if (result == VK_SUCCESS) return ok_status();
    if (result == VK_ERROR_DEVICE_LOST) {
        lost = true;
        return lost_status();
    }
    std::string message(what);
    if (!label.empty()) message.append(" of '").append(label).append("'");
    message.append(": ").append(result_name(result));
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_TOO_MANY_OBJECTS:
        return error(Code::out_of_memory, message);
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return error(Code::not_supported, message);
    default:
        return error(Code::internal, message);
    }
}

Status Context::lost_status() const {
    return error(Code::device_lost, "the Vulkan device " + capabilities.name + " is lost; close it and open it again");
}

void Context::wait_idle() {
    constexpr int tries = 3; // memory of the host may come back
    VkResult r = VK_ERROR_OUT_OF_HOST_MEMORY;
    for (int n = 0; n < tries && r != VK_SUCCESS && r != VK_ERROR_DEVICE_LOST; ++n) r = vk.vkQueueWaitIdle(queue);
    if (r == VK_SUCCESS) return;
    lost = true;
    if (r != VK_ERROR_DEVICE_LOST) leave_all(); // nobody knows what the device still uses
}

// A leak, in place of a driver whose thread works on with memory that is gone.
void Context::leave_all() {
    left = true;
    vk.vkDestroyBuffer = [](VkDevice, VkBuffer, const VkAllocationCallbacks*) {};
    vk.vkDestroyCommandPool = [](VkDevice, VkCommandPool, const VkAllocationCallbacks*) {};
    vk.vkDestroyDescriptorPool = [](VkDevice, VkDescriptorPool, const VkAllocationCallbacks*) {};
    vk.vkDestroyDescriptorSetLayout = [](VkDevice, VkDescriptorSetLayout, const VkAllocationCallbacks*) {};
    vk.vkDestroyDevice = [](VkDevice, const VkAllocationCallbacks*) {};
    vk.vkDestroyFence = [](VkDevice, VkFence, const VkAllocationCallbacks*) {};
    vk.vkDestroyPipeline = [](VkDevice, VkPipeline, const VkAllocationCallbacks*) {};
    vk.vkDestroyPipelineCache = [](VkDevice, VkPipelineCache, const VkAllocationCallbacks*) {};
    vk.vkDestroyPipelineLayout = [](VkDevice, VkPipelineLayout, const VkAllocationCallbacks*) {};
    vk.vkDestroyQueryPool = [](VkDevice, VkQueryPool, const VkAllocationCallbacks*) {};
    vk.vkDestroySemaphore = [](VkDevice, VkSemaphore, const VkAllocationCallbacks*) {};
    vk.vkDestroyShaderModule = [](VkDevice, VkShaderModule, const VkAllocationCallbacks*) {};
    vk.vkFreeMemory = [](VkDevice, VkDeviceMemory, const VkAllocationCallbacks*) {};
}

std::string_view result_name(VkResult result) {
    switch (result) {
    case VK_SUCCESS:
        return "VK_SUCCESS";
    case VK_NOT_READY:
        return "VK_NOT_READY";
    case VK_TIMEOUT:
        return "VK_TIMEOUT";
    case VK_INCOMPLETE:
        return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FRAGMENTED_POOL:
        return "VK_ERROR_FRAGMENTED_POOL";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_INVALID_SHADER_NV:
        return "VK_ERROR_INVALID_SHADER_NV";
    case VK_ERROR_UNKNOWN:
        return "VK_ERROR_UNKNOWN";
    default:
        return "an unnamed VkResult";
    }
}

} // namespace wadi::vulkan
