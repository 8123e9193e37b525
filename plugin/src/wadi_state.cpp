// Stepping, and reading the state.
#include "engine/settings/data/quanta.hpp"
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

const char* wadi::plugin::plan_name(wadi_field field) {
    const FieldRow* row = find_host_field(static_cast<int>(field));
    return row != nullptr ? row->name.data() : nullptr;
}

extern "C" {

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
    const FieldRow* row = find_host_field(static_cast<int>(field));
    return row != nullptr ? row->symbol : nullptr;
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
        return report(hosted.world->reader().read(plan_name(field), {values, cells}));
    });
}

wadi_result wadi_world_get_stats(wadi_world_id id, wadi_world_stats* stats) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (auto status = understood("wadi_world_get_stats: stats", stats); !status) return report(status);
        auto& world = *hosted.world;
        auto now = world.reader().stats();
        if (!now) return report(now.status());
        const double dx = world.settings().grid.dx, volume = now->quantum * dx * dx;
        const auto cubic_metres = [&](std::int64_t quanta) { return static_cast<double>(quanta) * volume; };
        const auto drift = [](std::int64_t held, std::int64_t initial, std::int64_t in, std::int64_t out) {
            return add_quanta(held, -add_quanta(add_quanta(initial, in), -out));
        };
        const auto& ledger = now->ledger;
        wadi_world_stats own = wadi_default_world_stats();
        own.time = world.time();
        own.steps = world.steps();
        own.sand_volume = cubic_metres(now->sand_quanta);
        own.water_volume = cubic_metres(now->water_quanta);
        own.sand_initial = cubic_metres(now->sand_initial);
        own.water_initial = cubic_metres(now->water_initial);
        own.sand_in = cubic_metres(ledger.sand_in);
        own.sand_out = cubic_metres(ledger.sand_out);
        own.water_in = cubic_metres(ledger.water_in);
        own.water_out = cubic_metres(ledger.water_out);
        own.refused = cubic_metres(ledger.refused);
        own.sand_drift_quanta = drift(now->sand_quanta, now->sand_initial, ledger.sand_in, ledger.sand_out);
        own.water_drift_quanta = drift(now->water_quanta, now->water_initial, ledger.water_in, ledger.water_out);
        own.quantum = now->quantum;
        own.largest_sand_depth = now->largest_sand;
        own.largest_total_water_depth = now->largest_water;
        own.largest_water_speed = now->largest_water_speed;
        own.largest_sand_speed = now->largest_sand_speed;
        own.smallest_depth = now->smallest_height;
        own.not_finite = now->not_finite;
        const LayerLimits &water = now->limits.water, &sand = now->limits.sand;
        own.clamped_faces = water.clamped_faces + sand.clamped_faces;
        own.capped_faces = water.capped_faces + sand.capped_faces;
        own.limited_cells = water.limited_cells + sand.limited_cells;
        own.wet_faces = water.wet_faces;
        own.clamped_water_faces = water.clamped_faces;
        own.capped_water_faces = water.capped_faces;
        own.limited_water_cells = water.limited_cells;
        own.sand_faces = sand.wet_faces;
        own.unlimited_dt = unlimited_dt(world.settings(), now->limits);
        own.tiles = now->tiles;
        own.active_tiles = now->active_tiles;
        own.hash = now->hash;
        own.high_columns = now->limits.high_columns;
        give(stats, own);
        return report(ok_status());
    });
}

} // extern "C"
