// Dear ImGui on the renderer's picture, in a window or without one.
#pragma once
#include "renderer.hpp"

struct GLFWwindow;

namespace viewer {

class Gui {
  public:
    /// `window` null: no window; the pointer and keys are then set by the caller in ImGui's IO.
    Gui(const Gpu& gpu, const Renderer& renderer, GLFWwindow* window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// After the renderer's picture was made anew.
    void follow_size();
    /// Between the two, before ImGui::NewFrame(), a caller may change ImGui's IO.
    void begin_frame(double seconds);
    /// Records ImGui's draw data onto the picture, which stays in layout GENERAL.
    void record(VkCommandBuffer commands) const;

  private:
    const Gpu& gpu_;
    const Renderer& renderer_;
    GLFWwindow* window_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

} // namespace viewer
