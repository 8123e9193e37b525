#include "swapchain.hpp"
#include <algorithm>
#include <stdexcept>

namespace viewer {

Swapchain::Swapchain(const Gpu& gpu, VkSurfaceKHR surface) : gpu_(gpu), surface_(surface) {
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(gpu_.physical, gpu_.family, surface_, &presents),
          "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (presents == VK_FALSE) throw std::runtime_error(gpu_.name + " cannot present to this window");
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vkCreateSemaphore(gpu_.device, &info, nullptr, &available_), "vkCreateSemaphore");
}

Swapchain::~Swapchain() {
    vkDeviceWaitIdle(gpu_.device);
    destroy_semaphores();
    vkDestroySemaphore(gpu_.device, available_, nullptr);
    vkDestroySwapchainKHR(gpu_.device, swapchain_, nullptr);
    vkDestroySurfaceKHR(gpu_.instance, surface_, nullptr);
}

void Swapchain::destroy_semaphores() {
    for (VkSemaphore semaphore : drawn_) vkDestroySemaphore(gpu_.device, semaphore, nullptr);
    drawn_.clear();
}

void Swapchain::make(uint32_t width, uint32_t height) {
    vkDeviceWaitIdle(gpu_.device);
    VkSurfaceCapabilitiesKHR capabilities;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physical, surface_, &capabilities),
          "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    extent_ = capabilities.currentExtent.width != UINT32_MAX
                  ? capabilities.currentExtent
                  : VkExtent2D{std::clamp(width, capabilities.minImageExtent.width, capabilities.maxImageExtent.width),
                               std::clamp(height, capabilities.minImageExtent.height, capabilities.maxImageExtent.height)};
    if (extent_.width == 0 || extent_.height == 0) return;
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, nullptr), "vkGetPhysicalDeviceSurfaceFormatsKHR");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, formats.data()),
          "vkGetPhysicalDeviceSurfaceFormatsKHR");
    // Pictures are encoded already: a format that encodes once more is the last choice.
    VkSurfaceFormatKHR format = formats.at(0);
    for (const VkSurfaceFormatKHR& candidate : formats) {
        if (candidate.format == VK_FORMAT_B8G8R8A8_UNORM || candidate.format == VK_FORMAT_R8G8B8A8_UNORM) {
            format = candidate;
            break;
        }
    }
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = capabilities.maxImageCount > 0 ? std::min(capabilities.minImageCount + 1, capabilities.maxImageCount)
                                                        : capabilities.minImageCount + 1;
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = capabilities.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    check(vkCreateSwapchainKHR(gpu_.device, &info, nullptr, &made), "vkCreateSwapchainKHR");
    vkDestroySwapchainKHR(gpu_.device, swapchain_, nullptr);
    swapchain_ = made;
    check(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
    images_.resize(count);
    check(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, images_.data()), "vkGetSwapchainImagesKHR");
    destroy_semaphores();
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    drawn_.resize(count);
    for (VkSemaphore& drawn : drawn_) check(vkCreateSemaphore(gpu_.device, &semaphore, nullptr, &drawn), "vkCreateSemaphore");
    stale_ = false;
}

void Swapchain::acquire(uint32_t width, uint32_t height) {
    acquired_ = false;
    for (int attempt = 0; attempt < 2 && !acquired_; ++attempt) {
        if (stale_ || extent_.width != width || extent_.height != height) {
            stale_ = true;
            make(width, height);
        }
        if (stale_) return;
        const VkResult result = vkAcquireNextImageKHR(gpu_.device, swapchain_, UINT64_MAX, available_, VK_NULL_HANDLE, &image_);
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            stale_ = true;
            continue;
        }
        check(result, "vkAcquireNextImageKHR");
        stale_ = result == VK_SUBOPTIMAL_KHR;
        acquired_ = true;
    }
}

Submission Swapchain::submission() const {
    Submission submission;
    if (!acquired_) return submission;
    submission.wait = available_;
    submission.signal = drawn_[image_];
    return submission;
}

void Swapchain::copy_from(const Image& picture, VkCommandBuffer commands) const {
    if (!acquired_) return;
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = images_[image_];
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[1] = {static_cast<int32_t>(picture.width), static_cast<int32_t>(picture.height), 1};
    blit.dstOffsets[1] = {static_cast<int32_t>(extent_.width), static_cast<int32_t>(extent_.height), 1};
    vkCmdBlitImage(commands, picture.handle, VK_IMAGE_LAYOUT_GENERAL, images_[image_], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                   &blit, VK_FILTER_LINEAR);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = 0;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
}

void Swapchain::present() {
    if (!acquired_) return;
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn_[image_];
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &image_;
    const VkResult result = vkQueuePresentKHR(gpu_.queue, &info);
    acquired_ = false;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        stale_ = true;
    else
        check(result, "vkQueuePresentKHR");
}

} // namespace viewer
