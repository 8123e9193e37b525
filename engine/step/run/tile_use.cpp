#include "engine/step/run/tile_use.hpp"
#include <algorithm>

namespace wadi {

void TileUse::choose() {
    if (!state_.chooses_tiles() || state_.fields().turn() != 0) return;
    const auto [ticket, count] = count_.newest();
    const double share = static_cast<double>(count) / static_cast<double>(state_.tiles().count());
    state_.use_tiles(choice_.wants_tiles(state_.steps, {ticket, share}));
}

void TileUse::submitted(int steps, compute::Ticket ticket, bool woken) {
    const bool tiles = state_.plan().active_tiles;
    if (tiles) {
        for (int n = 0; n < std::min(steps, 2); ++n) count_.submitted((state_.fields().turn() + n) % 2, ticket, woken);
    }
    choice_.submitted(static_cast<std::uint64_t>(steps), tiles, ticket);
    state_.tiles().submitted();
}

} // namespace wadi
