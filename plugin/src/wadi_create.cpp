// Devices, and worlds made from levels or arrays.
#include "backends/registry.hpp"
#include "engine/level/level.hpp"
#include "engine/settings/data/accuracy_presets.hpp"
#include "plugin/src/abi.hpp"
#include "plugin/src/cost.hpp"
#include "plugin/src/vulkan_host.hpp"
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>

using namespace wadi;
using namespace wadi::plugin;

namespace {

// What a host's callback throws ends here: behind it are drivers, which no exception may pass.
compute::Log to_log(const wadi_device_options& options) {
    if (options.log == nullptr) return {};
    return [log = options.log, user = options.log_user](int severity, const std::string& message) {
        const compute::DefaultFloats kept; // whatever the host's code sets
        try {
            std::string text = message;
            make_printable(text);
            log(user, static_cast<wadi_log_level>(severity), text.c_str());
        } catch (const ThreadCancelled&) {
            throw;
        } catch (...) {
        }
    };
}

/// What a host's job system is given of a pass: a part that begins once the pass is over, or again, finds nothing to do.
class JobGate {
  public:
    void open(const std::function<void()>& job) {
        const std::lock_guard lock(mutex_);
        job_ = &job;
    }
    /// Waits for the parts that are inside.
    void close() {
        std::unique_lock lock(mutex_);
        job_ = nullptr;
        left_.wait(lock, [this] { return inside_ == 0; });
    }
    void part() {
        const std::function<void()>* job = nullptr;
        {
            const std::lock_guard lock(mutex_);
            if (job_ == nullptr) return;
            job = job_;
            ++inside_;
        }
        (*job)();
        const std::lock_guard lock(mutex_);
        if (--inside_ == 0) left_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable left_;
    const std::function<void()>* job_ = nullptr;
    int inside_ = 0;
};

// A host's threads have a floating-point environment of their own, and so has what runs on them. Parts share what is left of a
// pass, so one more, here, does what the host's job system forgot.
compute::RunJobs to_run_jobs(const wadi_device_options& options) {
    if (options.run_jobs == nullptr) return {};
    return [run = options.run_jobs, user = options.jobs_user,
            gate = std::make_shared<JobGate>()](int count, const std::function<void()>& job) {
        const compute::DefaultFloats kept; // whatever the host's code sets
        const auto part = [](void* data, uint32_t) {
            const compute::DefaultFloats floats;
            static_cast<JobGate*>(data)->part();
        };
        gate->open(job);
        run(user, static_cast<uint32_t>(count), part, gate.get());
        gate->part();
        gate->close();
    };
}

// What the host's code throws is a refusal.
std::shared_ptr<const compute::Allocator> to_allocator(const wadi_device_options& options) {
    if (options.allocate_memory == nullptr) return nullptr;
    return std::make_shared<const compute::Allocator>(compute::Allocator{
        [allocate = options.allocate_memory, user = options.memory_user](std::size_t bytes, std::size_t alignment) -> void* {
            const compute::DefaultFloats kept; // whatever the host's code sets
            try {
                return allocate(user, bytes, alignment);
            } catch (const ThreadCancelled&) {
                throw;
            } catch (...) {
                return nullptr;
            }
        },
        [give_back = options.free_memory, user = options.memory_user](void* memory, std::size_t bytes) {
            const compute::DefaultFloats kept;
            try {
                give_back(user, memory, bytes);
            } catch (const ThreadCancelled&) {
                throw;
            } catch (...) {
            }
        }});
}

/// By default one core is left to the host's frame: updates beside threads on every core wait for the system to give one back.
/// A host's job system is its own to divide.
int threads_of(const wadi_device_options& options) {
    if (options.threads != 0 || options.run_jobs != nullptr) return options.threads;
    constexpr int most = 256; // of the CPU backend
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 1, most);
}

Result<std::unique_ptr<compute::Device>> open(const wadi_device_options& options, const compute::Log& log) {
    if (options.device < -1)
        return error(Code::bad_argument, "wadi_device_options.device: " + std::to_string(options.device) + " is below -1");
    if ((options.allocate_memory == nullptr) != (options.free_memory == nullptr))
        return error(Code::bad_argument, "wadi_device_options: allocate_memory and free_memory are given together or not at all");
    compute::DeviceOptions o;
    o.log = log;
    o.allocator = to_allocator(options);
    o.threads = threads_of(options);
    o.run_jobs = to_run_jobs(options);
    o.validate = options.validate != 0;
    if (options.vulkan_host != nullptr) {
#ifdef WADI_HAS_VULKAN
        auto host = to_host_device(options.vulkan_host);
        if (!host) return host.status();
        o.host = std::move(*host);
#else
        return error(Code::not_supported, "vulkan_host was given, but this build has no Vulkan");
#endif
    }
    return backends::open_device(options.backend != nullptr ? options.backend : "auto", options.device, o);
}

constexpr std::uint64_t draws_foam = WADI_OUTPUT_BIT(WADI_OUTPUT_FOAM), draws_wetness = WADI_OUTPUT_BIT(WADI_OUTPUT_WETNESS),
                        draws_silt = WADI_OUTPUT_BIT(WADI_OUTPUT_SILT);

LevelOverrides to_overrides(const wadi_level_overrides& o) {
    LevelOverrides overrides;
    if ((o.draws & draws_foam) != 0) overrides.drawn_effects |= EFFECT_FOAM;
    if ((o.draws & draws_wetness) != 0) overrides.drawn_effects |= EFFECT_WETNESS;
    if ((o.draws & draws_silt) != 0) overrides.drawn_effects |= EFFECT_SILT;
    if (o.nx != 0 || o.ny != 0) overrides.size = {o.nx, o.ny};
    if (o.dt != 0) overrides.dt = o.dt;
    if (o.method != nullptr) overrides.method = o.method;
    if (o.variant != nullptr) overrides.variant = o.variant;
    if (o.accuracy != nullptr) overrides.accuracy = o.accuracy;
    if (o.fused_stages != 0) overrides.fused_stages = o.fused_stages > 0 ? FusedStages::always : FusedStages::never;
    if (o.active_tiles != 0) overrides.active_tiles = o.active_tiles == -1 ? 0 : o.active_tiles;
    overrides.files = o.any_files != 0 ? FilesFrom::anywhere : FilesFrom::below;
    return overrides;
}

// The host's files: asked for their size first, then for their bytes.
FileReader host_files(wadi_read_file_callback read_file, void* user) {
    return [=](const std::string& name, std::uint64_t limit) -> Result<std::vector<std::uint8_t>> {
        const compute::DefaultFloats kept; // whatever the host's code sets
        std::size_t size = 0;
        if (read_file == nullptr || read_file(user, name.c_str(), nullptr, &size) == 0)
            return error(Code::not_found, name + (read_file == nullptr ? ": read_file is NULL" : ": read_file does not know it"));
        if (size > limit) {
            return error(Code::bad_file, name + ": " + std::to_string(size) + " bytes is more than the largest accepted file, " +
                                             std::to_string(limit) + " bytes");
        }
        std::vector<std::uint8_t> bytes(size);
        std::size_t filled = size;
        if (size > 0 && (read_file(user, name.c_str(), bytes.data(), &filled) == 0 || filled != size))
            return error(Code::bad_file, name + ": read_file gave no bytes, or another number than it had said");
        return bytes;
    };
}

// What a creating call was given; NULL: defaults.
struct Asked {
    wadi_device_options options = wadi_default_device_options();
    wadi_level_overrides overrides = wadi_default_level_overrides();
    std::optional<Cost> most;
    Status status = ok_status();

