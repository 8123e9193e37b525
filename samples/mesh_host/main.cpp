// wadi-mesh-host: options, the camera, and the frame loop.
#include "../common/files.hpp"
#include "../common/levels.hpp"
#include "../common/png.hpp"
#include "../common/window.hpp"
#include "drawing.hpp"
#include <CLI/CLI.hpp>
#include <chrono>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

namespace {

struct Camera { // it orbits a target; angles in degrees, yaw 0 looks north, pitch down; distance in longest sides of the grid
    float yaw = -35, pitch = 24, distance = 1;

    void steer(common::Window& window) {
        const auto [x, y] = window.dragged();
        yaw += 0.35f * x, pitch = std::clamp(pitch + 0.35f * y, 2.0f, 89.0f);
        distance = std::clamp(distance * std::exp(-0.12f * static_cast<float>(std::exchange(window.scrolled, 0))), 0.05f, 4.0f);
    }
};

Scene scene_of(const Camera& camera, const World& world, const Mesh& mesh, VkExtent2D size, const World::Sources& sources) {
    const auto dx = static_cast<float>(world.info.dx), height = static_cast<float>(size.height);
    const glm::vec2 sides = dx * glm::vec2(world.info.nx, world.info.ny);
    const float longest = std::max(sides.x, sides.y), yaw = glm::radians(camera.yaw), pitch = glm::radians(camera.pitch);
    const glm::vec3 target(0.5f * sides, 0.5f * (world.low + world.high));
    const glm::vec3 back(-std::sin(yaw) * std::cos(pitch), -std::cos(yaw) * std::cos(pitch), std::sin(pitch));
    const glm::vec3 eye = target + longest * camera.distance * back;
    const float tangent = 0.414f; // of half the angle of view, 45 degrees
    glm::mat4 lens(0);            // depth is near / distance: 1 near, 0 infinitely far; y points down
    lens[0][0] = height / (tangent * static_cast<float>(size.width)), lens[1][1] = -1 / tangent, lens[2][3] = -1;
    lens[3][2] = 0.01f * longest * camera.distance;
    Scene scene{};
    scene.to_screen = lens * glm::lookAt(eye, target, glm::vec3(0, 0, 1));
    scene.from_screen = glm::inverse(scene.to_screen);
    scene.eye = glm::vec4(eye, static_cast<float>(world.frame.time));
    scene.sun = glm::vec4(glm::normalize(glm::vec3(0.75f, 0.35f, 0.55f)), dx);
    // Quads are split until they are 4 pixels large, within what the mesh needs and Drawing has room for.
    const float reach = std::clamp(0.125f * height / tangent, 4.0f * Mesh::SIDE, 512.0f);
    scene.lod = glm::vec4(glm::vec2(eye) / dx - 0.5f, std::abs(eye.z - target.z) / dx, reach);
    scene.grid = {world.info.nx, world.info.ny, mesh.root(), std::max(world.info.nx, world.info.ny)};
    for (std::size_t n = 0; n < sources.size(); ++n) scene.rows[n] = {sources[n].first, sources[n].pitch, 0, 0};
    return scene;
}

int run(int argc, char** argv) {
    std::string level, backend = "vulkan", file;
    std::array<int, 2> area{960, 540}, grid{};
    Camera camera;
    double seconds = 0;
    uint64_t pictures = 1;
    const auto within = [](double least, double most) { // CLI::Range would let NaN pass
        return CLI::Validator("").operation([=](std::string& text) {
            const double value = std::strtod(text.c_str(), nullptr);
            return value >= least && value <= most ? ""
                                                   : CLI::Range(least, most).get_description() + " is asked for, not " + text;
        });
    };
    CLI::App app{"Draws a level with a mesh, in a window (left button orbits, wheel for the distance) or as a picture."};
    app.add_option("LEVEL", level, "a level's name, its level.json, or the folder that has one")->required();
    app.add_option("--backend", backend, "what simulates; default vulkan")->check(CLI::IsMember({"vulkan", "cpu"}));
    app.add_option("--seconds", seconds, "simulated until the picture, or until the window closes")->check(within(0.0, 3600.0));
    app.add_option("--picture", file, "write this PNG; no window, no display");
    app.add_option("--frames", pictures, "frames drawn on the way to the picture")->check(CLI::Range(1, 100000));
    app.add_option("--yaw", camera.yaw, "degrees from north; default -35")->check(within(-360.0, 360.0));
    app.add_option("--pitch", camera.pitch, "degrees down; default 24")->check(within(2.0, 89.0));
    app.add_option("--distance", camera.distance, "in longest sides of the grid; default 1")->check(within(0.05, 4.0));
    app.add_option("--size", area, "WIDTHxHEIGHT in pixels; default 960x540")->delimiter('x')->check(CLI::Range(16, 8192));
    app.add_option("--cells", grid, "WIDTHxHEIGHT; default: the level's")->delimiter('x')->check(CLI::Range(1, 16384));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    }
    const common::FoundLevel found = common::find_level(level);
    if (!found.error.empty()) throw std::invalid_argument(found.error);

