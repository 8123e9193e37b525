#include "simulation.hpp"
#include "level_settings.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace viewer {
namespace {

constexpr std::array<wadi_output, 9> outputs = {WADI_OUTPUT_SAND_SURFACE,  WADI_OUTPUT_SAND_DEPTH, WADI_OUTPUT_WATER_DEPTH,
                                                WADI_OUTPUT_SATURATION,    WADI_OUTPUT_FOAM,       WADI_OUTPUT_FLOW,
                                                WADI_OUTPUT_SAND_VELOCITY, WADI_OUTPUT_WETNESS,    WADI_OUTPUT_SILT};
constexpr std::array<int, outputs.size()> floats = {1, 1, 1, 1, 1, 2, 2, 1, 1};
static_assert(std::tuple_size_v<Sources> == outputs.size() + 1); // the host's field

constexpr double LONGEST_SHORE = 64; // [m]: of a level whose waves foam by the default foam_energy

std::mutex log_mutex;
std::vector<std::string> log_lines;

void on_log(void*, wadi_log_level severity, const char* message) {
    if (severity > 1) return;
    const std::lock_guard lock(log_mutex);
    log_lines.emplace_back(message);
}

VkSemaphore make_exportable_timeline(const Gpu& gpu) {
    VkExportSemaphoreCreateInfo exported{VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO};
    exported.handleTypes = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, &exported};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
    VkSemaphore semaphore;
    check(vkCreateSemaphore(gpu.device, &info, nullptr, &semaphore), "vkCreateSemaphore");
    return semaphore;
}

/// A file that a level names, from the folder at `user`.
int32_t read_beside(void* user, const char* name, void* data, std::size_t* size) {
    std::ifstream file(*static_cast<const std::filesystem::path*>(user) / name, std::ios::binary | std::ios::ate);
    if (!file) return 0;
    const std::streamoff length = file.tellg();
    if (data != nullptr) {
        file.seekg(0);
        file.read(static_cast<char*>(data), static_cast<std::streamsize>(std::min(static_cast<std::size_t>(length), *size)));
        if (!file) return 0;
    }
    *size = static_cast<std::size_t>(length);
    return 1;
}

} // namespace

HostField host_field_of(int view) {
    const std::string name = views()[static_cast<std::size_t>(view)].name;
    return name == "strain"   ? HostField::strain
           : name == "stress" ? HostField::stress
           : name == "active" ? HostField::activity
           : name == "limits" ? HostField::limits
                              : HostField::none;
}

void check(wadi_result result, const char* what) {
    if (result != WADI_OK) throw std::runtime_error(std::string(what) + ": " + wadi_get_last_error());
}

std::vector<std::string> take_log() {
    const std::lock_guard lock(log_mutex);
    return std::exchange(log_lines, {});
}

std::vector<SimulationDevice> simulation_devices() {
    std::vector<SimulationDevice> devices = {
        {"auto", -1, "auto"}, {"cpu", -1, "cpu"}, {"vulkan", -1, "vulkan, where it is drawn"}};
    uint32_t count = 0;
    check(wadi_list_devices(nullptr, &count, nullptr, 0), "listing devices");
    std::vector<wadi_device_info> infos(count);
    for (wadi_device_info& info : infos) info.struct_size = sizeof info;
    check(wadi_list_devices(infos.data(), &count, nullptr, 0), "listing devices");
    for (const wadi_device_info& info : infos) {
        if (std::string(info.backend) == "cuda")
            devices.push_back({"cuda", info.index, "cuda " + std::to_string(info.index) + ", " + info.name});
    }
    return devices;
}

static bool has_effect(wadi_world_id world, const std::string& name) {
    uint32_t count = 0;
    check(wadi_world_get_effects(world, nullptr, &count), "effects");
    std::vector<wadi_effect_info> effects(count);
    check(wadi_world_get_effects(world, effects.data(), &count), "effects");
    return std::any_of(effects.begin(), effects.end(),
                       [&](const wadi_effect_info& one) { return one.on != 0 && one.name == name; });
}

