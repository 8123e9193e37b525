// What active tiles mean for the step that comes: whether it runs over them, and whether anything is left to run.
#pragma once
#include "engine/step/run/active_count.hpp"
#include "engine/step/run/tile_choice.hpp"

namespace wadi {

class TileUse {
  public:
    explicit TileUse(WorldState& state) : state_(state) {}
    ActiveCount& count() { return count_; }

    /// In a world that chooses whether steps run over active tiles: goes to the better way where the buffers allow it.
    void choose();
    /// Whether nothing is left to run while nothing wakes a tile.
    bool asleep() { return state_.plan().active_tiles && count_.asleep(); }
    /// So many steps were submitted, `woken` with tiles that their inputs wake.
    void submitted(int steps, compute::Ticket ticket, bool woken);
    /// Another plan, or another state: the choice begins anew.
    void restart() { choice_.restart(); }

  private:
    WorldState& state_;
    ActiveCount count_{state_};
    TileChoice choice_;
};

} // namespace wadi
