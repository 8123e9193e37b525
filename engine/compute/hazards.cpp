#include "engine/compute/hazards.hpp"
#include <algorithm>
#include <map>
#include <set>

namespace wadi::compute {

namespace {

struct Touched {
    bool read = false, written = false;
};

} // namespace

std::vector<BufferUse> buffer_uses(const Op& op) {
    std::vector<BufferUse> uses;
    if (const auto* dispatch = std::get_if<Dispatch>(&op)) {
        for (const auto& binding : stage_table()[static_cast<std::size_t>(dispatch->stage)].bindings) {
            if (!binding.exists(dispatch->effects)) continue;
            uses.push_back({dispatch->slots[static_cast<std::size_t>(binding.slot)], binding.access != Access::out,
                            binding.access != Access::in});
        }
        const auto& tiles = dispatch->tiles;
        if (tiles.on()) {
            uses.push_back({tiles.activity, true, true});
            for (const auto list : {tiles.flags, tiles.counts, tiles.list}) uses.push_back({list, true, false});
            const auto extent = stage_table()[static_cast<std::size_t>(dispatch->stage)].extent;
            uses.push_back({tiles.dispatch, true, false, extent != Extent::rim});
        }
    } else if (const auto* copy = std::get_if<Copy>(&op)) {
        uses.push_back({copy->from, true, false});
        uses.push_back({copy->to, false, true});
    } else if (const auto* fill = std::get_if<Fill>(&op)) {
        uses.push_back({fill->buffer, false, true});
    }
    return uses;
}

std::vector<Barrier> plan_barriers(const std::vector<Op>& ops) {
    std::vector<Barrier> barriers(ops.size());
    std::map<std::uint32_t, Touched> since_barrier;
    std::set<std::uint32_t> groups_seen; // and not written since
    for (std::size_t n = 0; n < ops.size(); ++n) {
        const auto uses = buffer_uses(ops[n]);
        const bool conflict = std::any_of(uses.begin(), uses.end(), [&](const BufferUse& use) {
            const auto found = since_barrier.find(use.buffer.id);
            return found != since_barrier.end() && (found->second.written || (use.writes && found->second.read));
        });
        if (conflict) {
            barriers[n].memory = true;
            since_barrier.clear();
        }
        for (const auto& use : uses) {
            auto& touched = since_barrier[use.buffer.id];
            touched.read |= use.reads;
            touched.written |= use.writes;
            if (use.groups) barriers[n].groups |= groups_seen.insert(use.buffer.id).second;
            if (use.writes) groups_seen.erase(use.buffer.id);
        }
    }
    return barriers;
}

std::vector<std::vector<int>> plan_dependencies(const std::vector<Op>& ops) {
    struct History {
        int writer = -1;
        std::vector<int> readers;
    };
    std::map<std::uint32_t, History> history;
    std::vector<std::vector<int>> edges(ops.size());
    for (std::size_t n = 0; n < ops.size(); ++n) {
        const auto uses = buffer_uses(ops[n]);
        auto& waits = edges[n];
        for (const auto& use : uses) {
            const auto& past = history[use.buffer.id];
            if (use.writes && !past.readers.empty()) {
                waits.insert(waits.end(), past.readers.begin(), past.readers.end());
            } else if (past.writer >= 0) {
                waits.push_back(past.writer);
            }
        }
        std::sort(waits.begin(), waits.end());
        waits.erase(std::unique(waits.begin(), waits.end()), waits.end());
        for (const auto& use : uses) {
            auto& past = history[use.buffer.id];
            if (use.writes) {
                past.writer = static_cast<int>(n);
                past.readers.clear();
            } else {
                past.readers.push_back(static_cast<int>(n));
            }
        }
    }
    return edges;
}

} // namespace wadi::compute