Simulation::Simulation(const Gpu& gpu, const SimulationChoice& choice) : gpu_(gpu) {
    wadi_vulkan_host host = wadi_default_vulkan_host();
    host.instance = gpu.instance;
    host.physical_device = gpu.physical;
    host.device = gpu.device;
    host.get_instance_proc_addr = vkGetInstanceProcAddr;
    host.queue_family = gpu.family;
    host.queue = gpu.queue;
    host.timeline_semaphore = VK_TRUE;
    wadi_device_options options = wadi_default_device_options();
    options.backend = choice.backend.c_str();
    options.device = choice.device;
    options.threads = choice.threads;
    options.log = on_log;
    options.vulkan_host = choice.backend == "cpu" ? nullptr : &host;
    wadi_level_overrides overrides = wadi_default_level_overrides();
    overrides.nx = choice.nx;
    overrides.ny = choice.ny;
    overrides.variant = choice.variant.empty() ? nullptr : choice.variant.c_str();
    const bool fine = choice.accuracy.empty() && choice.backend != "cpu" && gpu.discrete;
    overrides.accuracy = fine                                                    ? "fine"
                         : choice.accuracy.empty() || choice.accuracy == "level" ? nullptr
                                                                                 : choice.accuracy.c_str();
    // What covers a shore with foam covers a flood in a valley all over: there the foam of the moment shows more.
    const double length = longest_side(choice.level_file, choice.text);
    overrides.draws = WADI_OUTPUT_BIT(WADI_OUTPUT_WETNESS) | WADI_OUTPUT_BIT(WADI_OUTPUT_SILT);
    if (length > 0 && length <= LONGEST_SHORE) overrides.draws |= WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM);
    overrides.method = choice.method.empty() ? nullptr : choice.method.c_str();
    std::filesystem::path folder = std::filesystem::path(choice.level_file).parent_path();
    check(choice.text.empty()
              ? wadi_create_world_from_level(choice.level_file.c_str(), &overrides, &options, &world)
              : wadi_create_world_from_level_text(choice.text.c_str(), read_beside, &folder, &overrides, &options, &world),
          "creating the world");
    try {
        info = wadi_default_world_info();
        check(wadi_world_get_info(world, &info), "describing the world");
        on_host_ = std::string(info.backend) == "cpu";
        if (std::string(info.backend) == "cuda") timeline_ = make_exportable_timeline(gpu);

        wadi_world_stats stats = wadi_default_world_stats();
        check(wadi_world_get_stats(world, &stats), "statistics");
        quantum_ = stats.quantum;
        grid.nx = info.nx;
        grid.ny = info.ny;
        grid.dx = static_cast<float>(info.dx);
        const std::size_t cells = static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(info.ny);
        std::vector<float> heights(cells);
        check(wadi_world_read_field(world, WADI_FIELD_TERRAIN, heights.data(), cells), "reading the terrain");
        const float lowest = *std::min_element(heights.begin(), heights.end());
        check(wadi_world_read_field(world, WADI_FIELD_FREE_SURFACE, heights.data(), cells), "reading the surface");
        const float highest = *std::max_element(heights.begin(), heights.end());
        const float longest = std::max(grid.lengths().x, grid.lengths().y);
        grid.block.low = {0, 0, lowest - 0.03f * longest};
        grid.block.high = {grid.lengths().x, grid.lengths().y, std::max(highest, lowest + 0.02f * longest)};
        choose_outputs();
        make_buffers();
        set_recording(false);
        update(0);
    } catch (...) {
        wadi_destroy_world(world);
        throw;
    }
}

Simulation::~Simulation() {
    vkQueueWaitIdle(gpu_.queue);
    wadi_destroy_world(world);
    if (timeline_ != VK_NULL_HANDLE) vkDestroySemaphore(gpu_.device, timeline_, nullptr);
}

void Simulation::choose_outputs() {
    uint32_t mask = 0;
    for (wadi_output output : outputs) mask |= WADI_OUTPUT_BIT(output);
    const uint32_t tiles = host_field_ == HostField::activity ? WADI_OUTPUT_TILES_BIT : 0;
    if (on_host_) check(wadi_world_set_host_outputs(world, mask), "asking for outputs");
    check(wadi_world_set_outputs(world, (on_host_ ? 0 : mask) | tiles), "asking for outputs");
}

