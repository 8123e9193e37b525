#include "run.hpp"
#include "../common/files.hpp"
#include "../common/grids.hpp"
#include "../common/jpeg.hpp"
#include "../common/platform.hpp"
#include "../common/png.hpp"
#include "frame.hpp"
#include "gpu_clock.hpp"
#include "points.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "video.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <optional>

namespace recorder {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double MOST_FRAMES = 100000;
constexpr const char* VIDEO = "recording.mp4";
constexpr double CHUNK_SECONDS = 0.5;     // wall time between two looks at the time and the interrupt flag
constexpr double GPU_CLOCK_SECONDS = 0.1; // between two readings of the GPU's clock
constexpr double CALM_LOOKS = 8;          // at the speeds while they must stay below the bound of --until-calm

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

int complain(const Failure& failure) {
    std::fprintf(stderr, "wadi-recorder: %s\n", failure.message.c_str());
    return failure.exit_code;
}

/// The water step nearest to a time.
std::uint64_t step_at(double time, double dt) { return static_cast<std::uint64_t>(std::llround(time / dt)); }

class Recording {
  public:
    explicit Recording(const Options& options) : options_(options) {}
    int run();

  private:
    Failure plan();
    Failure plan_points();
    Failure prepare_folder();
    Failure record();
    Failure advance(std::uint64_t target);
    Failure step_to(std::uint64_t target);
    Failure look_for_calm();
    Failure sample_frame(bool last);
    Failure write_dumps();
    Failure write_dump(const DumpRequest& dump);
    Failure finish();
    const char* sheet_name() const { return options_.jpeg ? "contact_sheet.jpg" : "contact_sheet.png"; }

    const Options& options_;
    World world_;
    Report report_;
    double time_ = 0; // simulated so far [s]
    double seconds_ = 0;
    std::uint64_t steps_ = 0, done_ = 0;
    std::uint64_t look_every_ = 0, next_look_ = 0; // steps; 0: nobody asked for calm
    bool moved_ = false;                           // something was faster than the bound of calm
    std::optional<double> slow_since_;             // [s]
    bool calm_ = false;
    std::vector<std::uint64_t> frame_steps_; // increasing, first 0, last steps_
    std::size_t next_frame_ = 0;
    std::uint32_t chunk_ = 1;
    fs::path out_;
    Scaling scaling_;
    std::optional<Look> look_;
    bool water_seen_ = false; // in some frame: look_ stays from then on
    std::optional<ContactSheet> sheet_;
    std::vector<PointTable> tables_; // gauges and sections, where asked for
    std::optional<Progress> progress_;
    std::optional<GpuClock> gpu_clock_;
    std::optional<Clock::time_point> gpu_clock_read_;
    Caption caption_;
    double metres_per_pixel_ = 0;
};

/// Times of frames, dumps and the end as step numbers.
Failure Recording::plan() {
    const double dt = world_.info().dt;
    seconds_ = options_.seconds >= 0 ? options_.seconds : world_.info().duration;
    steps_ = static_cast<std::uint64_t>(std::ceil(seconds_ / dt - 1e-6));
    const double every = options_.every > 0 ? options_.every : std::max(seconds_ / 10, dt);
    if (seconds_ / every > MOST_FRAMES) {
        return {EXIT_BAD_INPUT,
                "--every " + std::to_string(every) + " gives more than 100000 frames in " + std::to_string(seconds_) + " s"};
    }
    for (std::uint64_t k = 0;; ++k) {
        const std::uint64_t step = step_at(static_cast<double>(k) * every, dt);
        // The last frame shows the end; one just before it would show the same.
        if (step >= steps_ || (k > 0 && static_cast<double>(steps_ - step) * dt < every / 2)) break;
        if (frame_steps_.empty() || step > frame_steps_.back()) frame_steps_.push_back(step);
    }
    frame_steps_.push_back(steps_);
    if (options_.calm_speed > 0) look_every_ = std::max<std::uint64_t>(1, step_at(options_.calm_seconds / CALM_LOOKS, dt));
    for (const DumpRequest& dump : options_.dumps) {
        if (step_at(dump.time, dt) > steps_) {
            return {EXIT_BAD_INPUT, "--dump " + dump.field_name + "@" + dump.time_text + ": the recording ends at " +
                                        std::to_string(seconds_) + " s (--seconds)"};
        }
    }
    return {};
}

Failure Recording::plan_points() {
    PointTable gauges(out_ / "gauges.csv", "gauge"), sections(out_ / "sections.csv", "section");
    for (auto* const part : {&gauges, &sections}) {
        std::uint32_t number = 0;
        for (const PointRequest& request : part == &gauges ? options_.gauges : options_.sections)
            if (Failure failure = part->add(world_.info(), number++, request, options_.map_coordinates)) return failure;
        if (!part->empty()) tables_.push_back(std::move(*part));
    }
    return {};
}

/// Creates the folders and removes the frames of an earlier recording, so that nobody mixes the two.
Failure Recording::prepare_folder() {
    std::vector<fs::path> folders;
    if (const fs::path folder = fs::path(options_.summary).parent_path(); !folder.empty()) folders.push_back(folder);
    if (options_.frames || !options_.dumps.empty() || !tables_.empty()) folders.push_back(out_);
    std::error_code error;
    for (const fs::path& folder : folders) {
        fs::create_directories(folder, error);
        if (error) return {EXIT_BAD_INPUT, "cannot create the folder " + folder.string() + ": " + error.message()};
    }
    if (!options_.frames) return {};
    int removed = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(out_, error)) {
        const std::string name = entry.path().filename().string();
        const bool is_frame = name.size() == 15 && name.starts_with("frame_") && name.ends_with(".png") &&
                              std::all_of(name.begin() + 6, name.begin() + 11, [](char c) { return c >= '0' && c <= '9'; });
        if (is_frame && fs::remove(entry.path(), error)) ++removed;
    }
    fs::remove(out_ / VIDEO, error);
    if (removed > 0) std::printf("removed %d frames of an earlier recording from %s\n", removed, out_.string().c_str());
    return {};
}

