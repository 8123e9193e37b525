// A Vulkan instance of our own: validation, messages, and the list of devices that can run stages.
#pragma once
#include "backends/common/backend.hpp"
#include "backends/vulkan/api.hpp"
#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace wadi::vulkan {

/// The instance-level calls of this backend. The debug messenger's are null without VK_EXT_debug_utils.
struct InstanceApi {
    PFN_vkDestroyInstance DestroyInstance = nullptr;
    PFN_vkEnumeratePhysicalDevices EnumeratePhysicalDevices = nullptr;
    PFN_vkGetPhysicalDeviceProperties2 GetPhysicalDeviceProperties2 = nullptr;
    PFN_vkGetPhysicalDeviceFeatures2 GetPhysicalDeviceFeatures2 = nullptr;
    PFN_vkGetPhysicalDeviceMemoryProperties GetPhysicalDeviceMemoryProperties = nullptr;
    PFN_vkGetPhysicalDeviceQueueFamilyProperties GetPhysicalDeviceQueueFamilyProperties = nullptr;
    PFN_vkEnumerateDeviceExtensionProperties EnumerateDeviceExtensionProperties = nullptr;
    PFN_vkCreateDevice CreateDevice = nullptr;
    PFN_vkCreateDebugUtilsMessengerEXT CreateDebugUtilsMessengerEXT = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT DestroyDebugUtilsMessengerEXT = nullptr;
};

/// Where driver and validation messages go; drivers call it from any thread.
struct Messages {
    std::function<void(int severity, const std::string& message)> log;
    std::atomic<std::uint64_t> validation{0}; // warnings and errors from validation layers
};

/// A physical device with a compute queue and Vulkan 1.1.
struct PhysicalDevice {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0; // compute only where there is one, else any with compute
    std::uint32_t timestamp_bits = 0;
    backends::DeviceInfo info;
};

class Instance {
  public:
    /// Errors: not_supported (no loader or driver, or validation asked for and its layer absent), out_of_memory, internal.
    static Result<std::unique_ptr<Instance>> create(const compute::DeviceOptions& options);
    /// The host's own instance: never destroyed here. Errors: bad_argument (a null handle).
    static Result<std::unique_ptr<Instance>> adopt(const compute::HostDevice& host, const compute::DeviceOptions& options);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    const InstanceApi& api() const { return api_; }
    Messages& messages() { return messages_; }
    /// Best first: discrete, integrated, virtual, software GPUs. Empty with a reason in `why_none`.
    std::vector<PhysicalDevice> devices(std::string& why_none) const;
    /// One physical device with a given queue family. Errors: not_supported (older than Vulkan 1.1, no compute there).
    Result<PhysicalDevice> describe(VkPhysicalDevice handle, std::uint32_t queue_family) const;
    /// Fills the table of device-level calls.
    void load(VolkDeviceTable& table, VkDevice device) const;

  private:
    Instance() = default;
    Status open(const compute::DeviceOptions& options);
    void find_calls();

    PFN_vkGetInstanceProcAddr entry_ = nullptr;
    VkInstance handle_ = VK_NULL_HANDLE;
    bool ours_ = true;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    InstanceApi api_;
    Messages messages_;
};

} // namespace wadi::vulkan