    Asked(const char* function, const wadi_level_overrides* level, const wadi_device_options* device) {
        const std::string call = std::string(function) + ": ";
        if (level != nullptr && (status = understood(call + "overrides", level))) overrides = taken(level, overrides);
        if (status && device != nullptr && (status = understood(call + "options", device))) options = taken(device, options);
        if (status && (overrides.fused_stages < -1 ||
                       overrides.fused_stages > 1)) // no setting refuses it later: its kind has no such value
            status = error(Code::bad_argument, call + "overrides.fused_stages is neither 1, -1 nor 0 (as the level says)");
        if (status && (overrides.draws & ~(draws_foam | draws_wetness | draws_silt)) != 0)
            status = error(Code::bad_argument, call + "overrides.draws has bits beside those of WADI_OUTPUT_FOAM (" +
                                                   std::to_string(draws_foam) + "), WADI_OUTPUT_WETNESS (" +
                                                   std::to_string(draws_wetness) + ") and WADI_OUTPUT_SILT (" +
                                                   std::to_string(draws_silt) + ")");
        if (status && options.most != nullptr) {
            auto limits = to_cost(call + "options.most", options.most);
            status = limits.status();
            if (limits) most = *limits;
        }
    }

    /// The host's progress callback hears of drawing as the first part of all.
    LevelOverrides engine_overrides() const {
        LevelOverrides engine = to_overrides(overrides);
        if (options.progress != nullptr) engine.progress = [this](double share) { return goes_on(DRAWING * share); };
        return engine;
    }
    static constexpr double DRAWING = 0.75; // of all that making a world takes
    bool goes_on(double share) const {
        if (options.progress == nullptr) return true;
        const compute::DefaultFloats kept; // whatever the host's code sets
        told = std::max(told, share);
        return options.progress(options.progress_user, told) != 0;
    }
    mutable double told = 0; // a share never falls
};

Status cancelled() { return error(Code::cancelled, "the host's progress callback ended the making of the world"); }

/// With what the world would hold on its device.
Result<Cost> with_device(Result<LevelCost> level) {
    if (!level) return level.status();
    auto effects = effects_required(level->settings, {level->sand, level->water});
    if (!effects) return effects.status();
    level->cost.device_bytes = most_device_bytes(level->settings, effects->mask);
    return level->cost;
}

/// ok where the host sets no limits, or none is passed; `cost` is asked only where there are some.
template <class Account> Status within_limits(const Asked& asked, const Account& account) {
    if (!asked.most) return ok_status();
    const Result<Cost> cost = with_device(account());
    return cost ? check_cost("level", *cost, *asked.most) : cost.status();
}

bool is_level_file(const std::string& path) { return path.ends_with(".json"); }

Result<LevelCost> cost_of_file(const std::string& path, const LevelOverrides& overrides) {
    return is_level_file(path) ? cost_of_level(path, overrides) : cost_of_terrain(path, overrides);
}

wadi_result host(Result<Level> level, const Asked& asked, wadi_world_id* id) {
    if (!level) return report(level.status());
    const wadi_device_options& options = asked.options;
    if (!asked.goes_on(Asked::DRAWING)) return report(cancelled());
    for (auto& warning : level->warnings) make_printable(warning);
    const auto log = to_log(options);
    auto device = open(options, log);
    if (!device) return report(device.status());
    auto world = World::create(level->settings, level->fields, std::move(*device));
    if (!world) return report(world.status());
    if (auto status = (*world)->set_log(log); !status) return report(status);
    if (log) {
        for (const auto& warning : level->warnings) log(1, level->name + ": " + warning);
        const auto& grid = level->settings.grid;
        log(2, level->name + ": " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " cells on " +
                   (*world)->device().capabilities().name + ", effects " + effect_names((*world)->state().effects().mask));
    }
    if (!asked.goes_on(1)) return report(cancelled());
    *id = plugin::worlds().add(
        {std::move(*world), level->name, level->duration, level->warnings, level->origin, options.threads, asked.most, {}});
    return report(ok_status());
}

} // namespace