/// To the target, or to where the run is interrupted or calm.
Failure Recording::advance(std::uint64_t target) {
    if (look_every_ == 0) return step_to(target);
    while (done_ < target && !calm_ && !common::interrupted()) {
        if (Failure failure = step_to(std::min(target, next_look_))) return failure;
        if (done_ != next_look_) continue;
        if (Failure failure = look_for_calm()) return failure;
        next_look_ += look_every_;
    }
    return {};
}

/// Calm follows motion: a level that begins at rest, or waits for its sources, runs until something has moved.
Failure Recording::look_for_calm() {
    wadi_world_stats stats;
    const Clock::time_point start = Clock::now();
    if (Failure failure = world_.read_stats(stats)) return failure;
    report_.figures_seconds += seconds_since(start);
    const double speed = std::max(stats.largest_water_speed, stats.largest_sand_speed);
    if (!(speed <= options_.calm_speed)) {
        moved_ = true;
        slow_since_.reset();
        return {};
    }
    if (!slow_since_) slow_since_ = time_;
    const double least = options_.calm_seconds - 0.5 * world_.info().dt; // times are sums of steps
    if (!moved_ || time_ - *slow_since_ < least) return {};
    calm_ = true;
    report_.calm_since = slow_since_;
    return {};
}

Failure Recording::step_to(std::uint64_t target) {
    while (done_ < target && !common::interrupted()) {
        const std::uint32_t count = static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk_, target - done_));
        const Clock::time_point start = Clock::now();
        const std::clock_t processor_start = std::clock();
        if (Failure failure = world_.step(count)) return failure;
        if (!gpu_clock_read_ || seconds_since(*gpu_clock_read_) > GPU_CLOCK_SECONDS) {
            gpu_clock_->read();
            gpu_clock_read_ = Clock::now();
        }
        if (Failure failure = world_.wait(time_)) return failure;
        const double own = seconds_since(start);
        report_.processor_seconds += static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
        report_.stepping_seconds += own;
        report_.timed_steps += count;
        done_ += count;
        const double fitting = own > 0 ? count * CHUNK_SECONDS / own : 8.0 * count;
        chunk_ = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 8.0 * std::max(count, chunk_ / 8)));
        progress_->show(done_, time_, report_.stepping_seconds);
    }
    return {};
}

