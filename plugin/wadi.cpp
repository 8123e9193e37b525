// The C ABI: checks handles and sizes, forwards to the engine, turns Status into codes. No logic of its own.
#include "plugin/include/wadi/wadi.h"
#include "engine/level/level.hpp"
#include "engine/world.hpp"
#include "plugin/world_table.hpp"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <type_traits>

namespace {

using namespace wadi;
using plugin::HostedWorld;

thread_local std::string last_error;

wadi_result report(const Status& status) {
    last_error = status ? std::string() : status.message;
    switch (status.code) {
    case Code::ok:
        return WADI_OK;
    case Code::bad_argument:
        return WADI_ERROR_BAD_ARGUMENT;
    case Code::not_found:
        return WADI_ERROR_NOT_FOUND;
    case Code::bad_file:
        return WADI_ERROR_BAD_FILE;
    case Code::not_supported:
        return WADI_ERROR_NOT_SUPPORTED;
    case Code::out_of_memory:
        return WADI_ERROR_OUT_OF_MEMORY;
    case Code::device_lost:
        return WADI_ERROR_DEVICE_LOST;
    case Code::internal:
        return WADI_ERROR_INTERNAL;
    }
    return WADI_ERROR_INTERNAL;
}

wadi_result bad_argument(const std::string& message) { return report(error(Code::bad_argument, message)); }

// No exception may reach a host: what the standard library throws becomes an error.
template <class Call> wadi_result guarded(const char* function, Call call) {
    try {
        return call();
    } catch (const std::bad_alloc&) {
        return report(error(Code::out_of_memory, std::string(function) + ": out of memory"));
    } catch (const std::exception& e) {
        return report(error(Code::internal, std::string(function) + ": " + e.what()));
    }
}

template <class Call> wadi_result with_world(const char* function, wadi_world_id id, Call call) {
    return guarded(function, [&] {
        HostedWorld* hosted = plugin::worlds().find(id);
        if (hosted == nullptr) return bad_argument(std::string(function) + ": the world id is null or its world was destroyed");
        return call(*hosted);
    });
}

// A struct from a caller built against another version has another size: refuse rather than read past its end.
template <class Struct> bool right_size(const Struct* s) { return s != nullptr && s->struct_size == sizeof(Struct); }

template <class Struct> wadi_result wrong_struct(const char* function, const char* name) {
    return bad_argument(std::string(function) + ": " + name + " is NULL or its struct_size is not " +
                        std::to_string(sizeof(Struct)) + "; use wadi_default_...()");
}

template <std::size_t N> void copy_text(char (&to)[N], const std::string& text) {
    const std::size_t n = std::min(text.size(), N - 1);
    std::memcpy(to, text.data(), n);
    std::memset(to + n, 0, N - n);
}

Result<std::unique_ptr<compute::Device>> open(const wadi_device_options* options) {
    const auto defaults = wadi_default_device_options();
    if (options == nullptr) options = &defaults;
    compute::DeviceOptions o;
    o.threads = options->threads;
    o.validate = options->validate != 0;
    if (options->log != nullptr) {
        o.log = [log = options->log, user = options->log_user](int level, const std::string& message) {
            log(user, level, message.c_str());
        };
    }
    return compute::open_device(options->backend != nullptr ? options->backend : "auto", options->device, o);
}

LevelOverrides to_overrides(const wadi_level_overrides* o) {
    LevelOverrides overrides;
    if (o == nullptr) return overrides;
    if (o->nx != 0 || o->ny != 0) overrides.size = {o->nx, o->ny};
    if (o->dt != 0) overrides.dt = o->dt;
    if (o->method != nullptr) overrides.method = o->method;
    return overrides;
}

wadi_result host(Result<Level> level, const wadi_device_options* options, wadi_world_id* id) {
    if (!level) return report(level.status());
    auto device = open(options);
    if (!device) return report(device.status());
    auto world = World::create(level->settings, level->fields, std::move(*device));
    if (!world) return report(world.status());
    *id = plugin::worlds().add({std::move(*world), level->name, level->duration, level->warnings});
    return report(ok_status());
}

struct FieldName {
    const char* short_name;
    const char* plan_name;
};
constexpr FieldName field_names[WADI_FIELD_COUNT] = {
    {"H", "terrain"},           {"hs", "sand_height"},       {"W", "water_height"},
    {"hw", "water_depth"},      {"surface", "free_surface"}, {"phi", "surface_saturation"},
    {"uw", "water_velocity_x"}, {"vw", "water_velocity_y"},  {"us", "sand_velocity_x"},
    {"vs", "sand_velocity_y"},  {"um", "mixed_velocity_x"},  {"vm", "mixed_velocity_y"},
    {"Vxx", "stretch_xx"},      {"Vxy", "stretch_xy"},       {"Vyy", "stretch_yy"},
};

template <class Struct> Struct sized() {
    Struct s;
    std::memset(&s, 0, sizeof s);
    s.struct_size = sizeof s;
    return s;
}

} // namespace

