// wadi-recorder: runs a level without a window and records shaded pictures, fields and figures.
#include "../common/levels.hpp"
#include "run.hpp"
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <wadi/wadi.h>

namespace recorder {
namespace {

constexpr int MOST_CELLS = 16384; // along one axis
constexpr double MOST_SPEED = 1e4, LEAST_CALM = 1e-7, MOST_SECONDS = 1e9;

Failure parse_size(const std::string& text, Options& options) {
    const char* const end = text.data() + text.size();
    int nx = 0, ny = 0;
    const auto first = std::from_chars(text.data(), end, nx);
    if (first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x') {
        const auto second = std::from_chars(first.ptr + 1, end, ny);
        if (second.ec == std::errc{} && second.ptr == end && nx >= 1 && nx <= MOST_CELLS && ny >= 1 && ny <= MOST_CELLS) {
            options.nx = nx;
            options.ny = ny;
            return {};
        }
    }
    return {EXIT_BAD_INPUT, "--size " + text + ": want NxM in cells, 1 ... 16384 each, e.g. 200x256"};
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t start = 0;
    for (std::size_t comma = text.find(','); comma != std::string::npos; comma = text.find(',', start)) {
        parts.push_back(text.substr(start, comma - start));
        start = comma + 1;
    }
    parts.push_back(text.substr(start));
    return parts;
}

int field_by_name(const std::string& name) {
    for (int field = 0; field < WADI_FIELD_COUNT; ++field) {
        const char* known = wadi_field_name(static_cast<wadi_field>(field));
        if (known != nullptr && name == known) return field;
    }
    return -1;
}

/// "hs,W@1.5,3": every field at every time.
Failure parse_dump(const std::string& text, std::vector<DumpRequest>& dumps) {
    const std::size_t sign = text.find('@');
    if (sign == std::string::npos) return {EXIT_BAD_INPUT, "--dump " + text + ": want FIELDS@TIMES, e.g. hs,W@1.5"};
    for (const std::string& name : split(text.substr(0, sign))) {
        const int field = field_by_name(name);
        if (field < 0) {
            std::string known;
            for (int k = 0; k < WADI_FIELD_COUNT; ++k)
                known += std::string(k == 0 ? "" : ", ") + wadi_field_name(static_cast<wadi_field>(k));
            return {EXIT_BAD_INPUT, "--dump " + text + ": unknown field \"" + name + "\"; the fields are " + known};
        }
        for (const std::string& time_text : split(text.substr(sign + 1))) {
            double time = 0;
            const auto parsed = std::from_chars(time_text.data(), time_text.data() + time_text.size(), time);
            if (parsed.ec != std::errc{} || parsed.ptr != time_text.data() + time_text.size() || !std::isfinite(time) ||
                time < 0) {
                return {EXIT_BAD_INPUT, "--dump " + text + ": \"" + time_text + "\" is not a time in seconds, 0 or more"};
            }
            dumps.push_back({field, name, time_text, time});
        }
    }
    return {};
}

/// "x,y", or "x0,y0,x1,y1" for a section.
Failure parse_points(const std::string& option, const std::string& text, std::size_t numbers,
                     std::vector<PointRequest>& requests) {
    const std::vector<std::string> parts = split(text);
    std::array<double, 4> at = {};
    bool good = parts.size() == numbers;
    for (std::size_t n = 0; n < numbers && good; ++n) {
        const char* const end = parts[n].data() + parts[n].size();
        const auto parsed = std::from_chars(parts[n].data(), end, at[n]);
        good = parsed.ec == std::errc{} && parsed.ptr == end && std::isfinite(at[n]);
    }
    if (!good) return {EXIT_BAD_INPUT, option + " " + text + ": want " + (numbers == 2 ? "x,y" : "x0,y0,x1,y1") + " in metres"};
    const std::size_t last = numbers - 2;
    requests.push_back({option + " " + text, {at[0], at[1]}, {at[last], at[last + 1]}});
    return {};
}

/// "0.01,5": a speed and for how long nothing may be faster.
Failure parse_calm(const std::string& text, Options& options) {
    const std::vector<std::string> parts = split(text);
    const auto number = [](const std::string& part, double& value) {
        const char* const end = part.data() + part.size();
        const auto parsed = std::from_chars(part.data(), end, value);
        return parsed.ec == std::errc{} && parsed.ptr == end;
    };
    if (parts.size() == 2 && number(parts[0], options.calm_speed) && number(parts[1], options.calm_seconds) &&
        options.calm_speed > 0 && options.calm_speed <= MOST_SPEED && options.calm_seconds >= LEAST_CALM &&
        options.calm_seconds <= MOST_SECONDS)
        return {};
    return {EXIT_BAD_INPUT,
            "--until-calm " + text + ": want SPEED,SECONDS, a speed above 0, at most 10000 m/s, and 1e-7 ... 1e9 s, e.g. 0.01,5"};
}

int print_backends() {
    char notes[2048] = "";
    std::uint32_t count = 0;
    wadi_result result = wadi_list_devices(nullptr, &count, notes, sizeof notes);
    std::vector<wadi_device_info> devices(count);
    for (wadi_device_info& device : devices) device.struct_size = sizeof device;
    if (result == WADI_OK) result = wadi_list_devices(devices.data(), &count, notes, sizeof notes);
    if (result != WADI_OK) {
        std::fprintf(stderr, "wadi-recorder: %s\n", wadi_get_last_error());
        return EXIT_BAD_INPUT;
    }
    devices.resize(count);
    for (const wadi_device_info& device : devices) {
        std::printf("%-8s %2d  %s%s", device.backend, device.index, device.name, device.is_software != 0 ? " (software)" : "");
        if (device.memory_bytes != 0)
            std::printf(", %.1f GiB", static_cast<double>(device.memory_bytes) / (1024.0 * 1024.0 * 1024.0));
        std::printf("\n");
    }
    if (notes[0] != '\0') std::printf("%s%s", notes, notes[std::char_traits<char>::length(notes) - 1] == '\n' ? "" : "\n");
    return EXIT_DONE;
}

int print_table(const std::string& name) {
    std::string text(wadi_describe_table(name.c_str(), nullptr, 0) + 1, '\0');
    if (text.size() == 1) {
        std::fprintf(stderr, "wadi-recorder: --print-tables: %s\n", wadi_get_last_error());
        return EXIT_BAD_INPUT;
    }
    text.resize(wadi_describe_table(name.c_str(), text.data(), text.size()));
    std::fputs(text.c_str(), stdout);
    return EXIT_DONE;
}

int print_levels() {
    for (const common::LevelEntry& level : common::list_levels()) {
        std::printf("%-18s %s\n", level.name.c_str(), level.description.c_str());
        for (const std::string& variant : level.variants) std::printf("%-18s --variant %s\n", "", variant.c_str());
    }
    return EXIT_DONE;
}

int fail(const std::string& message) {
    std::fprintf(stderr, "wadi-recorder: %s\n", message.c_str());
    return EXIT_BAD_INPUT;
}

int main_checked(int argc, char** argv) {
    Options options;
    std::string level, terrain, size, table, calm;
    std::vector<std::string> dumps, gauges, sections;
    bool list_backends = false, only_list_levels = false, no_frames = false;

    CLI::App app("Records a Wadi level: shaded PNG frames, a contact sheet, fields as NPY, and a table of figures.",
                 "wadi-recorder");
    app.add_option("level", level, "level name (--list-levels), level file (.json) or level folder");
    app.add_option("--terrain", terrain, "a terrain map (.png, .r16, .r32, .raw, .hgt, .npy, .asc) instead of a level")
        ->excludes("level");
    app.add_option("--backend", options.backend, "auto, or one of --list-backends")->capture_default_str();
    app.add_option("--device", options.device, "device number within the backend (--list-backends); -1 = best")
        ->capture_default_str();
    app.add_option("--threads", options.threads, "threads of the cpu backend, and to load, count and draw on; 0 = all cores")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    app.add_flag("--validate", options.validate, "switch the Vulkan validation layers on");
    app.add_option("--method", options.method, "method preset instead of the level's");
    app.add_option("--variant", options.variant, "a variant of the level (--list-levels shows them)");
    app.add_option("--accuracy", options.accuracy,
                   "draft, balanced or accurate: half, all or twice the cells, two sand substeps; accurate: order 2 for water; "
                   "fine: the level's "
                   "fine_grid");
    app.add_flag("--any-files", options.any_files, "the level may name files outside its folder; for levels that you trust");
    app.add_option("--size", size, "grid NxM instead of the level's; keeps the length in x");
    app.add_option("--dt", options.dt, "water time step [s] instead of the level's")->check(CLI::Range(1e-7, 100.0));
    app.add_option("--active-tiles", options.active_tiles,
                   "8, 16, 32 or 64: tiles of so many cells in which nothing changes are left out; -1 = none are, 1 = while that "
                   "gains (the default in large grids on GPUs)")
        ->check(CLI::IsMember({-1, 1, 8, 16, 32, 64}));
    app.add_option("--fused-stages", options.fused_stages,
                   "1: several stages in one pass wherever the effects allow; -1: one by one")
        ->check(CLI::IsMember({-1, 1}));
    app.add_option("--seconds", options.seconds, "simulated time [s]; default: the level's duration")
        ->check(CLI::Range(0.0, MOST_SECONDS));
    app.add_option(
        "--until-calm", calm,
        "SPEED,SECONDS, e.g. 0.01,5: ends earlier, once neither water nor sand was faster than SPEED [m/s] for SECONDS");
    app.add_option("--every", options.every, "time between frames [s]; default: a tenth of the recording")
        ->check(CLI::Range(1e-7, 1e9));
    app.add_option("--water-scale", options.water_scale, "depth drawn in deep blue [m]; default: from the first state")
        ->check(CLI::Range(1e-6, 1e6));
    app.add_option("--out", options.out, "folder for frames and fields; default: out/LEVEL");
    app.add_option("--dump", dumps, "FIELDS@TIMES, e.g. hs,W,us@1.5,3: writes FIELD_TIME.npy; repeatable")
        ->allow_extra_args(false);
    app.add_option("--dump-as", options.dump_as, "npy, asc (Esri ASCII grid) or tif (GeoTIFF of floats): what --dump writes")
        ->check(CLI::IsMember({"npy", "asc", "tif"}))
        ->capture_default_str();
    app.add_option("--gauge", gauges, "x,y [m]: the state at this point at every frame's time, to gauges.csv; repeatable")
        ->allow_extra_args(false);
    app.add_option("--section", sections, "x0,y0,x1,y1 [m]: the state along this line likewise, to sections.csv; repeatable")
        ->allow_extra_args(false);
    app.add_flag("--map-coordinates", options.map_coordinates,
                 "gauges and sections are given and written in the coordinates of the map that the level was cut from");
    app.add_option("--summary", options.summary, "writes the figures as JSON to this file");
    app.add_flag("--mp4", options.mp4, "also write the frames as recording.mp4 (H.264); needs the ffmpeg program");
    app.add_option("--fps", options.frames_per_second, "frames per second of the MP4")
        ->check(CLI::Range(1, 240))
        ->needs("--mp4")
        ->capture_default_str();
    app.add_flag("--profile", options.profile, "time every stage on the device");
    app.add_flag("--check", options.check, "verify the state after every step and end where it breaks a promise; slow");
    app.add_flag("--jpeg", options.jpeg, "contact_sheet.jpg instead of contact_sheet.png, for pages");
    app.add_flag("--no-frames", no_frames, "no pictures, for benchmarks")->excludes("--mp4")->excludes("--jpeg");
    app.add_flag("--print-plan", options.print_plan, "print effects, passes and buffers, and exit");
    app.add_option("--print-tables", table, "print settings, effects, fields, stages or schema of the library, and exit");
    app.add_flag("--list-backends", list_backends, "list devices and exit");
    app.add_flag("--list-levels", only_list_levels, "list levels and exit");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help
        return fail(std::string(error.what()) + " (--help shows the options)");
    }

