#include "plugin/world_table.hpp"

namespace wadi::plugin {

wadi_world_id WorldTable::add(HostedWorld hosted) {
    const std::lock_guard lock(mutex_);
    std::size_t n = 0;
    while (n < slots_.size() && slots_[n].hosted) ++n;
    if (n == slots_.size()) slots_.emplace_back();
    auto& slot = slots_[n];
    ++slot.generation;
    slot.hosted = std::make_unique<HostedWorld>(std::move(hosted));
    return {static_cast<std::uint32_t>(n + 1), slot.generation};
}

HostedWorld* WorldTable::find(wadi_world_id id) {
    const std::lock_guard lock(mutex_);
    if (id.index == 0 || id.index > slots_.size()) return nullptr;
    auto& slot = slots_[id.index - 1];
    return slot.generation == id.generation ? slot.hosted.get() : nullptr;
}

bool WorldTable::remove(wadi_world_id id) {
    std::unique_ptr<HostedWorld> gone;
    const std::lock_guard lock(mutex_);
    if (id.index == 0 || id.index > slots_.size() || slots_[id.index - 1].generation != id.generation) return false;
    gone = std::move(slots_[id.index - 1].hosted);
    return gone != nullptr;
}

WorldTable& worlds() {
    static WorldTable table;
    return table;
}

} // namespace wadi::plugin
