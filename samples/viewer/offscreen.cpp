#include "options.hpp"
#include "picture_file.hpp"
#include "renderer.hpp"
#include "video.hpp"
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace viewer {
namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

int run_offscreen(const Options& options) {
    const Gpu gpu({.device = options.gpu, .validate = options.validate, .instance_extensions = {}});
    uint32_t messages = 0;
    {
        Simulation simulation(gpu, options.simulation);
        for (const std::string& line : take_log()) std::fprintf(stderr, "%s\n", line.c_str());
        Renderer renderer(gpu, options.width, options.height);
        std::printf("level      %s, %d x %d cells of %g m, dt %g s\n", options.level_name.c_str(), simulation.info.nx,
                    simulation.info.ny, simulation.info.dx, simulation.info.dt);
        std::printf("simulated  %s: %s\n", simulation.info.backend, simulation.info.device_name);
        std::printf("drawn      %s (queue family %u of %u), %u x %u, quality %s\n", gpu.name.c_str(), gpu.family, gpu.families,
                    options.width, options.height, options.quality.c_str());

        Picture picture;
        picture.camera = camera_preset(options.camera, simulation.grid.block,
                                       static_cast<float>(options.width) / static_cast<float>(options.height));
        picture.quality = quality_preset(options.quality);
        picture.look.clarity = default_clarity(simulation.grid);
        picture.view = view_number(options.view);
        picture.low = views()[static_cast<std::size_t>(picture.view)].low;
        picture.high = views()[static_cast<std::size_t>(picture.view)].high;
        picture.arrows = options.arrows;
        picture.look.features = ~feature_bits(options.without);
        picture.look.land = !options.block;

        simulation.set_recording(true);
        simulation.show(host_field_of(picture.view));
        const auto first_steps = static_cast<uint64_t>(std::llround(options.start / simulation.info.dt));
        for (uint64_t done = 0; done + 1 < first_steps; done += 256)
            simulation.step(static_cast<uint32_t>(std::min<uint64_t>(256, first_steps - 1 - done)));
        simulation.update(0); // what the last step changed shows in the view of active tiles
        if (first_steps > 0) simulation.step(1);
        simulation.update(0);
        gpu.wait_idle();

        std::filesystem::create_directories(options.out);
        double simulated = 0, drawn = 0, processor = 0;
        Milliseconds device;
        const auto every = static_cast<uint64_t>(std::llround(options.every * 1e9));
        for (uint64_t n = 0; n < options.frames; ++n) {
            const auto update_start = std::chrono::steady_clock::now();
            if (n > 0) simulation.update(every);
            const Sources& sources = simulation.sources(true);
            if (!simulation.foreign_memory()) gpu.wait_idle();
            const double update_time = milliseconds_since(update_start);

            picture.time = static_cast<float>(simulation.frame.time);
            const auto draw_start = std::chrono::steady_clock::now();
            const std::clock_t processor_start = std::clock();
            renderer.draw(picture, simulation.grid, sources, simulation.foreign_memory(), simulation.next_submission(), nullptr);
            renderer.wait();
            const double draw_time = milliseconds_since(draw_start);
            const double processor_time = 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
            if (n > 0 || options.frames == 1) { // the first picture also allocates
                simulated += update_time;
                drawn += draw_time;
                processor += processor_time;
                device = device + renderer.times();
            }
            write_picture(options.out / numbered("frame", n, options.jpeg ? "jpg" : "png"), renderer.read_picture(),
                          options.width, options.height);
        }
        const double counted = static_cast<double>(options.frames > 1 ? options.frames - 1 : 1);
        std::printf("time       %.3f s simulated\n", simulation.frame.time);
        std::printf("frame      %.2f ms (wall), %.2f ms of processor time; simulation %.2f ms (wall, %.3g s of it each)\n",
                    drawn / counted, processor / counted, simulated / counted, options.every);
        std::printf("passes     grid %.2f, see %.2f, shade %.2f, finish %.2f ms on the device\n", device.grid / counted,
                    device.see / counted, device.shade / counted, device.finish / counted);
        std::printf("pictures   %llu in %s\n", static_cast<unsigned long long>(options.frames), options.out.string().c_str());
        if (options.video) std::printf("video      %s\n", make_video(options.out, "frame", 1 / options.every).c_str());
    }
    messages = validation_messages();
    if (options.validate) std::printf("validation %u messages\n", messages);
    return messages == 0 ? 0 : 3;
}

} // namespace viewer
