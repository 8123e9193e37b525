// wadi-paths: what a frame costs by each way that outputs can take to a renderer, without one: a step alone, outputs to host
// memory, from there up into images, outputs copied into images on the device. Writes a table in Markdown. All ways must end with
// the same bits, and a step more must change them; exit status 1 where not.
#include "tests/latency/images.hpp"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace paths {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto frame_time = std::chrono::nanoseconds(16'666'667); // 60 Hz
constexpr int warm_up = 10;                                       // frames, which allocate

struct Options {
    std::vector<std::string> levels{"castle", "dam_break"}, backends{"cpu", "cuda", "vulkan"};
    std::vector<int> sizes{256, 512, 1024};
    int frames = 300;
    std::string levels_folder = WADI_LEVELS_DIR;
};

enum class Way { wait, step, host, host_to_images, shared };
const char* name_of(Way way) {
    switch (way) {
    case Way::wait:
        return "nothing: the wait alone";
    case Way::step:
        return "step";
    case Way::host:
        return "step, outputs to host memory";
    case Way::host_to_images:
        return "step, outputs to host memory and up into images";
    default:
        return "step, outputs into images on the device";
    }
}

/// Milliseconds of one kind of frame.
using Times = std::vector<double>;
double percentile(Times times, double share) {
    std::sort(times.begin(), times.end());
    return times[std::min(times.size() - 1, static_cast<std::size_t>(share * static_cast<double>(times.size())))];
}

std::uint64_t digest_of(const Texels& texels) {
    std::uint64_t hash = 14695981039346656037u; // FNV-1a
    for (const auto& rows : texels) {
        for (const std::byte byte : rows) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 1099511628211u;
    }
    return hash;
}

/// A world that goes one water step a frame.
class Frames {
  public:
    Frames(const Options& options, const std::string& level, int size, const std::string& backend, Way way,
           const wadi_vulkan_host* host)
        : way_(way) {
        auto overrides = wadi_default_level_overrides();
        overrides.nx = overrides.ny = size;
        auto device = wadi_default_device_options();
        device.backend = backend.c_str();
        if (way == Way::shared) device.vulkan_host = host;
        const std::string file = options.levels_folder + "/" + level + "/level.json";
        check(wadi_create_world_from_level(file.c_str(), &overrides, &device, &world_), file.c_str());
        check(wadi_world_get_info(world_, &info_), "wadi_world_get_info");
        wadi_output_mask mask = 0;
        for (const Drawn& one : drawn) mask |= WADI_OUTPUT_BIT(one.output);
        // The masks of plugin/godot/source/scene/outputs.c.
        if (way >= Way::host)
            check(wadi_world_set_outputs(world_, WADI_OUTPUT_TILES_BIT | (way == Way::shared ? mask : 0)),
                  "wadi_world_set_outputs");
        if (way == Way::host || way == Way::host_to_images)
            check(wadi_world_set_host_outputs(world_, mask), "wadi_world_set_host_outputs");
        if (way == Way::shared || way == Way::host_to_images) images_ = std::make_unique<Images>(*host, size, size);
    }
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;
    ~Frames() {
        images_.reset();
        check(wadi_destroy_world(world_), "wadi_destroy_world");
    }

    /// As the add-on's tick: the device is not waited for, host memory is that of the frame before.
    void tick() {
        if (way_ == Way::wait) return;
        update(true);
        if (way_ == Way::shared) images_->copy_from(world_);
        if (way_ == Way::host || way_ == Way::host_to_images) take();
        if (way_ == Way::host_to_images) images_->upload(texels_);
    }
    /// Until the outputs are where they are to be.
    void tick_and_wait() {
        if (way_ != Way::wait) update(true);
        if (way_ == Way::shared) images_->copy_from(world_);
        wait();
        if (way_ != Way::host && way_ != Way::host_to_images) return;
        do update(false);
        while (!take());
        if (way_ == Way::host_to_images) {
            images_->upload(texels_);
            images_->wait();
        }
    }
    /// Digest of the outputs after so many steps altogether, 0 where there are none.
    std::uint64_t outputs_after(std::uint64_t steps) {
        std::uint64_t done = 0;
        check(wadi_world_get_time(world_, nullptr, &done), "wadi_world_get_time");
        check(wadi_world_step(world_, static_cast<std::uint32_t>(steps - done)), "wadi_world_step");
        if (way_ == Way::wait || way_ == Way::step) return 0;
        update(false);
        if (way_ == Way::shared) images_->copy_from(world_);
        wait();
        if (way_ != Way::shared) {
            do update(false);
            while (!take());
        }
        if (way_ == Way::host_to_images) images_->upload(texels_);
        return digest_of(images_ ? images_->contents() : texels_);
    }
    std::uint64_t hash() const { return hash_of(world_); }
    const wadi_world_info& info() const { return info_; }
    std::uint64_t dropped() const { return dropped_; }

