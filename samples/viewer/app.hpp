// One frame of the viewer, in a window or without one: input, session, panel, picture.
#pragma once
#include "gamepad.hpp"
#include "gui.hpp"
#include "level_editor.hpp"
#include "overlay.hpp"
#include "panel.hpp"
#include "script.hpp"
#include "session.hpp"
#include "start_screen.hpp"
#include <chrono>
#include <memory>

namespace viewer {

class App {
  public:
    /// Without a name of a level in the options it begins with the start screen.
    App(const Gpu& gpu, const Options& options, GLFWwindow* window, uint32_t width, uint32_t height);

    void resize(uint32_t width, uint32_t height);
    /// `seconds` since the last frame. `after` records behind the panel.
    void frame(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after);
    uint64_t frames() const { return frames_; }

    Renderer renderer;
    Gui gui;
    std::unique_ptr<Session> session; // none: the start screen
    Script script;

  private:
    const Gpu& gpu_;
    Options options_;
    std::unique_ptr<StartScreen> start_;
    Panel panel_;
    Overlay overlay_;
    LevelEditor editor_;
    Gamepad gamepad_;
    bool has_window_;
    bool shows_panel_; // and what else is drawn over the picture
    bool panel_folded_ = false;
    uint64_t frames_ = 0;
    std::chrono::steady_clock::time_point drawn_at_{};

    void open(const std::string& level_name, const std::string& level_file);
    void leave();
    void press_keys();
    void choose(const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after);
    void play(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after);
};

/// With a window, until it is closed or `options.frames` are drawn where a script runs. Returns the exit code.
int run_window(const Options& options);
/// The same without a window, for scripts and pictures of the panel: frames of options.every each.
int run_scripted(const Options& options);

} // namespace viewer
