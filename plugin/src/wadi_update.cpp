// Stepping by host time.
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

extern "C" {

wadi_result wadi_world_set_update_settings(wadi_world_id id, const wadi_update_settings* settings) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (auto status = understood("wadi_world_set_update_settings: settings", settings); !status) return report(status);
        const auto own = taken(settings, wadi_default_update_settings());
        if (own.spread != 0 && own.spread != 1)
            return bad_argument("wadi_world_set_update_settings: spread: " + std::to_string(own.spread) + " is not 0 or 1");
        if (own.interpolate_outputs != 0 && own.interpolate_outputs != 1)
            return bad_argument("wadi_world_set_update_settings: interpolate_outputs: " +
                                std::to_string(own.interpolate_outputs) + " is not 0 or 1");
        UpdateSettings chosen;
        chosen.max_steps_per_update = own.max_steps_per_update;
        chosen.max_steps_in_flight = own.max_steps_in_flight;
        chosen.spread = own.spread == 1;
        chosen.interpolate_outputs = own.interpolate_outputs == 1;
        return report(hosted.world->set_update_settings(chosen));
    });
}

wadi_result wadi_world_update(wadi_world_id id, uint64_t host_nanoseconds, wadi_frame* frame) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (auto status = understood("wadi_world_update: frame", frame); !status) return report(status);
        Frame done;
        if (auto status = hosted.world->update(host_nanoseconds, done); !status) return report(status);
        wadi_frame own = wadi_default_frame();
        own.steps = done.steps;
        own.total_steps = done.total_steps;
        own.time = done.time;
        own.interpolation = done.interpolation;
        const auto& outputs = hosted.world->outputs();
        own.published_step = outputs.published() ? outputs.published_step() : UINT64_MAX;
        own.dropped_nanoseconds = done.dropped;
        own.dropped_nanoseconds_total = done.dropped_total;
        own.limits_step = UINT64_MAX;
        if (const auto& limits = hosted.world->limits().newest()) {
            own.limits_step = limits->step;
            own.wet_faces = limits->water.wet_faces;
            own.clamped_water_faces = limits->water.clamped_faces;
            own.capped_water_faces = limits->water.capped_faces;
            own.sand_faces = limits->sand.wet_faces;
            own.clamped_sand_faces = limits->sand.clamped_faces;
            own.capped_sand_faces = limits->sand.capped_faces;
            own.high_columns = limits->high_columns;
            own.unlimited_dt = unlimited_dt(hosted.world->settings(), *limits);
        }
        give(frame, own);
        return report(ok_status());
    });
}

} // extern "C"
