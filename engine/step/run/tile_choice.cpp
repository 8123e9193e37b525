#include "engine/step/run/tile_choice.hpp"
#include <algorithm>

namespace wadi {

bool TileChoice::wants_tiles(std::uint64_t step, const News& news) {
    const bool known = known_by_ != 0 && news.ticket >= known_by_;
    if (state_ == State::trial && over_tiles_ >= trial_steps) state_ = State::waits;
    if (state_ == State::waits && known) {
        state_ = news.share < begin_below ? State::with : State::without;
        if (state_ == State::with) {
            pause_ = first_pause;
        } else {
            next_trial_ = step + pause_;
            pause_ = std::min(2 * pause_, longest_pause);
        }
        over_tiles_ = 0;
        known_by_ = 0;
    } else if (state_ == State::with && known && news.share > leave_above) {
        state_ = State::without;
        next_trial_ = step + pause_;
    } else if (state_ == State::without && step >= next_trial_) {
        state_ = State::trial;
        over_tiles_ = 0;
        known_by_ = 0;
    }
    return state_ == State::trial || state_ == State::with;
}

void TileChoice::submitted(std::uint64_t steps, bool over_tiles, compute::Ticket ticket) {
    if (!over_tiles) return;
    over_tiles_ += steps;
    // The newest one of a trial; in a world that stays with tiles the first that tells.
    if (over_tiles_ >= trial_steps && (state_ == State::trial || known_by_ == 0)) known_by_ = ticket.value;
}

} // namespace wadi
