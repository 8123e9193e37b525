// The viewer's own Vulkan instance and device, shared with the plugin, and what it makes on them.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan.h>

namespace viewer {

/// Throws std::runtime_error naming the call.
void check(VkResult result, const char* what);

struct GpuChoice {
    int device = -1; // index of vkEnumeratePhysicalDevices; -1 = a real GPU first
    bool validate = false;
    bool graphics = false; // needs a queue that draws, for the panel
    std::vector<const char*> instance_extensions;
    bool swapchain = false;
};

class Gpu {
  public:
    explicit Gpu(const GpuChoice& choice);
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t family = 0, families = 0; // of the one queue that all work goes to; how many the device has
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    std::string name;
    double nanoseconds_per_tick = 0; // 0 = the queue has no timestamps
    bool graphics = false;
    bool discrete = false; // a card of its own, that a fine grid runs on
    bool shares_with_cuda = false;

    void wait_idle() const { check(vkQueueWaitIdle(queue), "vkQueueWaitIdle"); }
    uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const;
    /// Runs commands once and waits.
    template <class Record> void run_once(Record&& record) const {
        const VkCommandBuffer commands = begin_once();
        record(commands);
        finish_once(commands);
    }

  private:
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkCommandBuffer begin_once() const;
    void finish_once(VkCommandBuffer commands) const;
};

/// Messages of the validation layers so far; each was printed. Any of them is a bug.
uint32_t validation_messages();

/// Names of the devices in Vulkan's order.
std::vector<std::string> list_gpus();

class Buffer {
  public:
    Buffer() = default;
    Buffer(const Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage, bool for_host);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer();
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
    void* mapped = nullptr;

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    void swap(Buffer& other) noexcept;
};

/// A two-dimensional image in layout GENERAL for its whole life.
class Image {
  public:
    Image() = default;
    /// Of three dimensions where depth > 1.
    Image(const Gpu& gpu, uint32_t width, uint32_t height, VkFormat format, VkImageUsageFlags usage, uint32_t depth = 1);
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Image();
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    uint32_t width = 0, height = 0;

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    void swap(Image& other) noexcept;
};

} // namespace viewer
