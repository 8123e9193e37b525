// What a world is and what its stages cost; the tables of the library.
#include "engine/reads/describe_tables.hpp"
#include "plugin/src/abi.hpp"
#include <cstdio>

using namespace wadi;
using namespace wadi::plugin;

extern "C" {

uint32_t wadi_get_abi_version(void) { return WADI_ABI_VERSION; }

static_assert(WADI_VERSION == WADI_PROJECT_VERSION, "wadi.h and CMakeLists.txt say the same");

uint32_t wadi_get_version(void) { return WADI_VERSION; }

const char* wadi_get_last_error(void) { return last_error(); }

wadi_result wadi_world_get_info(wadi_world_id id, wadi_world_info* info) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (auto status = understood("wadi_world_get_info: info", info); !status) return report(status);
        const auto& world = *hosted.world;
        const auto& capabilities = world.device().capabilities();
        wadi_world_info own = wadi_default_world_info();
        copy_text(own.name, hosted.name);
        own.nx = world.settings().grid.nx;
        own.ny = world.settings().grid.ny;
        own.dx = world.settings().grid.dx;
        own.dt = world.settings().dt;
        own.substeps = world.plan().substeps;
        own.duration = hosted.duration;
        own.passes_per_water_step = static_cast<uint32_t>(world.plan().water_dispatches());
        own.passes_per_sand_substep = static_cast<uint32_t>(world.plan().substep_passes.size());
        own.bytes_per_cell = world.plan().bytes_per_cell();
        own.device_bytes = world.state().device().bytes();
        copy_text(own.backend, capabilities.backend);
        copy_text(own.device_name, capabilities.name + " (" + capabilities.driver + ")");
        own.exact_float = capabilities.exact_float ? 1 : 0;
        own.warning_count = static_cast<uint32_t>(hosted.warnings.size());
        own.source_count = hosted.world->settings().sources.size();
        own.origin_x = hosted.origin[0];
        own.origin_y = hosted.origin[1];
        give(info, own);
        return report(ok_status());
    });
}

const char* wadi_world_get_warning(wadi_world_id id, uint32_t n) {
    const char* warning = nullptr;
    with_world(__func__, id, [&](HostedWorld& hosted) {
        if (n >= hosted.warnings.size())
            return bad_argument("wadi_world_get_warning: n is " + std::to_string(n) + " of " +
                                std::to_string(hosted.warnings.size()));
        warning = hosted.warnings[n].c_str();
        return report(ok_status());
    });
    return warning;
}

size_t wadi_world_describe_plan(wadi_world_id id, char* text, size_t size) {
    size_t length = 0;
    with_world(__func__, id, [&](HostedWorld& hosted) {
        const std::string plan = describe_plan(hosted.world->state());
        length = plan.size();
        if (text != nullptr && size > 0) std::snprintf(text, size, "%s", plan.c_str());
        return report(ok_status());
    });
    return length;
}

size_t wadi_describe_table(const char* table, char* text, size_t size) {
    size_t length = 0;
    guarded(__func__, [&] {
        if (table == nullptr) return bad_argument("wadi_describe_table: table is NULL");
        const auto found = describe_table(table);
        if (!found) return report(error(found.status().code, "wadi_describe_table: " + found.status().message));
        length = found->size();
        if (text != nullptr && size > 0) std::snprintf(text, size, "%s", found->c_str());
        return report(ok_status());
    });
    return length;
}

wadi_result wadi_world_set_profiling(wadi_world_id id, int32_t on) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->stepper().set_profiling(on != 0)); });
}

wadi_result wadi_world_set_checking(wadi_world_id id, int32_t on) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        hosted.world->checking().set(on != 0);
        return report(ok_status());
    });
}

wadi_result wadi_world_get_stage_timings(wadi_world_id id, wadi_stage_timing* timings, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_stage_timings: count is NULL");
        auto times = hosted.world->stepper().stage_times();
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
