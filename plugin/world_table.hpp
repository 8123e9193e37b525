// Worlds behind generation-checked ids.
#pragma once
#include "engine/level/level.hpp"
#include "engine/world.hpp"
#include "plugin/include/wadi/wadi.h"
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace wadi::plugin {

/// A world and what its level said.
struct HostedWorld {
    std::unique_ptr<World> world;
    std::string name;
    double duration = 0;
    std::vector<std::string> warnings;
};

class WorldTable {
  public:
    wadi_world_id add(HostedWorld hosted);
    /// Null when the id is not of a living world. The pointer stays valid until that id is removed.
    HostedWorld* find(wadi_world_id id);
    bool remove(wadi_world_id id);

  private:
    struct Slot {
        std::uint32_t generation = 0;
        std::unique_ptr<HostedWorld> hosted;
    };
    std::mutex mutex_;
    std::vector<Slot> slots_;
};

WorldTable& worlds();

} // namespace wadi::plugin