  private:
    void update(bool with_step) {
        std::uint64_t due = 0;
        if (with_step) { // in all a little more than so many whole steps
            const auto total = static_cast<std::uint64_t>(static_cast<double>(++ticks_) * info_.dt * 1e9) + 2;
            due = total - host_time_;
            host_time_ = total;
        }
        auto frame = wadi_default_frame();
        check(wadi_world_update(world_, due, &frame), "wadi_world_update");
        if (with_step && frame.steps == 0) ++dropped_;
        step_ = frame.total_steps;
    }
    /// Waits for all that the device has, by reading a cell.
    void wait() const {
        const wadi_region corner{0, 0, 1, 1};
        float height = 0;
        check(wadi_world_read_region(world_, WADI_FIELD_TERRAIN, &corner, &height, 1), "wadi_world_read_region");
    }
    /// The newest outputs in host memory, row by row into memory of the host's own, as an engine's image has them. True: of this
    /// step.
    bool take() {
        std::uint64_t shown = UINT64_MAX;
        for (std::size_t n = 0; n < drawn.size(); ++n) {
            const float* data = nullptr;
            std::uint64_t pitch = 0;
            const wadi_result result = wadi_world_get_host_output(world_, drawn[n].output, &data, &pitch, &shown);
            if (result == WADI_NOT_READY) return false;
            check(result, "wadi_world_get_host_output");
            const std::size_t row = drawn[n].bytes * static_cast<std::size_t>(info_.nx);
            texels_[n].resize(row * static_cast<std::size_t>(info_.ny));
            const auto* from = reinterpret_cast<const std::byte*>(data);
            for (std::size_t j = 0; j < static_cast<std::size_t>(info_.ny); ++j)
                std::memcpy(texels_[n].data() + j * row, from + j * pitch, row);
        }
        return shown == step_;
    }

    const Way way_;
    wadi_world_id world_{};
    wadi_world_info info_ = wadi_default_world_info();
    std::unique_ptr<Images> images_;
    Texels texels_;
    std::uint64_t ticks_ = 0, host_time_ = 0, step_ = 0, dropped_ = 0;
};

template <class Frame> Times measured(int frames, bool paced, Frame frame) {
    Times times;
    auto next = Clock::now();
    for (int n = 0; n < frames; ++n) {
        const auto start = Clock::now();
        frame();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        next = std::max(next + frame_time, Clock::now());
        if (paced) std::this_thread::sleep_until(next);
    }
    return times;
}

/// What a world must have in common with all others of its level and grid.
struct Ends {
    std::map<std::uint64_t, std::string> hashes, outputs;
};
/// Names by backend.
using Devices = std::map<std::string, std::string>;

bool run(const Options& options, const std::string& level, int size, const std::string& backend, Way way,
         const wadi_vulkan_host* host, Ends& ends, Devices& devices) {
    Frames frames(options, level, size, backend, way, host);
    for (int n = 0; n < warm_up; ++n) frames.tick_and_wait();
    const auto waited = [&] { frames.tick_and_wait(); };
    const Times thread = measured(options.frames, true, [&] { frames.tick(); });
    waited();
    const Times paced = measured(options.frames, true, waited), unpaced = measured(options.frames, false, waited);

    const auto& info = frames.info();
    devices[info.backend + std::string(way == Way::shared ? ", the host's device" : "")] = info.device_name;
    std::printf("| %s | %d x %d | %s | %s |", level.c_str(), info.nx, info.ny, info.backend, name_of(way));
    for (const Times& times : {thread, paced, unpaced})
        std::printf(" %.3f | %.3f |", percentile(times, 0.5), percentile(times, 0.99));
    std::printf(" %llu |\n", static_cast<unsigned long long>(frames.dropped()));
    std::fflush(stdout);
    if (way == Way::wait) return true;

    const auto steps = static_cast<std::uint64_t>(warm_up + 1 + 3 * options.frames);
    const std::string who = std::string(info.backend) + ", " + name_of(way);
    const std::uint64_t outputs = frames.outputs_after(steps), hash = frames.hash();
    if (info.exact_float == 1) ends.hashes[hash] = who;
    if (info.exact_float == 1 && way != Way::step) ends.outputs[outputs] = who;
    const bool moved = (frames.outputs_after(steps + 1) != outputs || way == Way::step) && frames.hash() != hash;
    if (!moved) std::fprintf(stderr, "wadi-paths: %s, %s: a step more changes nothing\n", level.c_str(), who.c_str());
    return moved;
}

