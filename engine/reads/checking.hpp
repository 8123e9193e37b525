// A checking mode: after every step the state is read and what the solver promises of it is verified, so that what breaks is
// named with its step, field and cell where it breaks, and not where it is seen. Many times as slow as a world without.
#pragma once
#include "engine/reads/state_reader.hpp"

namespace wadi {

class Checking {
  public:
    Checking(WorldState& state, Stepper& stepper, StateReader& reader) : state_(state), stepper_(stepper), reader_(reader) {}

    /// From the next step on. What a host writes between steps may be faster than any step lets it be.
    void set(bool on) { on_ = on; }
    /// Verifies the state between two steps: every number is finite, no height is negative, no speed is above its clamp, and,
    /// unless a column came near method.largest_height, every quantum is in the books. Of method "published", which promises no
    /// more, the first alone. Errors: internal, naming the first promise that is broken; device_lost.
    Status look();
    /// The same for a state whose statistics are known.
    Status look(const WorldStats& stats);
    /// look(), where it is on.
    Status after_step() { return on_ ? look() : ok_status(); }
    /// `most`, or one step: what comes of several is not to be looked at in the end alone.
    std::uint64_t undisturbed(std::uint64_t most) const { return on_ ? std::min<std::uint64_t>(most, 1) : most; }

  private:
    /// Names the first value of the fields whose names end in `ending` that `wrong` says is.
    Status broken(const std::string& ending, const std::function<bool(double)>& wrong, const std::string& promise);
    Status check_speeds(const WorldStats& stats);
    Status check_books(const WorldStats& stats);

    WorldState& state_;
    Stepper& stepper_;
    StateReader& reader_;
    bool on_ = false;
    bool high_ = false; // a column came near method.largest_height: what rounds there is in no book
};

} // namespace wadi
