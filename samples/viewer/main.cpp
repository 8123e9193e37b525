#include "../common/levels.hpp"
#include "app.hpp"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

namespace viewer {
namespace {

/// "WxH" within [least, most].
void parse_size(const std::string& name, const std::string& text, int least, int most, int& across, int& down) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &across, &down, &rest) != 2 || across < least || down < least || across > most ||
        down > most)
        throw std::runtime_error(name + ": \"" + text + "\" is not WIDTHxHEIGHT with " + std::to_string(least) + " ... " +
                                 std::to_string(most) + " each");
}

int print_gpus() {
    const std::vector<std::string> names = list_gpus();
    for (std::size_t n = 0; n < names.size(); ++n) std::printf("%zu  %s\n", n, names[n].c_str());
    return 0;
}

int print_levels() {
    for (const common::LevelEntry& level : common::list_levels())
        std::printf("%-18s %s\n", level.name.c_str(), level.description.c_str());
    return 0;
}

int main_checked(int argc, char** argv) {
    Options options;
    std::string level, size, grid;
    bool only_list_levels = false, only_list_gpus = false;
    CLI::App app("Shows a Wadi level in three dimensions: in a window, or as PNG pictures without one.", "wadi-viewer");
    app.add_option("level", level,
                   "none: a screen to choose from; or a level name (--list-levels), level file (.json), level folder or terrain "
                   "map (.png, .r16, .r32, .raw, .hgt, .npy, .asc)");
    app.add_option("--backend", options.simulation.backend, "of the simulation: auto, cpu, vulkan or cuda")
        ->capture_default_str();
    app.add_option("--device", options.simulation.device, "device number within the cpu or cuda backend; -1 = best")
        ->check(CLI::Range(-1, 64));
    app.add_option("--threads", options.simulation.threads, "threads of the cpu backend; 0 = all but one")
        ->check(CLI::Range(0, 256));
    app.add_option("--gpu", options.gpu, "Vulkan device that draws (--list-gpus); -1 = a real GPU first")
        ->check(CLI::Range(-1, 64));
    app.add_option("--variant", options.simulation.variant, "one of the level's variants");
    app.add_option("--accuracy", options.simulation.accuracy,
                   "draft, balanced or accurate: half, all or twice the cells, two sand substeps; accurate: order 2 for water; "
                   "fine: the level's "
                   "fine_grid; level: as it says. Default: fine on a graphics card, level elsewhere");
    app.add_option("--method", options.simulation.method, "robust or published instead of the level's");
    app.add_option("--grid", grid, "grid NxM instead of the level's; keeps the length in x");
    app.add_option("--size", size, "WIDTHxHEIGHT of the picture or window, default 1280x720");
    app.add_option("--camera", options.camera, "overview, opposite, top, close, low, or YAW,PITCH,SHARE,EAST,NORTH (README.md)")
        ->capture_default_str();
    app.add_option("--quality", options.quality, "low, medium or high")->capture_default_str();
    app.add_option("--view", options.view,
                   "picture, or a quantity as false colour: depth, speed, saturation, froude, sand, sand-speed, foam, height, "
                   "sky, slope, strain, stress, active, limits")
        ->capture_default_str();
    app.add_flag("--arrows", options.arrows, "arrows of velocity");
    app.add_flag("--block", options.block, "the block alone, cut out, instead of land that goes on beyond it");
    app.add_option("--without", options.without,
                   "draw without some of: foam, waves, flow-map, reflection, refraction, caustics, mud, grain, ripples, glitter, "
                   "rock, shadows, wet-sand, clouds, haze, wetness");
    app.add_flag("--offscreen", options.offscreen, "no window: writes pictures");
    app.add_option("--frames", options.frames, "offscreen: pictures to write")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    auto* const start = app.add_option("--start", options.start, "offscreen: simulated time of the first picture [s]")
                            ->check(CLI::Range(0.0, 1e6));
    app.add_option("--every", options.every, "offscreen: simulated time between pictures [s]; default 1/30")
        ->check(CLI::Range(1e-6, 1e3));
    app.add_option("--out", options.out, "folder for pictures; default: out/LEVEL");
    auto* const video = app.add_flag("--video", options.video, "offscreen: also an MP4, where ffmpeg is installed");
    auto* const jpeg = app.add_flag("--jpeg", options.jpeg, "offscreen: pictures as JPEG, for pages")->excludes(video);
    app.add_flag("--panel", options.panel, "offscreen: draw the panel too, from the level's start on, and keep the last picture")
        ->excludes(start, video, jpeg);
    app.add_option("--script", options.script, "input from a file: lines FRAME COMMAND WORDS, see README.md; ends after --frames")
        ->excludes(start, video, jpeg);
    app.add_flag("--validate", options.validate, "Vulkan validation layers; any message makes the exit code 3");
    app.add_flag("--list-levels", only_list_levels, "list levels and exit");
    app.add_flag("--list-gpus", only_list_gpus, "list Vulkan devices and exit");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help
        throw std::runtime_error(std::string(error.what()) + " (--help shows the options)");
    }
    if (only_list_levels) return print_levels();
    if (only_list_gpus) return print_gpus();
    if (!size.empty()) {
        int width = 0, height = 0;
        parse_size("--size", size, 16, 8192, width, height);
        options.width = static_cast<uint32_t>(width);
        options.height = static_cast<uint32_t>(height);
    }
    if (!grid.empty()) parse_size("--grid", grid, 1, 16384, options.simulation.nx, options.simulation.ny);
    const bool has_start_screen = !options.offscreen || !options.script.empty();
    if (level.empty() && !has_start_screen)
        throw std::runtime_error("name a level (--list-levels shows the levels, --help the options)");
    const std::string extension = std::filesystem::path(level).extension().string();
    if (extension == ".png" || extension == ".r16" || extension == ".npy" || extension == ".asc") {
        options.level_name = std::filesystem::path(level).stem().string();
        options.simulation.level_file = level;
    } else if (!level.empty()) {
        const common::FoundLevel found = common::find_level(level);
        if (!found.error.empty()) throw std::runtime_error(found.error);
        options.level_name = found.name;
        options.simulation.level_file = found.file.string();
    }
    if (options.out.empty()) options.out = std::filesystem::path("out") / options.level_name;
    quality_preset(options.quality);
    view_number(options.view);
    feature_bits(options.without);
    if (!options.offscreen) {
        options.panel = true;
        options.hold = 100;
        return run_window(options);
    }
    return options.panel || !options.script.empty() ? run_scripted(options) : run_offscreen(options);
}

} // namespace
} // namespace viewer

int main(int argc, char** argv) {
    try {
        return viewer::main_checked(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "wadi-viewer: %s\n", error.what());
        return 2;
    }
}
