// What runs of a search differ by, and what that tells of errors.
#pragma once
#include "tuner.hpp"

namespace tune {

constexpr double LEAST_H = 1.15; // cells of a run that is compared, in units of the reference's

/// Ways whose errors fall alike with cells.
bool alike(const Way& a, const Way& b);
bool same_but_tiles(const Way& a, const Way& b);

/// The runs of a ladder beside a reference; both are the search's and may change between calls.
class Comparisons {
  public:
    Comparisons(const std::vector<Run>& ladder, const std::optional<Run>& reference, std::function<double()> elapsed)
        : ladder_(ladder), reference_(reference), elapsed_(std::move(elapsed)) {}

    /// What sand and water of the outcome are told of, and the models' errors. Wants a reference.
    void fit_errors(Outcome& outcome, std::vector<WayModel>& models);
    double seconds() const { return seconds_; } // that comparing took

  private:
    Errors errors_of(const Run& run, const Run& reference, int checkpoints);
    template <class Wanted> std::vector<ErrorPoint> differences(bool sand, int checkpoints, const Wanted& wanted);
    const Run* nearest_kin(double nx) const;
    std::optional<double> closing(bool sand, int checkpoints);
    Told told_until(bool exists, bool sand, int checkpoints);

    /// Two runs of one piece, and what they are apart in its first checkpoints.
    struct Pair {
        Settings run, reference;
        std::size_t run_times = 0, reference_times = 0;
        int checkpoints = 0;
        Errors errors;
        bool same(const Pair& other) const {
            return run == other.run && reference == other.reference && run_times == other.run_times &&
                   reference_times == other.reference_times && checkpoints == other.checkpoints;
        }
    };
    const std::vector<Run>& ladder_;
    const std::optional<Run>& reference_;
    std::function<double()> elapsed_;
    std::vector<Pair> pairs_;
    double seconds_ = 0;
};

} // namespace tune