    std::optional<common::Window> window;
    if (file.empty()) window.emplace("Wadi: " + found.name, area[0], area[1]);
    const common::Gpu gpu(window ? window->extensions : std::vector<const char*>(), window.has_value());
    World world(gpu, found.file.string(), backend, grid[0], grid[1], window.has_value());
    const Mesh mesh(world.info.nx, world.info.ny, static_cast<float>(world.info.dx), world.low, world.high);
    Drawing drawing(gpu);
    std::optional<common::Swapchain> swapchain;
    if (window) swapchain.emplace(gpu, *window);
    std::printf("%d x %d cells of %g m, simulated by %s on %s, drawn on %s\n", world.info.nx, world.info.ny, world.info.dx,
                world.info.backend, world.info.device_name, gpu.name.c_str());

    const auto steps = static_cast<uint64_t>(std::llround(seconds / world.info.dt));
    VkExtent2D size{static_cast<uint32_t>(area[0]), static_cast<uint32_t>(area[1])};
    auto last = std::chrono::steady_clock::now();
    uint64_t frames = 0;
    while (window ? !window->closed() && (steps == 0 || world.frame.total_steps < steps) : frames < pictures) {
        gpu.wait(drawing.commands); // one frame at a time: for two, what the host writes must be there twice
        if (window) {
            camera.steer(*window);
            const auto now = std::chrono::steady_clock::now();
            world.update(static_cast<uint64_t>(std::chrono::nanoseconds(now - last).count()));
            last = now;
            size = window->size();
            if (!swapchain->acquire(size)) continue;
        } else {
            world.step(static_cast<uint32_t>(steps * (frames + 1) / pictures - steps * frames / pictures));
        }
        const World::Sources sources = world.outputs();
        const Scene scene = scene_of(camera, world, mesh, size, sources);
        drawing.record(size, scene, sources, mesh.choose(scene.to_screen, glm::vec3(scene.lod), scene.lod.w));
        if (window) swapchain->copy_from(drawing.commands.buffer, drawing.target.picture.handle, size);
        gpu.submit(drawing.commands, window ? swapchain->available : VK_NULL_HANDLE,
                   window ? swapchain->drawn() : VK_NULL_HANDLE);
        if (window) swapchain->present();
        ++frames;
    }
    if (!window) {
        const std::string png =
            common::encode_png(gpu.read(drawing.commands, drawing.target.picture, size).data(), area[0], area[1]);
        const std::string error = common::write_file(file, png);
        if (!error.empty()) throw std::runtime_error("--picture: " + error);
    }
    uint64_t hash = 0;
    check(wadi_world_get_hash(world.id, &hash), "the state's hash");
    std::printf("%llu frames of %u x %u pixels, t = %.3f s, hash %016llx\n", static_cast<unsigned long long>(frames), size.width,
                size.height, world.frame.time, static_cast<unsigned long long>(hash));
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "wadi-mesh-host: %s\n", error.what());
        return dynamic_cast<const common::Missing*>(&error) != nullptr ? 77 : 2;
    }
}
