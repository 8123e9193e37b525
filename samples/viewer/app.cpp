#include "app.hpp"
#include "controls.hpp"
#include "picture_file.hpp"
#include <cstdio>
#include <imgui.h>

namespace viewer {

App::App(const Gpu& gpu, const Options& options, GLFWwindow* window, uint32_t width, uint32_t height)
    : renderer(gpu, width, height, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT), gui(gpu, renderer, window),
      session(gpu, renderer, options), script(options.script.empty() ? Script() : Script(options.script)),
      shows_panel_(options.panel) {}

void App::resize(uint32_t width, uint32_t height) {
    renderer.resize(width, height);
    gui.follow_size();
}

void App::frame(double seconds, const Submission& swapchain, const std::function<void(VkCommandBuffer)>& after) {
    gui.begin_frame(seconds);
    script.apply_input(frames_);
    ImGui::NewFrame();
    handle_input(session, seconds);
    script.apply_commands(frames_, session);
    session.picture.shift = 0;
    if (shows_panel_ && !session.picture_is_kept()) panel_.draw(session, seconds);
    ImGui::Render();
    session.advance(seconds);
    session.draw(swapchain, [&](VkCommandBuffer commands) {
        gui.record(commands);
        if (after) after(commands);
    });
    ++frames_;
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
                    app.session.simulation().frame.time, file.string().c_str());
        if (!app.session.message.empty()) std::printf("message %s\n", app.session.message.c_str());
    }
    if (options.validate) std::printf("validation %u messages\n", validation_messages());
    return validation_messages() == 0 ? 0 : 3;
}

} // namespace viewer