void Simulation::make_buffers() {
    const auto row = static_cast<VkDeviceSize>(info.nx) * sizeof(float);
    host_field_buffer_ = Buffer(gpu_, row, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true);
    std::memset(host_field_buffer_.mapped, 0, row);
    sources_[outputs.size()] = {host_field_buffer_.handle, 0, 0};
    if (on_host_) {
        for (std::size_t n = 0; n < outputs.size(); ++n) {
            const auto bytes = row * static_cast<VkDeviceSize>(info.ny) * static_cast<VkDeviceSize>(floats[n]);
            staging_[n] = Buffer(gpu_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true);
            sources_[n] = {staging_[n].handle, 0, info.nx * floats[n]};
        }
    }
}

void Simulation::show(HostField field) {
    if (field == host_field_) return;
    vkQueueWaitIdle(gpu_.queue); // the last picture may read the buffer
    if (host_field_ == HostField::none) {
        const auto bytes = static_cast<VkDeviceSize>(info.nx) * static_cast<VkDeviceSize>(info.ny) * sizeof(float);
        host_field_buffer_ = Buffer(gpu_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true);
        sources_[outputs.size()] = {host_field_buffer_.handle, 0, info.nx};
    }
    const bool tiles = field == HostField::activity, had_tiles = host_field_ == HostField::activity;
    host_field_ = field;
    std::memset(host_field_buffer_.mapped, 0, host_field_buffer_.bytes);
    if (tiles != had_tiles) choose_outputs();
}

void Simulation::fill_host_field(bool whole) {
    if (host_field_ == HostField::strain || host_field_ == HostField::stress) read_strain();
    if (host_field_ == HostField::activity) read_activity(whole);
    if (host_field_ == HostField::limits) read_limits();
}

// Of the left stretch V in the plane: the size of ln V, or that of the stress that material of these numbers answers with, in
// kPa.
void Simulation::read_strain() {
    const std::size_t cells = static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(info.ny);
    std::vector<float> xx(cells), xy(cells), yy(cells);
    check(wadi_world_read_field(world, WADI_FIELD_STRETCH_XX, xx.data(), cells), "reading the strain");
    check(wadi_world_read_field(world, WADI_FIELD_STRETCH_XY, xy.data(), cells), "reading the strain");
    check(wadi_world_read_field(world, WADI_FIELD_STRETCH_YY, yy.data(), cells), "reading the strain");
    std::array<wadi_material_info, 64> material{};
    auto count = static_cast<uint32_t>(material.size());
    check(wadi_world_get_material(world, material.data(), &count), "the material");
    const auto number = [&](const char* name) {
        for (const wadi_material_info& known : material) {
            if (std::strcmp(known.name, name) == 0) return static_cast<float>(known.value);
        }
        return 0.0f;
    };
    const float young = 1e-3f * number("young_modulus"), poisson = number("poisson_ratio");
    const float lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), shear = young / (2 * (1 + poisson));
    auto* to = static_cast<float*>(host_field_buffer_.mapped);
    for (std::size_t n = 0; n < cells; ++n) {
        const float mean = 0.5f * (xx[n] + yy[n]), radius = std::hypot(0.5f * (xx[n] - yy[n]), xy[n]);
        const float a = std::log1p(std::max(mean + radius, -0.99f)), b = std::log1p(std::max(mean - radius, -0.99f));
        const float trace = lambda * (a + b), area = std::exp(a + b);
        to[n] =
            host_field_ == HostField::strain ? std::hypot(a, b) : std::hypot(trace + 2 * shear * a, trace + 2 * shear * b) / area;
    }
}

// The worst of a cell: 4 a column too high, 3 the speed limit, 2 capped gravity, 1 limited outflow, of water or sand.
void Simulation::read_limits() {
    auto* to = static_cast<float*>(host_field_buffer_.mapped);
    const std::size_t cells = static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(info.ny);
    check(wadi_world_read_field(world, WADI_FIELD_LIMITS, to, cells), "reading the limits");
    for (std::size_t n = 0; n < cells; ++n) {
        const auto held = static_cast<unsigned>(to[n]);
        to[n] = (held & WADI_LIMIT_HEIGHT) != 0                                      ? 4.0f
                : (held & (WADI_LIMIT_WATER_SPEED | WADI_LIMIT_SAND_SPEED)) != 0     ? 3.0f
                : (held & (WADI_LIMIT_WATER_GRAVITY | WADI_LIMIT_SAND_GRAVITY)) != 0 ? 2.0f
                : held != 0                                                          ? 1.0f
                                                                                     : 0.0f;
    }
}

