// Sources of a running world that a host moves, changes or adds. They wait for their step and act ahead of it.
#pragma once
#include "engine/edits/turn_of_player.hpp"
#include "engine/step/run/stepper.hpp"
#include <map>

namespace wadi {

struct SourceChange {
    std::uint64_t step = 0;
    std::uint32_t player = 0; // as Edit::player
    std::uint32_t index = 0;  // of the source that becomes another; those below that are not there come along, without a rate
    Source source;
};

class SourceChanges {
  public:
    SourceChanges(WorldState& state, Stepper& stepper) : state_(state), stepper_(stepper) {}

    /// ok, or bad_argument that begins with `function`: a number of the source, or an effect that the level forces off.
    Status check(const std::string& function, const SourceChange& change) const;
    /// Queues a checked change, with its step set, behind those of the same step and player.
    void schedule(SourceChange change);
    /// Drops what waits.
    void forget() { waiting_.clear(); }

    /// Makes what is due ahead of the next step; what fails stays due. A source in another place waits for the device; one that
    /// is the first to bring its material promotes the world.
    Status before_step();
    /// Of the next `most` steps, how many have no change ahead of them but those ahead of the first.
    std::uint64_t undisturbed(std::uint64_t most) const;

  private:
    WorldState& state_;
    Stepper& stepper_;
    std::multimap<TurnOfPlayer, SourceChange> waiting_; // equal ones in the order of the calls
};

} // namespace wadi