Failure Recording::sample_frame(bool last) {
    wadi_world_stats stats;
    Clock::time_point start = Clock::now();
    if (Failure failure = world_.read_stats(stats)) return failure;
    report_.sample(stats);
    report_.figures_seconds += seconds_since(start);
    for (PointTable& table : tables_) {
        if (Failure failure = table.sample(world_, time_)) return failure;
    }
    if (!options_.frames) return {};
    start = Clock::now();
    MapFields fields;
    if (Failure failure = world_.read_map(scaling_.reduce, fields)) return failure;
    if (!look_) look_ = choose_look(fields, options_.water_scale);
    if (!water_seen_) water_seen_ = scale_to_water(fields, options_.water_scale, *look_);
    const Image map = render_map(fields, *look_, scaling_);
    const Image frame = compose_frame(map, *look_, caption_, time_, metres_per_pixel_);
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05d.png", report_.frames);
    if (std::string error = common::write_file(out_ / name, common::encode_png(frame.data(), frame.width(), frame.height()));
        !error.empty())
        return {EXIT_BAD_INPUT, error};
    ++report_.frames;
    sheet_->add(map, time_, last);
    report_.picture_seconds += seconds_since(start);
    return {};
}

/// The fields asked for at this step; at the end of a run that got calm, those of later times as well.
Failure Recording::write_dumps() {
    for (const DumpRequest& dump : options_.dumps) {
        const std::uint64_t step = step_at(dump.time, world_.info().dt);
        if (step != done_ && !(calm_ && step > done_)) continue;
        if (Failure failure = write_dump(dump)) return failure;
    }
    return {};
}

Failure Recording::write_dump(const DumpRequest& dump) {
    std::vector<float> values;
    if (Failure failure = world_.read_field(static_cast<wadi_field>(dump.field), values)) return failure;
    const fs::path path = out_ / (dump.field_name + "_" + dump.time_text + "." + options_.dump_as);
    const wadi_world_info& info = world_.info();
    const common::GridPlace place = {info.nx, info.ny, info.dx, info.origin_x, info.origin_y};
    const std::string error =
        common::write_file(path, options_.dump_as == "asc"   ? common::encode_asc(values, place)
                                 : options_.dump_as == "tif" ? common::encode_geotiff(values, place)
                                                             : common::encode_npy(values, info.nx, info.ny));
    if (!error.empty()) return {EXIT_BAD_INPUT, error};
    char text[128];
    std::snprintf(text, sizeof text, "dump %s at t = %.9g s (step %llu, asked for %s s): ", dump.field_name.c_str(), time_,
                  static_cast<unsigned long long>(done_), dump.time_text.c_str());
    progress_->note(text + path.string());
    return {};
}

Failure Recording::record() {
    std::vector<std::uint64_t> stops = frame_steps_;
    for (const DumpRequest& dump : options_.dumps) stops.push_back(step_at(dump.time, world_.info().dt));
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    for (const std::uint64_t stop : stops) {
        if (Failure failure = advance(stop)) return failure;
        const bool interrupted = done_ < stop && !calm_, last = interrupted || calm_ || stop == steps_;
        if (last || stop == frame_steps_[next_frame_]) {
            if (Failure failure = sample_frame(last)) return failure;
            ++next_frame_;
        }
        report_.interrupted = interrupted;
        if (interrupted) return {};
        if (Failure failure = write_dumps()) return failure;
        if (calm_) return {};
    }
    return {};
}

