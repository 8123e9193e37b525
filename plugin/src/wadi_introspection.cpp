// What a world holds, which effects it runs and why, and what broke it.
#include "plugin/src/abi.hpp"

using namespace wadi;
using namespace wadi::plugin;

extern "C" {

wadi_result wadi_world_get_memory(wadi_world_id id, wadi_memory_item* items, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_memory: count is NULL");
        const auto& memory = hosted.world->state().device().memory();
        const uint32_t capacity = items != nullptr ? *count : 0;
        *count = static_cast<uint32_t>(memory.size());
        for (uint32_t n = 0; n < std::min(capacity, *count); ++n) {
            copy_text(items[n].label, memory[n].label);
            items[n].bytes = memory[n].bytes;
        }
        return report(ok_status());
    });
}

wadi_result wadi_world_get_effects(wadi_world_id id, wadi_effect_info* effects, uint32_t* count) {
    return with_world(__func__, id, [&](HostedWorld& hosted) {
        if (count == nullptr) return bad_argument("wadi_world_get_effects: count is NULL");
        const auto& choice = hosted.world->state().effects();
        const auto table = effect_table();
        const uint32_t capacity = effects != nullptr ? *count : 0;
        *count = static_cast<uint32_t>(table.size());
        for (uint32_t n = 0; n < std::min(capacity, *count); ++n) {
            copy_text(effects[n].name, table[n].name);
            copy_text(effects[n].why, choice.reasons[n]);
            effects[n].on = (choice.mask & table[n].bit) != 0 ? 1 : 0;
        }
        return report(ok_status());
    });
}

wadi_result wadi_world_get_error(wadi_world_id id) {
    return with_world(__func__, id, [&](HostedWorld& hosted) { return report(hosted.world->state().lost()); });
}

} // extern "C"
