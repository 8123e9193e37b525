// What an engine draws with: images of a Vulkan device, filled on the device or from host memory. C++ side of
// samples/vulkan_host_minimal/host.h.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>
extern "C" {
#include "samples/vulkan_host_minimal/host.h"
}

namespace paths {

/// The outputs that plugin/godot's WadiSurface3D draws.
struct Drawn {
    wadi_output output;
    VkFormat format;
    std::size_t bytes; // of a cell
};
constexpr std::array<Drawn, 3> drawn{{{WADI_OUTPUT_PACKED, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
                                      {WADI_OUTPUT_SAND_DEPTH, VK_FORMAT_R32_SFLOAT, 4},
                                      {WADI_OUTPUT_FLOW, VK_FORMAT_R32G32_SFLOAT, 8}}};
/// One block of rows without gaps per output.
using Texels = std::array<std::vector<std::byte>, drawn.size()>;

class Images {
  public:
    Images(const wadi_vulkan_host& host, int nx, int ny);
    Images(const Images&) = delete;
    Images& operator=(const Images&) = delete;
    ~Images();

    /// On the device, from a world that runs on it.
    void copy_from(wadi_world_id world);
    /// Through a buffer that the host writes; queued, not waited for.
    void upload(const Texels& texels);
    void wait() const;
    Texels contents() const;

  private:
    struct Buffer {
        VkBuffer buffer{};
        VkDeviceMemory memory{};
        std::byte* mapped = nullptr;
    };
    static constexpr std::size_t slots = 3; // uploads under way, as engines have frames
    struct Slot {
        Buffer staging;
        VkCommandBuffer commands{};
        VkFence fence{};
    };
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const;
    Buffer make_buffer() const;
    void destroy(const Buffer& buffer) const;
    void begin(VkCommandBuffer commands) const;
    void submit(VkCommandBuffer commands, VkFence fence) const;
    void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) const;
    VkBufferImageCopy region(std::size_t which) const;
    std::size_t size(std::size_t which) const { return drawn[which].bytes * width_ * height_; }

    const wadi_vulkan_host& host_;
    const std::uint32_t width_, height_;
    std::array<VkImage, drawn.size()> images_{};
    std::array<VkDeviceMemory, drawn.size()> memory_{};
    VkCommandPool pool_{};
    std::array<Slot, slots> slots_{};
    std::size_t slot_ = 0;
};

} // namespace paths
