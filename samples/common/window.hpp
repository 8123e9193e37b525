// A window, and the images that it shows, for hosts that draw with Vulkan.
#pragma once
#include "gpu.hpp"
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <algorithm>

namespace common {

/// Before the device, which needs `extensions`.
class Window {
  public:
    Window(const std::string& title, int width, int height) {
        if (glfwInit() == GLFW_FALSE) throw Missing("no display to open a window on");
        undo_.add([] { glfwTerminate(); });
        if (glfwVulkanSupported() == GLFW_FALSE) throw Missing("Vulkan cannot draw on this display");
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
        if (handle == nullptr) throw Missing("the window could not be made");
        uint32_t count = 0;
        const char** const needed = glfwGetRequiredInstanceExtensions(&count);
        extensions.assign(needed, needed + count);
        glfwSetWindowUserPointer(handle, this);
        glfwSetScrollCallback(handle, [](GLFWwindow* window, double, double up) {
            static_cast<Window*>(glfwGetWindowUserPointer(window))->scrolled += up;
        });
    }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle = nullptr;
    std::vector<const char*> extensions;
    double scrolled = 0;

    /// Looks at what the user has done. While the window is minimised it takes its time.
    bool closed() const {
        if (const VkExtent2D now = size(); now.width == 0 || now.height == 0) glfwWaitEventsTimeout(0.1);
        glfwPollEvents();
        return glfwWindowShouldClose(handle) == GLFW_TRUE;
    }
    /// How far the pointer went since the last call while the left button was down, in pixels.
    std::array<float, 2> dragged() {
        const double x = x_, y = y_;
        glfwGetCursorPos(handle, &x_, &y_);
        if (glfwGetMouseButton(handle, GLFW_MOUSE_BUTTON_LEFT) != GLFW_PRESS) return {};
        return {static_cast<float>(x_ - x), static_cast<float>(y_ - y)};
    }
    VkExtent2D size() const { // 0 x 0 while it is minimised
        int width = 0, height = 0;
        glfwGetFramebufferSize(handle, &width, &height);
        return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    }

  private:
    double x_ = 0, y_ = 0;
    Undo undo_;
};

class Swapchain {
  public:
    Swapchain(const Gpu& gpu, const Window& window) : gpu_(gpu) {
        check(glfwCreateWindowSurface(gpu.instance, window.handle, nullptr, &surface_), "glfwCreateWindowSurface");
        undo_.add([this] { vkDestroySurfaceKHR(gpu_.instance, surface_, nullptr); });
        VkBool32 presents = VK_FALSE;
        check(vkGetPhysicalDeviceSurfaceSupportKHR(gpu.physical, gpu.family, surface_, &presents),
              "vkGetPhysicalDeviceSurfaceSupportKHR");
        if (presents == VK_FALSE) throw Missing(gpu.name + " cannot present to this window");
        available = make_semaphore(undo_);
    }
    ~Swapchain() { vkDeviceWaitIdle(gpu_.device); }
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    VkSemaphore available = VK_NULL_HANDLE; // signalled once the image may be written

    /// Makes the next image ready; false where the window has no area. The picture before must be done.
    bool acquire(VkExtent2D size) {
        for (;;) {
            if (stale_ || size.width != size_.width || size.height != size_.height) make(size);
            if (size_.width == 0 || size_.height == 0) return false;
            const VkResult result =
                vkAcquireNextImageKHR(gpu_.device, swapchain_, UINT64_MAX, available, VK_NULL_HANDLE, &image_);
            if (result != VK_ERROR_OUT_OF_DATE_KHR) {
                check(result, "vkAcquireNextImageKHR");
                return true;
            }
            stale_ = true;
        }
    }
    /// Signal it when all is written.
    VkSemaphore drawn() const { return drawn_[image_]; }
    /// Fills the image from a picture in layout TRANSFER_SRC_OPTIMAL.
    void copy_from(VkCommandBuffer commands, VkImage picture, VkExtent2D size) const {
        const VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        change_layout(commands, images_[image_], VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, target);
        VkImageBlit blit{};
        blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        blit.srcOffsets[1] = {static_cast<int32_t>(size.width), static_cast<int32_t>(size.height), 1};
        blit.dstOffsets[1] = {static_cast<int32_t>(size_.width), static_cast<int32_t>(size_.height), 1};
        vkCmdBlitImage(commands, picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[image_], target, 1, &blit,
                       VK_FILTER_LINEAR);
        change_layout(commands, images_[image_], VK_IMAGE_ASPECT_COLOR_BIT, target, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    }
    void present() {
        const VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR, nullptr, 1, &drawn_[image_], 1, &swapchain_, &image_};
        const VkResult result = vkQueuePresentKHR(gpu_.queue, &info);
        stale_ = result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
        if (!stale_) check(result, "vkQueuePresentKHR");
    }

  private:
    const Gpu& gpu_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D size_{};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> drawn_; // one per image: presenting may still wait for it when the next frame begins
    uint32_t image_ = 0;
    bool stale_ = true;
    Undo undo_, made_;

    VkSemaphore make_semaphore(Undo& undo) const {
        VkSemaphore made = VK_NULL_HANDLE;
        const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        check(vkCreateSemaphore(gpu_.device, &info, nullptr, &made), "vkCreateSemaphore");
        undo.add([this, made] { vkDestroySemaphore(gpu_.device, made, nullptr); });
        return made;
    }
    void make(VkExtent2D size) {
        check(vkDeviceWaitIdle(gpu_.device), "vkDeviceWaitIdle");
        made_.run(); // a window may have one swapchain at a time
        VkSurfaceCapabilitiesKHR can;
        check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physical, surface_, &can),
              "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
        size_ = {std::clamp(size.width, can.minImageExtent.width, can.maxImageExtent.width),
                 std::clamp(size.height, can.minImageExtent.height, can.maxImageExtent.height)};
        if (size_.width == 0 || size_.height == 0) return;
        VkSurfaceFormatKHR formats[64];
        uint32_t count = 64;
        check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, formats),
              "vkGetPhysicalDeviceSurfaceFormatsKHR");
        // Pictures are encoded already: a format that encodes once more is the last choice.
        const VkSurfaceFormatKHR* const plain = std::find_if(formats, formats + count, [](const VkSurfaceFormatKHR& format) {
            return format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM;
        });
        const VkSurfaceFormatKHR format = plain == formats + count ? formats[0] : *plain;
        VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR, nullptr, 0, surface_};
        info.minImageCount = can.maxImageCount > 0 ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
        info.imageFormat = format.format;
        info.imageColorSpace = format.colorSpace;
        info.imageExtent = size_;
        info.imageArrayLayers = 1;
        info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        info.preTransform = can.currentTransform;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
        info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
        info.clipped = VK_TRUE;
        check(vkCreateSwapchainKHR(gpu_.device, &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");
        made_.add([this] { vkDestroySwapchainKHR(gpu_.device, swapchain_, nullptr); });
        check(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
        images_.resize(count);
        check(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, images_.data()), "vkGetSwapchainImagesKHR");
        drawn_.clear();
        for (uint32_t n = 0; n < count; ++n) drawn_.push_back(make_semaphore(made_));
        stale_ = false;
    }
};

} // namespace common
