// What snapshots and command logs cost; levels: wadi_create.cpp.
#include "plugin/src/cost.hpp"

using namespace wadi;
using namespace wadi::plugin;

namespace wadi::plugin {

wadi_result give_cost(const char* function, const Result<Cost>& cost, wadi_cost* to) {
    if (auto status = understood(std::string(function) + ": cost", to); !status) return report(status);
    if (!cost) return report(named(function, cost.status()));
    wadi_cost given = wadi_default_cost();
    given.cells = cost->cells;
    given.file_bytes = cost->file_bytes;
    given.map_values = cost->map_values;
    given.work = cost->work;
    given.host_bytes = cost->host_bytes;
    given.device_bytes = cost->device_bytes;
    given.steps = cost->steps;
    given.edits_per_step = cost->edits_per_step;
    given.commands_per_step = cost->commands_per_step;
    give(to, given);
    return report(ok_status());
}

Result<Cost> to_cost(const std::string& what, const wadi_cost* from) {
    if (auto status = understood(what, from); !status) return status;
    const wadi_cost own = taken(from, wadi_default_cost());
    return Cost{own.cells, own.file_bytes,     own.map_values,       own.work, own.host_bytes, own.device_bytes,
                own.steps, own.edits_per_step, own.commands_per_step};
}

} // namespace wadi::plugin

extern "C" {

wadi_result wadi_world_get_snapshot_cost(wadi_world_id id, const void* data, size_t size, wadi_cost* cost) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (data == nullptr || cost == nullptr) return bad_argument("wadi_world_get_snapshot_cost: data or cost is NULL");
        return give_cost("wadi_world_get_snapshot_cost",
                         hosted.world->snapshots().cost({static_cast<const std::byte*>(data), size}), cost);
    });
}

wadi_result wadi_world_get_commands_cost(wadi_world_id id, const void* data, size_t size, wadi_cost* cost) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (data == nullptr || cost == nullptr) return bad_argument("wadi_world_get_commands_cost: data or cost is NULL");
        return give_cost("wadi_world_get_commands_cost",
                         hosted.world->commands().cost({static_cast<const std::byte*>(data), size}), cost);
    });
}

} // extern "C"