extern "C" {

uint32_t wadi_get_abi_version(void) { return WADI_ABI_VERSION; }

const char* wadi_get_last_error(void) { return last_error.c_str(); }

wadi_device_options wadi_default_device_options(void) {
    auto o = sized<wadi_device_options>();
    o.backend = "auto";
    o.device = -1;
    return o;
}

wadi_level_overrides wadi_default_level_overrides(void) { return sized<wadi_level_overrides>(); }
wadi_world_arrays wadi_default_world_arrays(void) { return sized<wadi_world_arrays>(); }
wadi_world_info wadi_default_world_info(void) { return sized<wadi_world_info>(); }
wadi_world_stats wadi_default_world_stats(void) { return sized<wadi_world_stats>(); }

wadi_result wadi_list_devices(wadi_device_info* infos, uint32_t* count, char* notes, size_t notes_size) {
    return guarded(__func__, [&] {
        if (count == nullptr) return bad_argument("wadi_list_devices: count is NULL");
        const uint32_t capacity = infos != nullptr ? *count : 0;
        uint32_t found = 0;
        std::string why_none;
        for (const auto& backend : compute::backends()) {
            std::string why;
            const auto devices = backend.enumerate(why);
            if (devices.empty()) why_none += std::string(backend.name) + ": " + why + "\n";
            for (const auto& device : devices) {
                if (found < capacity) {
                    auto& info = infos[found];
                    info = sized<wadi_device_info>();
                    copy_text(info.backend, device.backend);
                    copy_text(info.name, device.name);
                    info.index = device.index;
                    info.is_software =
                        device.kind == compute::DeviceKind::cpu || device.kind == compute::DeviceKind::software_gpu;
                    info.memory_bytes = device.memory_bytes;
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
        if (overrides != nullptr && !right_size(overrides))
            return wrong_struct<wadi_level_overrides>("wadi_create_world_from_level", "overrides");
        if (options != nullptr && !right_size(options))
            return wrong_struct<wadi_device_options>("wadi_create_world_from_level", "options");
        const bool json = std::string(path).ends_with(".json");
        return host(json ? load_level(path, to_overrides(overrides)) : level_from_terrain(path, to_overrides(overrides)), options,
                    world);
    });
}

wadi_result wadi_create_world_from_arrays(const wadi_world_arrays* arrays, const wadi_device_options* options,
                                          wadi_world_id* world) {
    return guarded(__func__, [&] {
        if (!right_size(arrays)) return wrong_struct<wadi_world_arrays>("wadi_create_world_from_arrays", "arrays");
        if (options != nullptr && !right_size(options))
            return wrong_struct<wadi_device_options>("wadi_create_world_from_arrays", "options");
        if (arrays->settings_json == nullptr || world == nullptr)
            return bad_argument("wadi_create_world_from_arrays: settings_json or world is NULL");
        auto level = parse_level(arrays->settings_json, "", {});
        if (!level) return report(level.status());
        const auto& grid = level->settings.grid;
        if (arrays->nx != grid.nx || arrays->ny != grid.ny) {
            return bad_argument("wadi_create_world_from_arrays: arrays of " + std::to_string(arrays->nx) + " x " +
                                std::to_string(arrays->ny) + " cells, but the settings' grid is " + std::to_string(grid.nx) +
                                " x " + std::to_string(grid.ny));
        }
        const auto cells = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
        const auto copy = [&](std::vector<float>& to, const float* from) {
            if (from != nullptr) to.assign(from, from + cells);
        };
        copy(level->fields.terrain, arrays->terrain);
        copy(level->fields.sand, arrays->sand);
        copy(level->fields.water, arrays->water);
        copy(level->fields.velocity_x, arrays->velocity_x);
        copy(level->fields.velocity_y, arrays->velocity_y);
        level->warnings = level_warnings(level->settings, level->fields);
        return host(std::move(level), options, world);
    });
}

wadi_result wadi_destroy_world(wadi_world_id world) {
    return guarded(__func__, [&] {
        if (!plugin::worlds().remove(world))
            return bad_argument("wadi_destroy_world: the world id is null or its world was destroyed");
        return report(ok_status());
    });
}

wadi_result wadi_world_get_info(wadi_world_id id, wadi_world_info* info) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (!right_size(info)) return wrong_struct<wadi_world_info>("wadi_world_get_info", "info");
        const auto& world = *hosted.world;
        const auto& capabilities = world.device().capabilities();
        *info = sized<wadi_world_info>();
        copy_text(info->name, hosted.name);
        info->nx = world.settings().grid.nx;
        info->ny = world.settings().grid.ny;
        info->dx = world.settings().grid.dx;
        info->dt = world.settings().dt;
        info->substeps = world.plan().substeps;
        info->duration = hosted.duration;
        info->passes_per_water_step = static_cast<uint32_t>(world.plan().water_passes.size());
        info->passes_per_sand_substep = static_cast<uint32_t>(world.plan().substep_passes.size());
        info->bytes_per_cell = world.plan().bytes_per_cell();
        info->device_bytes = world.device_bytes();
        copy_text(info->backend, capabilities.backend);
        copy_text(info->device_name, capabilities.name + " (" + capabilities.driver + ")");
        info->exact_float = capabilities.exact_float ? 1 : 0;
        info->warning_count = static_cast<uint32_t>(hosted.warnings.size());
        return report(ok_status());
    });
}

const char* wadi_world_get_warning(wadi_world_id id, uint32_t n) {
    const auto* hosted = plugin::worlds().find(id);
    return hosted != nullptr && n < hosted->warnings.size() ? hosted->warnings[n].c_str() : nullptr;
}

size_t wadi_world_describe_plan(wadi_world_id id, char* text, size_t size) {
    size_t length = 0;
    with_world(__func__, id, [&](HostedWorld& hosted) {
        const std::string plan = hosted.world->describe_plan();
        length = plan.size();
        if (text != nullptr && size > 0) std::snprintf(text, size, "%s", plan.c_str());
        return report(ok_status());
    });
    return length;
}

wadi_result wadi_world_step(wadi_world_id id, uint32_t steps) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->step(steps)); });
}