bool same(const std::map<std::uint64_t, std::string>& found, const char* what) {
    if (found.size() <= 1) return true;
    std::fprintf(stderr, "wadi-paths: %s differ:\n", what);
    for (const auto& [digest, who] : found)
        std::fprintf(stderr, "  %016llx %s\n", static_cast<unsigned long long>(digest), who.c_str());
    return false;
}

std::vector<std::string> backends_here() {
    std::uint32_t count = 0;
    check(wadi_list_devices(nullptr, &count, nullptr, 0), "wadi_list_devices");
    std::vector<wadi_device_info> infos(count, wadi_default_device_info());
    std::vector<char> notes(4096);
    check(wadi_list_devices(infos.data(), &count, notes.data(), notes.size()), "wadi_list_devices");
    std::fputs(notes.data(), stderr);
    std::vector<std::string> names;
    for (const auto& info : infos) names.emplace_back(info.backend);
    return names;
}

bool run_all(const Options& options) {
    const auto here = backends_here();
    const auto has = [](const std::vector<std::string>& list, const std::string& name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    };
    const bool vulkan = has(here, "vulkan");
    const wadi_vulkan_host host = vulkan ? make_device(0) : wadi_default_vulkan_host();
    std::printf("One water step a frame; outputs packed, sand_depth, flow: 28 bytes a cell; %d frames each way of timing; ms.\n\n"
                "| level | cells | backend | a frame | thread, 60 Hz: median | p99 | done, 60 Hz: median | p99 | done, unpaced: "
                "median | p99 "
                "| frames dropped |\n| --- | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
                options.frames);
    bool good = true;
    Devices devices;
    for (const auto& level : options.levels) {
        for (const int size : options.sizes) {
            Ends ends;
            for (const auto& backend : options.backends) {
                if (!has(here, backend)) continue;
                for (const Way way : {Way::wait, Way::step, Way::host, Way::host_to_images, Way::shared}) {
                    if (way == Way::host_to_images && !vulkan) continue;
                    if (way == Way::shared && backend != "vulkan") continue;
                    good = run(options, level, size, backend, way, &host, ends, devices) && good;
                }
            }
            good = same(ends.hashes, "the states' hashes") && same(ends.outputs, "the outputs") && good;
        }
    }
    std::puts("");
    for (const auto& [backend, name] : devices) std::printf("- %s: %s\n", backend.c_str(), name.c_str());
    if (vulkan) destroy_device(&host);
    return good;
}

} // namespace
} // namespace paths

int main(int argc, char** argv) {
    paths::Options options;
    CLI::App app("What a frame costs by each way that outputs can take to a renderer; a table in Markdown.");
    app.add_option("--levels", options.levels, "names of folders with a level.json")->delimiter(',')->capture_default_str();
    app.add_option("--levels-folder", options.levels_folder, "where they are")->check(CLI::ExistingDirectory);
    app.add_option("--sizes", options.sizes, "cells along x and along y")
        ->delimiter(',')
        ->check(CLI::Range(8, 16384))
        ->capture_default_str();
    app.add_option("--backends", options.backends, "those that are not here are left out")
        ->delimiter(',')
        ->check(CLI::IsMember({"cpu", "cuda", "vulkan"}))
        ->capture_default_str();
    app.add_option("--frames", options.frames, "for each of the three ways of timing")
        ->check(CLI::Range(2, 100000))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return paths::run_all(options) ? 0 : 1;
}
