#include "app.hpp"
#include "swapchain.hpp"
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace viewer {
namespace {

struct Glfw {
    Glfw() {
        glfwSetErrorCallback([](int, const char* text) { std::fprintf(stderr, "window: %s\n", text); });
        if (glfwInit() == GLFW_FALSE) throw std::runtime_error("no display to open a window on; --offscreen needs none");
        if (glfwVulkanSupported() == GLFW_FALSE) {
            glfwTerminate();
            throw std::runtime_error("Vulkan cannot draw on this display; --offscreen needs none");
        }
    }
    ~Glfw() { glfwTerminate(); }
};

using Window = std::unique_ptr<GLFWwindow, decltype(&glfwDestroyWindow)>;

} // namespace

int run_window(const Options& options) {
    const Glfw glfw;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const std::string title = options.level_name.empty() ? "Wadi" : "Wadi: " + options.level_name;
    const Window window(
        glfwCreateWindow(static_cast<int>(options.width), static_cast<int>(options.height), title.c_str(), nullptr, nullptr),
        glfwDestroyWindow);
    if (!window) throw std::runtime_error("the window could not be made; --offscreen needs none");
    uint32_t count = 0;
    const char** required = glfwGetRequiredInstanceExtensions(&count);
    const Gpu gpu({.device = options.gpu,
                   .validate = options.validate,
                   .graphics = true,
                   .instance_extensions = {required, required + count},
                   .swapchain = true});
    {
        VkSurfaceKHR surface = VK_NULL_HANDLE;
        check(glfwCreateWindowSurface(gpu.instance, window.get(), nullptr, &surface), "glfwCreateWindowSurface");
        Swapchain swapchain(gpu, surface);
        App app(gpu, options, window.get(), options.width, options.height);
        auto last = std::chrono::steady_clock::now();
        const bool scripted = !app.script.empty();
        uint64_t minimised_frames = 0;
        while (glfwWindowShouldClose(window.get()) == GLFW_FALSE && !(scripted && app.frames() >= options.frames)) {
            glfwPollEvents();
            int width = 0, height = 0;
            glfwGetFramebufferSize(window.get(), &width, &height);
            const bool minimised = width == 0 || height == 0 || glfwGetWindowAttrib(window.get(), GLFW_ICONIFIED) == GLFW_TRUE;
            if (minimised && !scripted) {
                glfwWaitEventsTimeout(0.1);
                last = std::chrono::steady_clock::now();
                continue;
            }
            if (!minimised &&
                (static_cast<uint32_t>(width) != app.renderer.width() || static_cast<uint32_t>(height) != app.renderer.height()))
                app.resize(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
            minimised_frames += minimised ? 1 : 0;
            // The last picture is done before an image is asked for: its semaphores are free again.
            app.renderer.wait();
            if (!minimised) swapchain.acquire(app.renderer.width(), app.renderer.height());
            const auto now = std::chrono::steady_clock::now();
            const double seconds = scripted ? options.every : std::chrono::duration<double>(now - last).count();
            last = now;
            const uint64_t frame = app.frames();
            app.frame(seconds, swapchain.submission(),
                      [&](VkCommandBuffer commands) { swapchain.copy_from(app.renderer.picture(), commands); });
            swapchain.present();
            for (const Script::Line& line : app.script.lines(frame, "resize"))
                glfwSetWindowSize(window.get(), std::stoi(line.words[0]), std::stoi(line.words[1]));
            if (!app.script.lines(frame, "minimise").empty()) glfwIconifyWindow(window.get());
            if (!app.script.lines(frame, "restore").empty()) glfwRestoreWindow(window.get());
        }
        app.renderer.wait();
        std::printf("frames %llu, t = %.3f s, window %u x %u, minimised for %llu frames\n",
                    static_cast<unsigned long long>(app.frames()), app.session ? app.session->simulation().frame.time : 0.0,
                    app.renderer.width(), app.renderer.height(), static_cast<unsigned long long>(minimised_frames));
    }
    if (options.validate) std::printf("validation %u messages\n", validation_messages());
    return validation_messages() == 0 ? 0 : 3;
}

} // namespace viewer