wadi_result wadi_world_get_time(wadi_world_id id, double* seconds, uint64_t* steps) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (seconds != nullptr) *seconds = hosted.world->time();
        if (steps != nullptr) *steps = hosted.world->steps();
        return report(ok_status());
    });
}

const char* wadi_field_name(wadi_field field) {
    const int n = static_cast<int>(field);
    return n >= 0 && n < WADI_FIELD_COUNT ? field_names[n].short_name : nullptr;
}

wadi_result wadi_world_read_field(wadi_world_id id, wadi_field field, float* values, size_t count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (wadi_field_name(field) == nullptr)
            return bad_argument("wadi_world_read_field: no field " + std::to_string(static_cast<int>(field)));
        const auto& grid = hosted.world->settings().grid;
        const auto cells = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
        if (values == nullptr || count != cells) {
            return bad_argument("wadi_world_read_field: values is NULL or count is " + std::to_string(count) +
                                ", not nx * ny = " + std::to_string(cells));
        }
        return report(hosted.world->read(field_names[field].plan_name, {values, cells}));
    });
}

wadi_result wadi_world_get_stats(wadi_world_id id, wadi_world_stats* stats) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (!right_size(stats)) return wrong_struct<wadi_world_stats>("wadi_world_get_stats", "stats");
        auto& world = *hosted.world;
        auto now = world.stats();
        if (!now) return report(now.status());
        const double dx = world.settings().grid.dx, volume = now->quantum * dx * dx;
        const auto cubic_metres = [&](std::int64_t quanta) { return static_cast<double>(quanta) * volume; };
        const auto& ledger = now->ledger;
        *stats = sized<wadi_world_stats>();
        stats->time = world.time();
        stats->steps = world.steps();
        stats->sand_volume = cubic_metres(now->sand_quanta);
        stats->water_volume = cubic_metres(now->water_quanta);
        stats->sand_initial = cubic_metres(now->sand_initial);
        stats->water_initial = cubic_metres(now->water_initial);
        stats->sand_in = cubic_metres(ledger.sand_in);
        stats->sand_out = cubic_metres(ledger.sand_out);
        stats->water_in = cubic_metres(ledger.water_in);
        stats->water_out = cubic_metres(ledger.water_out);
        stats->refused = cubic_metres(ledger.refused);
        stats->sand_drift_quanta = now->sand_quanta - (now->sand_initial + ledger.sand_in - ledger.sand_out);
        stats->water_drift_quanta = now->water_quanta - (now->water_initial + ledger.water_in - ledger.water_out);
        stats->quantum = now->quantum;
        stats->largest_sand = now->largest_sand;
        stats->largest_water = now->largest_water;
        stats->largest_water_speed = now->largest_water_speed;
        stats->largest_sand_speed = now->largest_sand_speed;
        stats->smallest_height = now->smallest_height;
        stats->not_finite = now->not_finite;
        stats->clamped_faces = now->clamped_faces;
        stats->capped_faces = now->capped_faces;
        stats->limited_cells = now->limited_cells;
        stats->hash = now->hash;
        return report(ok_status());
    });
}

wadi_result wadi_world_set_profiling(wadi_world_id id, int32_t on) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->set_profiling(on != 0)); });
}

wadi_result wadi_world_get_stage_timings(wadi_world_id id, wadi_stage_timing* timings, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_stage_timings: count is NULL");
        auto times = hosted.world->stage_times();
        if (!times) return report(times.status());
        const uint32_t capacity = timings != nullptr ? *count : 0;
        *count = static_cast<uint32_t>(times->size());
        for (uint32_t n = 0; n < std::min(capacity, *count); ++n) {
            const auto& time = (*times)[n];
            copy_text(timings[n].name, time.stage);
            timings[n].milliseconds = time.milliseconds;
            timings[n].passes = static_cast<uint32_t>(time.passes);
        }
        return report(ok_status());
    });
}

} // extern "C"