// 1 in tiles whose surface changed in the newest publish.
void Simulation::read_activity(bool whole) {
    uint32_t count = 0;
    uint64_t step = 0;
    wadi_result result = WADI_NOT_READY;
    for (;;) {
        result = wadi_world_get_tiles(world, nullptr, &count, &step);
        if (!whole || (result == WADI_OK && step == frame.published_step)) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        update(0);
    }
    if (result == WADI_NOT_READY) return;
    std::vector<wadi_tile> tiles(count);
    check(wadi_world_get_tiles(world, tiles.data(), &count, &step), "tiles");
    auto* to = static_cast<float*>(host_field_buffer_.mapped);
    for (const wadi_tile& tile : tiles) {
        const float active = static_cast<int64_t>(step) == tile.changed_step ? 1.0f : 0.0f;
        for (int j = tile.j; j < tile.j + tile.ny; ++j)
            std::fill_n(to + static_cast<std::size_t>(j) * static_cast<std::size_t>(info.nx) + tile.i, tile.nx, active);
    }
}

void Simulation::set_recording(bool on) {
    wadi_update_settings settings = wadi_default_update_settings();
    settings.interpolate_outputs = on_host_ ? 0 : 1;
    if (on) {
        settings.max_steps_per_update = 1024;
        settings.max_steps_in_flight = 0;
    }
    check(wadi_world_set_update_settings(world, &settings), "setting the rhythm of updates");
}

void Simulation::update(uint64_t nanoseconds) {
    frame = wadi_default_frame();
    if (timeline_ != VK_NULL_HANDLE) {
        const wadi_vulkan_sync before{timeline_, timeline_value_};
        check(wadi_vulkan_wait(world, &before, 1), "waiting for the picture");
    }
    check(wadi_world_update(world, nanoseconds, &frame), "updating");
    if (timeline_ != VK_NULL_HANDLE) {
        const wadi_vulkan_sync after{timeline_, ++timeline_value_};
        check(wadi_vulkan_signal(world, &after), "signalling the picture");
    }
}

Submission Simulation::next_submission() {
    Submission next;
    if (timeline_ == VK_NULL_HANDLE) return next;
    next.timeline = timeline_;
    next.timeline_value = timeline_value_++;
    return next;
}

void Simulation::step(uint32_t steps) { check(wadi_world_step(world, steps), "stepping"); }

bool Simulation::stage() {
    for (std::size_t n = 0; n < outputs.size(); ++n) {
        const float* data = nullptr;
        uint64_t row_pitch = 0, step = 0;
        const wadi_result result = wadi_world_get_host_output(world, outputs[n], &data, &row_pitch, &step);
        if (result == WADI_NOT_READY) return false;
        check(result, "fetching an output");
        const std::size_t row_bytes = static_cast<std::size_t>(info.nx) * static_cast<std::size_t>(floats[n]) * sizeof(float);
        for (std::size_t j = 0; j < static_cast<std::size_t>(info.ny); ++j) {
            std::memcpy(static_cast<char*>(staging_[n].mapped) + j * row_bytes,
                        reinterpret_cast<const char*>(data) + j * row_pitch, row_bytes);
        }
        staged_step_ = step;
    }
    return true;
}

const Sources& Simulation::sources(bool whole) {
    grid.foam_drifts = has_effect(world, "foam"); // it may have come with the first water
    fill_host_field(whole);
    if (on_host_) {
        while (!stage() || (whole && staged_step_ != frame.total_steps)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            update(0);
        }
        return sources_;
    }
    for (std::size_t n = 0; n < outputs.size(); ++n) {
        wadi_output_view view = wadi_default_output_view();
        wadi_result result =
            floats[n] == 1 ? wadi_world_get_view(world, outputs[n], WADI_OUTPUT_INTERPOLATED, &view) : WADI_NOT_READY;
        if (result == WADI_NOT_READY) result = wadi_world_get_view(world, outputs[n], WADI_OUTPUT_CURRENT, &view);
        check(result, "viewing an output");
        sources_[n] = {reinterpret_cast<VkBuffer>(view.handle), static_cast<int>(view.offset / sizeof(float)),
                       static_cast<int>(view.row_pitch / sizeof(float))};
    }
    return sources_;
}

} // namespace viewer