/// What is written at the end of every recording, whole or not.
Failure Recording::finish() {
    for (PointTable& table : tables_) {
        if (Failure failure = table.close()) return failure;
    }
    if (sheet_ && !sheet_->empty()) {
        const Image sheet = sheet_->compose(*look_, caption_, metres_per_pixel_);
        const auto encode = options_.jpeg ? common::encode_jpeg : common::encode_png;
        const std::string error = common::write_file(out_ / sheet_name(), encode(sheet.data(), sheet.width(), sheet.height()));
        if (!error.empty()) return {EXIT_BAD_INPUT, error};
    }
    if (options_.mp4 && report_.frames > 0) {
        if (Failure failure = write_video(out_, options_.frames_per_second, out_ / VIDEO)) return failure;
    }
    if (!options_.summary.empty()) {
        if (std::string error = common::write_file(options_.summary, format_summary(report_)); !error.empty())
            return {EXIT_BAD_INPUT, error};
    }
    return {};
}

int Recording::run() {
    if (options_.mp4) {
        if (Failure failure = check_video_program()) return complain(failure);
    }
    {
        const LoadingNote note(options_.level_name);
        const Clock::time_point start = Clock::now();
        if (Failure failure = world_.create(options_)) return complain(failure);
        report_.loading_seconds = seconds_since(start);
    }
    if (options_.print_plan) {
        std::printf("%s", world_.describe_plan().c_str());
        return EXIT_DONE;
    }
    const wadi_world_info& info = world_.info();
    out_ = options_.out;
    scaling_ = choose_scaling(info.nx, info.ny);
    caption_ = {options_.level_name, info.nx, info.ny, info.dx, scaling_.enlarge_x == scaling_.enlarge_y};
    metres_per_pixel_ = info.dx * scaling_.reduce / scaling_.enlarge_x;
    if (Failure failure = plan()) return complain(failure);
    if (Failure failure = plan_points()) return complain(failure);
    if (Failure failure = prepare_folder()) return complain(failure);
    for (PointTable& table : tables_) {
        if (Failure failure = table.open()) return complain(failure);
    }

    report_.level = options_.level_name;
    report_.info = info;
    report_.warnings = world_.warnings();
    report_.calm_speed = options_.calm_speed;
    std::printf("%s: %d x %d cells of %g m, %.6g s in %llu steps, on %s: %s\n", options_.level_name.c_str(), info.nx, info.ny,
                info.dx, seconds_, static_cast<unsigned long long>(steps_), info.backend, info.device_name);
    std::fflush(stdout);

    if (options_.frames) sheet_.emplace(frame_steps_.size());
    progress_.emplace(seconds_, steps_);
    gpu_clock_.emplace(info.device_name);
    common::catch_interrupt();
    const Clock::time_point start = Clock::now();
    Failure failure = record();
    if (failure && failure.exit_code == EXIT_DEVICE_FAULT) report_.fault = failure.message;
    if (!failure && options_.profile) failure = world_.read_timings(report_.stages);
    report_.wall_seconds = seconds_since(start);
    report_.clock_readings = gpu_clock_->readings();
    report_.clock_last = gpu_clock_->last();
    report_.clock_least = gpu_clock_->least();
    progress_->finish();
    const Failure unwritten = finish();

    if (report_.stats.struct_size != 0) std::printf("\n%s", format_table(report_).c_str());
    if (report_.frames > 0) {
        std::printf("%d frames%s and %s are in %s%s\n", report_.frames, options_.mp4 && !unwritten ? ", recording.mp4" : "",
                    sheet_name(), out_.string().c_str(), report_.interrupted ? " (interrupted)" : "");
    }
    if (failure) return complain(failure);
    if (unwritten) return complain(unwritten);
    if (options_.terrain_alone) {
        std::printf(
            "next: wadi-import MAP --out FOLDER makes a level of it, whose rain, sides, sources and holes are yours to change; "
            "--seconds %.6g runs on until it has drained, --size %dx%d is coarser and quicker\n",
            4 * seconds_, (info.nx + 1) / 2, (info.ny + 1) / 2);
    }
    return EXIT_DONE;
}

} // namespace

int run(const Options& options) {
    Recording recording(options);
    return recording.run();
}

} // namespace recorder
