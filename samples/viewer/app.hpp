// One frame of the viewer, in a window or without one: input, session, panel, picture.
#pragma once
#include "gui.hpp"
#include "panel.hpp"
#include "script.hpp"
#include "session.hpp"

namespace viewer {

class App {
  public:
    App(const Gpu& gpu, const Options& options, GLFWwindow* window, uint32_t width, uint32_t height);

    void resize(uint32_t width, uint32_t height);
    /// `seconds` since the last frame. `after` records behind the panel.
    void frame(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after);
    uint64_t frames() const { return frames_; }

    Renderer renderer;
    Gui gui;
    Session session;
    Script script;

  private:
    Panel panel_;
    bool shows_panel_;
    uint64_t frames_ = 0;
};

/// With a window, until it is closed or `options.frames` are drawn where a script runs. Returns the exit code.
int run_window(const Options& options);
/// The same without a window, for scripts and pictures of the panel: frames of options.every each.
int run_scripted(const Options& options);

} // namespace viewer