extern "C" {

wadi_result wadi_list_accuracy_presets(wadi_accuracy_preset* presets, uint32_t* count) {
    return guarded(__func__, [&] {
        if (count == nullptr) return bad_argument("wadi_list_accuracy_presets: count is NULL");
        const uint32_t capacity = presets != nullptr ? *count : 0;
        uint32_t found = 0;
        for (const AccuracyPreset& preset : accuracy_presets()) {
            if (found < capacity) presets[found] = {preset.name, preset.cells, preset.substeps, preset.water_order};
            ++found;
        }
        *count = found;
        return report(ok_status());
    });
}

wadi_result wadi_list_devices(wadi_device_info* infos, uint32_t* count, char* notes, size_t notes_size) {
    return guarded(__func__, [&] {
        if (count == nullptr) return bad_argument("wadi_list_devices: count is NULL");
        const uint32_t capacity = infos != nullptr ? *count : 0;
        for (uint32_t n = 0; n < capacity; ++n) {
            const std::string what = "wadi_list_devices: infos[" + std::to_string(n) + "]";
            if (auto status = understood(what, element(infos, n)); !status) return report(status);
            if (element(infos, n)->struct_size != infos->struct_size)
                return bad_argument(what + ".struct_size is not that of infos[0]");
        }
        uint32_t found = 0;
        std::string why_none;
        for (const auto& backend : backends::all()) {
            std::string why;
            const auto devices = backends::list_devices(backend, why);
            if (devices.empty()) why_none += std::string(backend.name) + ": " + why + "\n";
            for (const auto& device : devices) {
                if (found < capacity) {
                    wadi_device_info info = wadi_default_device_info();
                    copy_text(info.backend, device.backend);
                    copy_text(info.name, device.name);
                    info.index = device.index;
                    info.is_software =
                        device.kind == compute::DeviceKind::cpu || device.kind == compute::DeviceKind::software_gpu;
                    info.memory_bytes = device.memory_bytes;
                    give(element(infos, found), info);
                }
                ++found;
            }
        }
        *count = found;
        if (notes != nullptr && notes_size > 0) std::snprintf(notes, notes_size, "%s", why_none.c_str());
        return report(ok_status());
    });
}

wadi_result wadi_create_world_from_level(const char* path, const wadi_level_overrides* overrides,
                                         const wadi_device_options* options, wadi_world_id* world) {
    return guarded(__func__, [&] {
        if (path == nullptr || world == nullptr) return bad_argument("wadi_create_world_from_level: path or world is NULL");
        const Asked asked("wadi_create_world_from_level", overrides, options);
        if (!asked.status) return report(asked.status);
        const ThreadLimit limit(asked.options.threads);
        const LevelOverrides engine = asked.engine_overrides();
        if (auto status = within_limits(asked, [&] { return cost_of_file(path, engine); }); !status) return report(status);
        return host(is_level_file(path) ? load_level(path, engine) : level_from_terrain(path, engine), asked, world);
    });
}

wadi_result wadi_create_world_from_level_text(const char* json, wadi_read_file_callback read_file, void* user,
                                              const wadi_level_overrides* overrides, const wadi_device_options* options,
                                              wadi_world_id* world) {
    return guarded(__func__, [&] {
        if (json == nullptr || world == nullptr) return bad_argument("wadi_create_world_from_level_text: json or world is NULL");
        const Asked asked("wadi_create_world_from_level_text", overrides, options);
        if (!asked.status) return report(asked.status);
        const ThreadLimit limit(asked.options.threads);
        const LevelOverrides engine = asked.engine_overrides();
        const FileReader files = host_files(read_file, user);
        if (auto status = within_limits(asked, [&] { return cost_of_level(json, files, engine); }); !status)
            return report(status);
        return host(parse_level(json, files, engine), asked, world);
    });
}

wadi_result wadi_get_level_cost(const char* path, const wadi_level_overrides* overrides, wadi_cost* cost) {
    return guarded(__func__, [&] {
        if (path == nullptr || cost == nullptr) return bad_argument("wadi_get_level_cost: path or cost is NULL");
        const Asked asked("wadi_get_level_cost", overrides, nullptr);
        if (!asked.status) return report(asked.status);
        return give_cost("wadi_get_level_cost", with_device(cost_of_file(path, to_overrides(asked.overrides))), cost);
    });
}

wadi_result wadi_get_level_text_cost(const char* json, wadi_read_file_callback read_file, void* user,
                                     const wadi_level_overrides* overrides, wadi_cost* cost) {
    return guarded(__func__, [&] {
        if (json == nullptr || cost == nullptr) return bad_argument("wadi_get_level_text_cost: json or cost is NULL");
        const Asked asked("wadi_get_level_text_cost", overrides, nullptr);
        if (!asked.status) return report(asked.status);
        return give_cost("wadi_get_level_text_cost",
                         with_device(cost_of_level(json, host_files(read_file, user), to_overrides(asked.overrides))), cost);
    });
}

wadi_result wadi_create_world_from_arrays(const wadi_world_arrays* arrays, const wadi_device_options* options,
                                          wadi_world_id* world) {
    return guarded(__func__, [&] {
        if (auto status = understood("wadi_create_world_from_arrays: arrays", arrays); !status) return report(status);
        const auto own = taken(arrays, wadi_default_world_arrays());
        const Asked asked("wadi_create_world_from_arrays", nullptr, options);
        if (!asked.status) return report(asked.status);
        if (own.settings_json == nullptr || world == nullptr)
            return bad_argument("wadi_create_world_from_arrays: settings_json or world is NULL");
        const ThreadLimit limit(asked.options.threads);
        const FileReader no_files = [](const std::string& name, std::uint64_t) -> Result<std::vector<std::uint8_t>> {
            return error(Code::bad_argument, name + ": settings_json may name no files");
        };
        const LevelOverrides engine = asked.engine_overrides();
        const auto account = [&] {
            auto of_settings = cost_of_level(own.settings_json, no_files, engine);
            if (of_settings) of_settings->sand = own.sand != nullptr, of_settings->water = own.water != nullptr;
            return of_settings;
        };
        if (auto status = within_limits(asked, account); !status) return report(status);
        auto level = parse_level(own.settings_json, no_files, engine);
        if (!level) return report(level.status());
        const auto& grid = level->settings.grid;
        if (own.nx != grid.nx || own.ny != grid.ny) {
            return bad_argument("wadi_create_world_from_arrays: arrays of " + std::to_string(own.nx) + " x " +
                                std::to_string(own.ny) + " cells, but the settings' grid is " + std::to_string(grid.nx) + " x " +
                                std::to_string(grid.ny));
        }
        const auto cells = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
        const auto copy = [&](std::vector<float>& to, const float* from) {
            if (from != nullptr) to.assign(from, from + cells);
        };
        copy(level->fields.terrain, own.terrain);
        copy(level->fields.sand, own.sand);
        copy(level->fields.water, own.water);
        copy(level->fields.velocity_x, own.velocity_x);
        copy(level->fields.velocity_y, own.velocity_y);
        copy(level->settings.roughness, own.roughness);
        copy(level->settings.rain_map, own.rain_map);
        level->warnings = level_warnings(level->settings, level->fields);
        return host(std::move(level), asked, world);
    });
}

wadi_result wadi_destroy_world(wadi_world_id world) {
    return guarded(__func__, [&] {
        const Entry entry = plugin::worlds().remove(world);
        return entry == Entry::entered ? report(ok_status()) : refused("wadi_destroy_world", entry);
    });
}

} // extern "C"
