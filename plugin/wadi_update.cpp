// Stepping by host time.
#include "plugin/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

extern "C" {

wadi_update_settings wadi_default_update_settings(void) {
    const UpdateSettings defaults;
    auto settings = sized<wadi_update_settings>();
    settings.max_steps_per_update = defaults.max_steps_per_update;
    settings.max_steps_in_flight = defaults.max_steps_in_flight;
    return settings;
}

wadi_result wadi_world_set_update_settings(wadi_world_id id, const wadi_update_settings* settings) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (!right_size(settings)) return wrong_struct<wadi_update_settings>("wadi_world_set_update_settings", "settings");
        if (settings->spread != 0 && settings->spread != 1)
            return bad_argument("wadi_world_set_update_settings: spread: " + std::to_string(settings->spread) + " is not 0 or 1");
        if (settings->interpolate_outputs != 0 && settings->interpolate_outputs != 1)
            return bad_argument("wadi_world_set_update_settings: interpolate_outputs: " +
                                std::to_string(settings->interpolate_outputs) + " is not 0 or 1");
        UpdateSettings chosen;
        chosen.max_steps_per_update = settings->max_steps_per_update;
        chosen.max_steps_in_flight = settings->max_steps_in_flight;
        chosen.spread = settings->spread == 1;
        chosen.interpolate_outputs = settings->interpolate_outputs == 1;
        return report(hosted.world->set_update_settings(chosen));
    });
}

wadi_frame wadi_default_frame(void) { return sized<wadi_frame>(); }

wadi_result wadi_world_update(wadi_world_id id, uint64_t host_nanoseconds, wadi_frame* frame) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (!right_size(frame)) return wrong_struct<wadi_frame>("wadi_world_update", "frame");
        Frame done;
        if (auto status = hosted.world->update(host_nanoseconds, done); !status) return report(status);
        *frame = sized<wadi_frame>();
        frame->steps = done.steps;
        frame->total_steps = done.total_steps;
        frame->time = done.time;
        frame->interpolation = done.interpolation;
        const auto& outputs = hosted.world->outputs();
        frame->published_step = outputs.published() ? outputs.published_step() : UINT64_MAX;
        frame->dropped_nanoseconds = done.dropped;
        frame->dropped_nanoseconds_total = done.dropped_total;
        return report(ok_status());
    });
}

} // extern "C"