    if (list_backends) return print_backends();
    if (only_list_levels) return print_levels();
    if (!table.empty()) return print_table(table);
    options.frames = !no_frames;
    if (!size.empty()) {
        if (Failure failure = parse_size(size, options)) return fail(failure.message);
    }
    if (!calm.empty()) {
        if (Failure failure = parse_calm(calm, options)) return fail(failure.message);
    }
    for (const std::string& dump : dumps) {
        if (Failure failure = parse_dump(dump, options.dumps)) return fail(failure.message);
    }
    for (const std::string& gauge : gauges) {
        if (Failure failure = parse_points("--gauge", gauge, 2, options.gauges)) return fail(failure.message);
    }
    for (const std::string& section : sections) {
        if (Failure failure = parse_points("--section", section, 4, options.sections)) return fail(failure.message);
    }
    if (!terrain.empty()) {
        options.level_name = std::filesystem::path(terrain).stem().string();
        options.level_file = terrain;
        options.terrain_alone = true;
    } else if (!level.empty()) {
        const common::FoundLevel found = common::find_level(level);
        if (!found.error.empty()) return fail(found.error);
        options.level_name = found.name;
        options.level_file = found.file.string();
    } else {
        return fail("name a level or give --terrain MAP (--list-levels shows the levels, --help the options)");
    }
    if (!options.variant.empty()) options.level_name += "_" + options.variant;
    if (options.out.empty()) options.out = (std::filesystem::path("out") / options.level_name).string();
    return run(options);
}

} // namespace
} // namespace recorder

int main(int argc, char** argv) {
    try {
        return recorder::main_checked(argc, argv);
    } catch (const std::exception& error) { // the standard library's: out of memory, a folder that cannot be listed
        return recorder::fail(error.what());
    }
}
