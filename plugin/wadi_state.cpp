// Stepping, and reading the state.
#include "engine/settings/quanta.hpp"
#include "plugin/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

const char* wadi::plugin::plan_name(wadi_field field) {
    const FieldRow* row = find_host_field(static_cast<int>(field));
    return row != nullptr ? row->name.data() : nullptr;
}

extern "C" {

wadi_world_stats wadi_default_world_stats(void) { return sized<wadi_world_stats>(); }

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
        if (!right_size(stats)) return wrong_struct<wadi_world_stats>("wadi_world_get_stats", "stats");
        auto& world = *hosted.world;
        auto now = world.reader().stats();
        if (!now) return report(now.status());
        const double dx = world.settings().grid.dx, volume = now->quantum * dx * dx;
        const auto cubic_metres = [&](std::int64_t quanta) { return static_cast<double>(quanta) * volume; };
        const auto drift = [](std::int64_t held, std::int64_t initial, std::int64_t in, std::int64_t out) {
            return add_quanta(held, -add_quanta(add_quanta(initial, in), -out));
        };
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
        stats->sand_drift_quanta = drift(now->sand_quanta, now->sand_initial, ledger.sand_in, ledger.sand_out);
        stats->water_drift_quanta = drift(now->water_quanta, now->water_initial, ledger.water_in, ledger.water_out);
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
        stats->tiles = now->tiles;
        stats->active_tiles = now->active_tiles;
        stats->hash = now->hash;
        return report(ok_status());
    });
}

} // extern "C"
