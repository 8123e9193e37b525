// Worlds behind generation-checked ids.
#pragma once
#include "engine/level/level.hpp"
#include "engine/world.hpp"
#include "plugin/include/wadi/wadi.h"
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wadi::plugin {

/// A world and what its level said.
struct HostedWorld {
    std::unique_ptr<World> world;
    std::string name;
    double duration = 0;
    std::vector<std::string> warnings;
    std::array<double, 2> origin{};                    // Level::origin
    int threads = 0;                                   // of the host's work in its calls, ThreadLimit
    std::optional<Cost> most;                          // wadi_device_options.most
    std::vector<Edit> edits;                           // of the last wadi_world_edit: its room is used again
    std::array<std::vector<wadi_sample>, 3> samples{}; // of the last wadi_world_get_source: rate, discharge, level
    bool spoiled = false; // the host's memory ran out in the middle of a call: what that left undone is not known
};

enum class Entry { entered, unknown, busy };

class WorldTable {
  public:
    /// `inherited`: that of the parent process, or null.
    WorldTable(std::pair<long, long> process, WorldTable* inherited) : process_(process), inherited_(inherited) {}
    /// Whose worlds these are.
    std::pair<long, long> process() const { return process_; }
    wadi_world_id add(HostedWorld hosted);
    /// Only one caller is inside a world at a time; one that entered must leave.
    Entry enter(wadi_world_id id, HostedWorld*& hosted);
    void leave(wadi_world_id id);
    Entry remove(wadi_world_id id);

  private:
    struct Slot {
        std::uint32_t generation = 0;
        bool busy = false; // a call is inside
        std::unique_ptr<HostedWorld> hosted;
    };
    /// Null when the id is not of a living world. The mutex must be held.
    Slot* find(wadi_world_id id);

    const std::pair<long, long> process_;
    [[maybe_unused]] WorldTable* const inherited_; // kept for tools that look for lost memory
    std::mutex mutex_;                             // held to look worlds up, not while one is used
    std::vector<Slot> slots_;
};

/// Inside a world from construction to destruction, if it could be entered.
class EnteredWorld {
  public:
    EnteredWorld(WorldTable& table, wadi_world_id id) : table_(table), id_(id), entry_(table.enter(id, hosted_)) {}
    ~EnteredWorld() {
        if (hosted_ != nullptr) table_.leave(id_);
    }
    EnteredWorld(const EnteredWorld&) = delete;
    EnteredWorld& operator=(const EnteredWorld&) = delete;
    HostedWorld* hosted() const { return hosted_; }
    Entry entry() const { return entry_; }

  private:
    WorldTable& table_;
    const wadi_world_id id_;
    HostedWorld* hosted_ = nullptr;
    const Entry entry_;
};

/// Of this process.
WorldTable& worlds();

} // namespace wadi::plugin
