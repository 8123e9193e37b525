// The window's images. Pictures are copied to them, scaled where the window has just changed its size.
#pragma once
#include "gpu.hpp"
#include "simulation.hpp"

namespace viewer {

class Swapchain {
  public:
    /// Takes the surface over.
    Swapchain(const Gpu& gpu, VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Makes the next image ready; where there is none (a window without area) nothing is shown until the next call.
    void acquire(uint32_t width, uint32_t height);
    Submission submission() const;
    void copy_from(const Image& picture, VkCommandBuffer commands) const;
    void present();

  private:
    const Gpu& gpu_;
    VkSurfaceKHR surface_;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> drawn_; // one per image: presenting may still wait for it when the next frame begins
    VkSemaphore available_ = VK_NULL_HANDLE;
    uint32_t image_ = 0;
    bool acquired_ = false, stale_ = true;

    void make(uint32_t width, uint32_t height);
    void destroy_semaphores();
};

} // namespace viewer
