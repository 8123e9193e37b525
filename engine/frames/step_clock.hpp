// Host time cut into steps of fixed dt, in whole nanoseconds.
#pragma once
#include <cstdint>

namespace wadi {

/// Counts steps of dt in a total of nanoseconds: floor(total / dt), whatever pieces the total came in, exactly. The boundary of
/// every step is kept as whole nanoseconds and a fraction of 2^-64; dt enters as the double dt * 1e9.
class StepClock {
  public:
    /// dt [s] > 0.
    explicit StepClock(double dt);

    /// More host time. The clock holds at most 2^62 ns (146 years) beyond the last step; returns what did not fit.
    std::uint64_t add(std::uint64_t nanoseconds);
    /// Takes time back that add() took in, of which steps may have been taken meanwhile: that is owed by what comes next.
    void take_back(std::uint64_t nanoseconds);
    /// The next step is due.
    bool due() const { return since_ >= to_next(); }
    /// Counts the step that is due as done.
    void take();
    /// Forgets time so that no step is due, one nanosecond before the next at the latest. Returns what was forgotten [ns].
    std::uint64_t drop();
    /// Time since the last step's boundary in units of dt, in [0, 1) while no step is due.
    double share_of_step() const;

  private:
    // From the whole nanoseconds of the last boundary to the first nanosecond at or after the next one.
    std::uint64_t to_next() const;

    std::uint64_t period_, period_fraction_; // dt [ns], [2^-64 ns]
    std::uint64_t owed_ = 0;                 // of time to come [ns]
    std::uint64_t since_ = 0;                // since the last boundary's whole nanoseconds [ns]
    std::uint64_t fraction_ = 0;             // of the last boundary [2^-64 ns]
};

} // namespace wadi
