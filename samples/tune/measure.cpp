#include "measure.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <numeric>
#include <wadi/wadi.h>

namespace tune {
namespace {

namespace fs = std::filesystem;

/// Files that a level names: inside its folder alone, links followed.
wadi_bool read_file(void* user, const char* name, void* data, std::size_t* size) {
    const fs::path folder = *static_cast<const fs::path*>(user);
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) return 0;
    const fs::path file = fs::canonical(root / name, error);
    if (error || std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end()) return 0;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error) return 0;
    if (data != nullptr) {
        if (*size < bytes) return 0;
        std::ifstream stream(file, std::ios::binary);
        if (!stream.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes))) return 0;
    }
    *size = static_cast<std::size_t>(bytes);
    return 1;
}

class World {
  public:
    World(const Level& level, const Settings& settings, const Device& device) {
        wadi_device_options options = wadi_default_device_options();
        options.backend = device.backend.c_str();
        options.device = device.device;
        options.threads = device.threads;
        fs::path folder = level.folder();
        check(wadi_create_world_from_level_text(level.text(settings).c_str(), read_file, &folder, nullptr, &options, &id));
        const wadi_result result = wadi_world_get_info(id, &info);
        if (result != WADI_OK) {
            wadi_destroy_world(id); // the destructor does not run
            check(result);
        }
    }
    ~World() { wadi_destroy_world(id); }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    static void check(wadi_result result) {
        if (result != WADI_OK) throw BadInput(wadi_get_last_error());
    }
    void step(std::uint64_t steps) {
        if (steps > 0) check(wadi_world_step(id, static_cast<std::uint32_t>(steps)));
    }
    void wait() {
        const wadi_region one_cell = {0, 0, 1, 1};
        float value = 0;
        check(wadi_world_read_region(id, WADI_FIELD_TERRAIN, &one_cell, &value, 1));
    }
    Surfaces surfaces() {
        Surfaces s{info.nx, info.ny, {}, {}};
        const auto cells = static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(info.ny);
        s.sand.resize(cells);
        s.surface.resize(cells);
        check(wadi_world_read_field(id, WADI_FIELD_SAND_DEPTH, s.sand.data(), cells));
        check(wadi_world_read_field(id, WADI_FIELD_FREE_SURFACE, s.surface.data(), cells));
        return s;
    }
    bool has(const char* effect) {
        std::uint32_t count = 0;
        check(wadi_world_get_effects(id, nullptr, &count));
        std::vector<wadi_effect_info> effects(count);
        check(wadi_world_get_effects(id, effects.data(), &count));
        for (const wadi_effect_info& info_of : effects) {
            if (std::strcmp(info_of.name, effect) == 0) return info_of.on != 0;
        }
        return false;
    }

    wadi_world_id id{};
    wadi_world_info info = wadi_default_world_info();
};

/// Between two steps, as a renderer shows them: runs of other steps are compared at the same time.
void blend(Surfaces& a, const Surfaces& b, float share) {
    for (std::size_t n = 0; n < a.sand.size(); ++n) {
        a.sand[n] += share * (b.sand[n] - a.sand[n]);
        a.surface[n] += share * (b.surface[n] - a.surface[n]);
    }
}

} // namespace

double now(const Device& device) {
    if (device.processor_time) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double Run::seconds() const { return std::accumulate(parts.begin(), parts.end(), 0.0); }

double Run::step_seconds() const { return seconds() / (part_ends.back() / dt); }

double Run::share(std::size_t count) const {
    double first = 0;
    for (std::size_t n = 0; n < std::min(count, parts.size()); ++n) first += parts[n];
    return first / seconds();
}

void Run::keep_quicker(const Run& other) {
    for (std::size_t n = 0; n < std::min(parts.size(), other.parts.size()); ++n) parts[n] = std::min(parts[n], other.parts[n]);
}

Run Runner::run(const Settings& settings, const RunRequest& request) const {
    World world(level_, settings, device_);
    Run run;
    run.settings = settings;
    run.dt = world.info.dt;
    run.device_name = world.info.device_name;
    run.backend = world.info.backend;
    if (device_.processor_time && run.backend != "cpu")
        throw BadInput("--processor-time: of the CPU backend alone, this is " + run.backend);
    for (std::uint32_t n = 0; n < world.info.warning_count; ++n) run.warnings.emplace_back(wadi_world_get_warning(world.id, n));
    if (request.keep_surfaces) run.at.push_back(world.surfaces());
    world.wait();

    double spent = 0;
    const auto advance = [&](std::uint64_t target) {
        while (run.steps < target) { // in pieces, so that a stop is not waited for
            if (stop_ && stop_()) throw Stopped();
            const std::uint64_t count = std::min<std::uint64_t>(target - run.steps, 256);
            const double start = now(device_);
            world.step(count);
            world.wait();
            const double taken = now(device_) - start;
            spent += taken;
            run.stepping += taken;
            run.steps += count;
        }
    };
    for (int part = 1; part <= request.parts && std::accumulate(run.parts.begin(), run.parts.end(), 0.0) < request.limit;
         ++part) {
        const double end = request.seconds * part / PARTS, ideal = end / run.dt;
        const auto whole = static_cast<std::uint64_t>(std::floor(ideal + 1e-6));
        spent = 0;
        const std::uint64_t before = run.steps;
        advance(whole);
        if (request.keep_surfaces && part % (PARTS / CHECKPOINTS) == 0) {
            Surfaces surfaces = world.surfaces();
            const double share = ideal - static_cast<double>(whole);
            if (share > 1e-3) {
                advance(whole + 1);
                blend(surfaces, world.surfaces(), static_cast<float>(share));
            }
            run.at.push_back(std::move(surfaces));
        }
        // Of the steps that fall into the part, whole or not.
        const double taken = static_cast<double>(run.steps - before), owed = request.seconds / PARTS / run.dt;
        if (taken > 0)
            run.parts.push_back(spent * owed / taken);
        else
            run.parts.push_back(run.parts.empty() ? 0 : run.parts.back()); // shorter than a step
        run.part_ends.push_back(end);
    }
    run.simulated = static_cast<double>(run.steps) * run.dt;
    run.has_sand = world.has("sand");
    run.has_water = world.has("water");
    return run;
}

} // namespace tune
