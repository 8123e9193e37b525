// The world, through the plugin's C interface: on the host's own device, with its outputs in place.
#pragma once
#include "../common/gpu.hpp"
#include <algorithm>
#include <array>
#include <cstring>
#include <wadi/wadi_vulkan.h>

using common::check; // of Vulkan's results
inline void check(wadi_result result, const char* what) {
    if (result != WADI_OK) throw std::runtime_error(std::string(what) + ": " + wadi_get_last_error());
}

class World {
  public:
    // In the order of scene.glsl.
    static constexpr std::array OUTPUTS = {WADI_OUTPUT_SAND_SURFACE, WADI_OUTPUT_SAND_DEPTH, WADI_OUTPUT_WATER_DEPTH,
                                           WADI_OUTPUT_SATURATION, WADI_OUTPUT_FOAM};
    struct Source { // an output of nx * ny floats: where it lies in a buffer, in floats
        VkBuffer buffer;
        int32_t first, pitch;
    };
    using Sources = std::array<Source, OUTPUTS.size()>;

    World(const common::Gpu& gpu, const std::string& file, const std::string& backend, int nx, int ny, bool live)
        : gpu_(gpu), live_(live) {
        wadi_vulkan_host host = wadi_default_vulkan_host();
        host.instance = gpu.instance, host.physical_device = gpu.physical, host.device = gpu.device;
        host.get_instance_proc_addr = vkGetInstanceProcAddr;
        host.queue_family = gpu.family, host.queue = gpu.queue, host.timeline_semaphore = VK_TRUE;
        wadi_device_options options = wadi_default_device_options();
        options.backend = backend.c_str();
        options.vulkan_host = backend == "vulkan" ? &host : nullptr;
        options.log = [](void*, wadi_log_level level, const char* text) {
            if (level != WADI_LOG_INFORMATION) std::fprintf(stderr, "%s\n", text);
        };
        wadi_level_overrides overrides = wadi_default_level_overrides();
        overrides.nx = nx, overrides.ny = ny;
        check(wadi_create_world_from_level(file.c_str(), &overrides, &options, &id), "creating the world");
        undo_.add([this] {
            vkDeviceWaitIdle(gpu_.device);
            wadi_destroy_world(id);
        });
        check(wadi_world_get_info(id, &info), "describing the world");
        std::vector<float> heights(static_cast<std::size_t>(info.nx * info.ny)); // read once, for camera and culling
        check(wadi_world_read_field(id, WADI_FIELD_TERRAIN, heights.data(), heights.size()), "reading the terrain");
        low = *std::min_element(heights.begin(), heights.end());
        check(wadi_world_read_field(id, WADI_FIELD_FREE_SURFACE, heights.data(), heights.size()), "reading the surface");
        high = *std::max_element(heights.begin(), heights.end());

        wadi_output_mask mask = 0;
        for (const wadi_output output : OUTPUTS) mask |= WADI_OUTPUT_BIT(output);
        if (on_device()) {
            check(wadi_world_set_outputs(id, mask), "asking for outputs");
            wadi_update_settings settings = wadi_default_update_settings();
            settings.interpolate_outputs = live; // moves evenly at any rate of pictures, one step late
            check(wadi_world_set_update_settings(id, &settings), "asking for interpolated outputs");
        } else {
            check(wadi_world_set_host_outputs(id, mask), "asking for outputs");
        }
        update(0);
        check(wadi_world_wait_for_outputs(id), "waiting for the first outputs");
    }
    World(const World&) = delete;

    wadi_world_id id{};
    wadi_world_info info = wadi_default_world_info();
    wadi_frame frame = wadi_default_frame();
    float low = 0, high = 0; // of the relief at the start [m]

    bool on_device() const { return std::strcmp(info.backend, "vulkan") == 0; }
    void update(uint64_t nanoseconds) {
        frame = wadi_default_frame();
        check(wadi_world_update(id, nanoseconds, &frame), "updating");
    }
    void step(uint32_t steps) {
        check(wadi_world_step(id, steps), "stepping");
        update(0); // publishes
    }
    /// Where the outputs to draw are, of the world's last update.
    Sources outputs() {
        if (!live_) check(wadi_world_wait_for_outputs(id), "waiting for outputs"); // a picture is of its very step
        Sources found{};
        for (std::size_t n = 0; n < found.size(); ++n) {
            if (on_device()) { // in place: the plugin's own buffers
                wadi_output_view view = wadi_default_output_view();
                wadi_result result =
                    live_ ? wadi_world_get_view(id, OUTPUTS[n], WADI_OUTPUT_INTERPOLATED, &view) : WADI_NOT_READY;
                if (result == WADI_NOT_READY) result = wadi_world_get_view(id, OUTPUTS[n], WADI_OUTPUT_CURRENT, &view);
                check(result, "viewing an output");
                found[n] = {reinterpret_cast<VkBuffer>(view.handle), static_cast<int32_t>(view.offset / sizeof(float)),
                            static_cast<int32_t>(view.row_pitch / sizeof(float))};
            } else { // the newest copy that has arrived in the host's memory
                const float* data = nullptr;
                uint64_t pitch = 0;
                check(wadi_world_get_host_output(id, OUTPUTS[n], &data, &pitch, nullptr), "fetching an output");
                const uint64_t bytes =
                    pitch * static_cast<uint64_t>(info.ny - 1) + sizeof(float) * static_cast<uint64_t>(info.nx);
                if (copies_[n].mapped == nullptr) copies_[n] = gpu_.make_buffer(bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, undo_);
                std::memcpy(copies_[n].mapped, data, bytes);
                found[n] = {copies_[n].handle, 0, static_cast<int32_t>(pitch / sizeof(float))};
            }
        }
        return found;
    }

  private:
    const common::Gpu& gpu_;
    bool live_; // pictures for a window; else single ones
    std::array<common::Buffer, OUTPUTS.size()> copies_;
    common::Undo undo_;
};
