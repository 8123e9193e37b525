#include "app.hpp"
#include "controls.hpp"
#include "picture_file.hpp"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <cstdio>
#include <imgui.h>

namespace viewer {

App::App(const Gpu& gpu, const Options& options, GLFWwindow* window, uint32_t width, uint32_t height)
    : renderer(gpu, width, height, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT), gui(gpu, renderer, window),
      script(options.script.empty() ? Script() : Script(options.script)), gpu_(gpu), options_(options),
      has_window_(window != nullptr), shows_panel_(options.panel) {
    if (options.level_name.empty()) {
        start_ = std::make_unique<StartScreen>(gpu);
    } else {
        open(options.level_name, options.simulation.level_file);
    }
}

void App::open(const std::string& level_name, const std::string& level_file) {
    options_.level_name = level_name;
    options_.simulation.level_file = level_file;
    session = std::make_unique<Session>(gpu_, renderer, options_);
    session->render_scale.target = options_.hold;
    start_.reset();
}

void App::leave() {
    renderer.wait();
    StartScreen::keep_picture(session->choice().level_file, renderer);
    session.reset();
    options_.simulation.variant.clear();
    options_.simulation.nx = options_.simulation.ny = 0;
    start_ = std::make_unique<StartScreen>(gpu_);
}

void App::resize(uint32_t width, uint32_t height) {
    renderer.resize(width, height);
    gui.follow_size();
}

void App::frame(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after) {
    gui.begin_frame(seconds);
    script.apply_input(frames_);
    ImGui::NewFrame();
    press_keys();
    if (session) {
        play(seconds, swapchain, after);
    } else {
        choose(swapchain, after);
    }
    ++frames_;
}

void App::press_keys() {
    if (!session || ImGui::GetIO().WantTextInput) return;
    if (ImGui::IsKeyPressed(GLFW_KEY_F1, false)) overlay_.shows_help = !overlay_.shows_help;
    if (ImGui::IsKeyPressed(GLFW_KEY_F2, false)) editor_.shown = !editor_.shown;
    if (ImGui::IsKeyPressed(GLFW_KEY_TAB, false)) panel_folded_ = !panel_folded_;
    if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) leave();
}

void App::choose(const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after) {
    const std::optional<common::LevelEntry> level = start_->draw();
    ImGui::Render();
    renderer.draw_images(start_->pictures(), swapchain, [&](VkCommandBuffer commands) {
        gui.record(commands);
        if (after) after(commands);
    });
    if (!level) return;
    try {
        open(level->name, level->file.string());
    } catch (const std::exception& error) {
        start_->message = error.what();
    }
}

void App::play(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after) {
    handle_input(*session, gamepad_, script.empty() && has_window_ ? read_gamepad() : script.pad(frames_), seconds);
    script.apply_commands(frames_, *session);
    session->picture.shift = 0;
    if (shows_panel_ && !session->picture_is_kept()) {
        if (!panel_folded_) panel_.draw(*session, editor_, seconds);
        editor_.draw(*session, panel_folded_ ? 0 : Panel::WIDTH);
        overlay_.draw(*session);
    }
    ImGui::Render();
    session->advance(seconds);
    session->draw(swapchain, [&](VkCommandBuffer commands) {
        gui.record(commands);
        if (after) after(commands);
    });
    // What the frame took by the wall: scripts have a clock of their own.
    const auto now = std::chrono::steady_clock::now();
    const double frame = 1e3 * std::chrono::duration<double>(now - drawn_at_).count();
    const Milliseconds times = renderer.times();
    if (drawn_at_ != std::chrono::steady_clock::time_point{})
        session->render_scale.follow(frame, renderer.timed() ? times.see + times.shade : frame);
    drawn_at_ = now;
}

int run_scripted(const Options& options) {
    const Gpu gpu({.device = options.gpu, .validate = options.validate, .graphics = true, .instance_extensions = {}});
    std::printf("drawn by %s, queue family %u of %u\n", gpu.name.c_str(), gpu.family, gpu.families);
    {
        App app(gpu, options, nullptr, options.width, options.height);
        std::filesystem::create_directories(options.out);
        for (uint64_t n = 0; n < options.frames; ++n) {
            app.frame(options.every, {}, nullptr);
            for (const Script::Line& line : app.script.lines(n, "resize"))
                app.resize(static_cast<uint32_t>(std::stoul(line.words[0])), static_cast<uint32_t>(std::stoul(line.words[1])));
        }
        const std::filesystem::path file = options.out / "last.png";
        write_picture(file, app.renderer.read_picture(), app.renderer.width(), app.renderer.height());
        std::printf("frames %llu, t = %.3f s, last in %s\n", static_cast<unsigned long long>(app.frames()),
                    app.session ? app.session->simulation().frame.time : 0.0, file.string().c_str());
        if (app.session && !app.session->message.empty()) std::printf("message %s\n", app.session->message.c_str());
    }
    if (options.validate) std::printf("validation %u messages\n", validation_messages());
    return validation_messages() == 0 ? 0 : 3;
}

} // namespace viewer
