// Edits of a running world: brushes, stamps and bodies that push. They wait for their step and run on the device ahead of it.
#pragma once
#include "engine/edits/turn_of_player.hpp"
#include "engine/settings/rules/edit_checks.hpp"
#include "engine/step/run/state_program.hpp"
#include "engine/step/run/stepper.hpp"
#include <map>
#include <span>

namespace wadi {

static_assert(int(EditKind::brush) == EDIT_BRUSH && int(EditKind::stamp) == EDIT_STAMP && int(EditKind::push) == EDIT_PUSH);
static_assert(int(EditLayer::terrain) == LAYER_TERRAIN && int(EditLayer::sand) == LAYER_SAND &&
              int(EditLayer::water) == LAYER_WATER);

class Edits {
  public:
    Edits(WorldState& state, Stepper& stepper);
    Edits(const Edits&) = delete;
    Edits& operator=(const Edits&) = delete;

    /// The step that "the next one" means now.
    std::uint64_t next_step() const { return state_.steps + (stepper_.parts_done() > 0 ? 1 : 0); }
    /// ok, or bad_argument that names `function`, the edit and its field.
    Status check(const char* function, std::span<const Edit> edits, std::span<const Stamp> stamps) const;
    /// Queues a checked edit, with its step set, behind those of the same step and player.
    void schedule(const Edit& edit);
    /// The world went to another step: drops what waits; the level's own edits are due again from there on.
    void forget();

    /// Registers an image; its number counts up from 1. Allocates and may wait. Errors: bad_argument, out_of_memory.
    Result<std::uint32_t> create_stamp(int nx, int ny, std::span<const float> values);
    const std::vector<Stamp>& stamps() const { return stamps_; }

    /// Submits what is due ahead of the next step, MAX_EDITS at a time, the level's own edits first; promotes the world where a
    /// material is new.
    Status before_step();
    /// Of the next `most` steps, how many have no edit ahead of them but those ahead of the first.
    std::uint64_t undisturbed(std::uint64_t most) const;

  private:
    Status promote();
    Status submit();
    Status make_room(std::uint64_t pages);
    Status upload(const Stamp& stamp);

    WorldState& state_;
    Stepper& stepper_;
    std::multimap<TurnOfPlayer, Edit> waiting_; // equal ones in the order of the calls
    std::vector<Edit> due_;                     // taken for the next step and not submitted yet
    std::uint64_t scripted_from_ = 0;           // the first step for which the level's own edits were not taken
    std::vector<Stamp> stamps_;
    compute::Buffer images_;
    std::uint64_t pages_ = 0, pages_used_ = 0;
    StateProgram program_;
    Material recorded_with_; // what program_ knows of sand in balance
};

/// Writes an edit as apply_edits reads it. False where it misses the grid. `stamps` by their number less 1.
bool pack_edit(const Edit& edit, std::span<const Stamp> stamps, const Grid& grid, EditInput& to);

} // namespace wadi
