// Whether steps run over active tiles, in a world that chooses for itself: where less than so much of it is awake.
#pragma once
#include "engine/compute/device.hpp"
#include <cstdint>

namespace wadi {

/// Tiles are tried for a few steps now and then, the longer apart the more often all was awake, and stay where they gain. What a
/// trial showed comes late and is not waited for: steps go on without tiles until then. All of it changes no bit.
class TileChoice {
  public:
    /// The host's news of active tiles: the newest submission whose count has arrived, and that count as a share of all tiles.
    struct News {
        std::uint64_t ticket = 0;
        double share = 1;
    };

    /// Whether the steps from `step` on should run over tiles.
    bool wants_tiles(std::uint64_t step, const News& news);
    /// So many steps were submitted, over tiles or not, the last one with `ticket`.
    void submitted(std::uint64_t steps, bool over_tiles, compute::Ticket ticket);
    /// Begins with a trial.
    void restart() { *this = {}; }

    /// Above it tiles cost more than they save, below the other one they are worth beginning with: shares of all tiles.
    static constexpr double leave_above = 0.7, begin_below = 0.55;
    /// Steps of a trial: all tiles run in the first three, since the change itself wakes them.
    static constexpr std::uint64_t trial_steps = 8;
    /// Steps from a trial that found all awake to the next one: the first time, and the most after doublings. A step of a trial
    /// may cost a third more: 1 % of the time at first.
    static constexpr std::uint64_t first_pause = 256, longest_pause = 2048;

  private:
    enum class State : std::uint8_t { trial, waits, without, with };
    State state_ = State::trial;
    std::uint64_t over_tiles_ = 0; // steps since tiles were last begun with
    std::uint64_t known_by_ = 0;   // ticket of a submission whose count tells what is awake; 0 = none yet
    std::uint64_t next_trial_ = 0, pause_ = first_pause;
};

} // namespace wadi
