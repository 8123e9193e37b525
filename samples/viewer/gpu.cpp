#include "gpu.hpp"
#include <atomic>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace viewer {
namespace {

std::atomic<uint32_t> message_count{0};

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    ++message_count;
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

VkInstance make_instance(const GpuChoice& choice) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "wadi-viewer";
    application.apiVersion = VK_API_VERSION_1_2;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    std::vector<const char*> extensions = choice.instance_extensions;
    if (choice.validate) {
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
    }
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult made = vkCreateInstance(&info, nullptr, &instance);
    if (made == VK_ERROR_LAYER_NOT_PRESENT)
        throw std::runtime_error(
            "--validate needs the package vulkan-validationlayers: VK_LAYER_KHRONOS_validation is not present");
    check(made, "vkCreateInstance");
    return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

VkPhysicalDevice choose(VkInstance instance, int index) {
    const std::vector<VkPhysicalDevice> devices = physical_devices(instance);
    if (devices.empty()) throw std::runtime_error("no Vulkan device; mesa-vulkan-drivers brings one that runs on the processor");
    if (index >= static_cast<int>(devices.size()))
        throw std::runtime_error("gpu: there is no device " + std::to_string(index) + "; allowed are 0 ... " +
                                 std::to_string(devices.size() - 1) + " (--list-gpus)");
    if (index >= 0) return devices[static_cast<std::size_t>(index)];
    const auto rank = [](VkPhysicalDevice device) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        switch (properties.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 1;
        default:
            return 0;
        }
    };
    VkPhysicalDevice best = devices[0];
    for (VkPhysicalDevice device : devices) {
        if (rank(device) > rank(best)) best = device;
    }
    return best;
}

bool has_extension(VkPhysicalDevice device, const char* name) {
    uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
          "vkEnumerateDeviceExtensionProperties");
    for (const VkExtensionProperties& extension : extensions) {
        if (std::strcmp(extension.extensionName, name) == 0) return true;
    }
    return false;
}

} // namespace

void check(VkResult result, const char* what) {
    if (result < VK_SUCCESS) throw std::runtime_error(std::string(what) + " failed: VkResult " + std::to_string(result));
}

uint32_t validation_messages() { return message_count; }

std::vector<std::string> list_gpus() {
    const VkInstance instance = make_instance({});
    std::vector<std::string> names;
    for (VkPhysicalDevice device : physical_devices(instance)) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        names.emplace_back(properties.deviceName);
    }
    vkDestroyInstance(instance, nullptr);
    return names;
}

Gpu::Gpu(const GpuChoice& choice) {
    instance = make_instance(choice);
    if (choice.validate) {
        VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
        info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        info.pfnUserCallback = on_message;
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
        check(create(instance, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
    }
    physical = choose(instance, choice.device);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    name = properties.deviceName;
    discrete = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;

    vkGetPhysicalDeviceQueueFamilyProperties(physical, &families, nullptr);
    std::vector<VkQueueFamilyProperties> found(families);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &families, found.data());
    family = families;
    for (const VkQueueFlags wanted :
         {VkQueueFlags{VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT}, VkQueueFlags{VK_QUEUE_COMPUTE_BIT}}) {
        for (uint32_t n = 0; n < families && family == families; ++n) {
            if ((found[n].queueFlags & wanted) == wanted) family = n;
        }
    }
    if (family == families) throw std::runtime_error(name + " has no queue that computes");
    graphics = (found[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
    if (choice.graphics && !graphics)
        throw std::runtime_error(
            name + " has no queue that draws and computes, which window and panel need; --offscreen without --panel works");
    if (found[family].timestampValidBits > 0) nanoseconds_per_tick = static_cast<double>(properties.limits.timestampPeriod);

    std::vector<const char*> extensions;
    if (choice.swapchain) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    shares_with_cuda = has_extension(physical, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME) &&
                       has_extension(physical, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
    if (shares_with_cuda) {
        extensions.push_back(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
        extensions.push_back(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
    }
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue_info.queueFamilyIndex = family;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkPhysicalDeviceTimelineSemaphoreFeatures timeline{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES};
    timeline.timelineSemaphore = VK_TRUE;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &timeline};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool_info.queueFamilyIndex = family;
    check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
}

Gpu::~Gpu() {
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyDevice(device, nullptr);
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger_, nullptr);
    }
    vkDestroyInstance(instance, nullptr);
}

uint32_t Gpu::memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t n = 0; n < memory.memoryTypeCount; ++n) {
        if ((allowed >> n & 1u) != 0 && (memory.memoryTypes[n].propertyFlags & wanted) == wanted) return n;
    }
    throw std::runtime_error("no memory of the kind needed on " + name);
}

VkCommandBuffer Gpu::begin_once() const {
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands;
    check(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    return commands;
}

void Gpu::finish_once(VkCommandBuffer commands) const {
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    wait_idle();
    vkFreeCommandBuffers(device, pool, 1, &commands);
}

Buffer::Buffer(const Gpu& gpu, VkDeviceSize size, VkBufferUsageFlags usage, bool for_host) : bytes(size), device_(gpu.device) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = usage;
    check(vkCreateBuffer(device_, &info, nullptr, &handle), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, handle, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = gpu.memory_type(needs.memoryTypeBits, for_host ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                                                    VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                                                              : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory_), "vkAllocateMemory");
    check(vkBindBufferMemory(device_, handle, memory_, 0), "vkBindBufferMemory");
    if (for_host) check(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
}

Buffer::~Buffer() {
    if (device_ == VK_NULL_HANDLE) return;
    vkDestroyBuffer(device_, handle, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(bytes, other.bytes);
    std::swap(mapped, other.mapped);
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
}

Image::Image(const Gpu& gpu, uint32_t across, uint32_t down, VkFormat format, VkImageUsageFlags usage, uint32_t depth)
    : width(across), height(down), device_(gpu.device) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {across, down, depth};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    check(vkCreateImage(device_, &info, nullptr, &handle), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, handle, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = gpu.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory_), "vkAllocateMemory");
    check(vkBindImageMemory(device_, handle, memory_, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view_info.image = handle;
    view_info.viewType = depth > 1 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = format;
    view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device_, &view_info, nullptr, &view), "vkCreateImageView");
    gpu.run_once([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = handle;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 0,
                             nullptr, 1, &barrier);
    });
}

Image::~Image() {
    if (device_ == VK_NULL_HANDLE) return;
    vkDestroyImageView(device_, view, nullptr);
    vkDestroyImage(device_, handle, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

void Image::swap(Image& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(view, other.view);
    std::swap(width, other.width);
    std::swap(height, other.height);
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
}

} // namespace viewer
