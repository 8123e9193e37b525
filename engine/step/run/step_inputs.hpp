// What changes with every water substep: sources, rain and sides over time, in whole quanta.
#pragma once
#include "engine/settings/data/settings.hpp"
#include "shaders/params.hpp"
#include <span>
#include <vector>

namespace wadi {

/// Produces the StepInput of each step in turn. A rate below one quantum per step is not lost: the running total is rounded
/// down to whole quanta and each step gets the difference.
class StepInputs {
  public:
    /// Running total of one rate.
    struct Total {
        double metres = 0, quanta = 0;
    };
    /// Of every source, then rain, evaporation and, where they are discharges, the sides.
    using Totals = std::vector<Total>;

    explicit StepInputs(const Settings& settings);
    /// The inputs of step `step`, which must be one more than at the last call: one for each of the water's substeps.
    void next(std::uint64_t step, std::span<StepInput> inputs);
    /// The same of a world without substeps of the water.
    StepInput next(std::uint64_t step) {
        StepInput input;
        next(step, {&input, 1});
        return input;
    }
    /// Takes the last next() back: its step could not be submitted.
    void undo() { totals_ = before_; }
    const Totals& totals() const { return totals_; }
    void set_totals(const Totals& totals) { totals_ = totals; }
    /// Goes on from the totals of inputs that may have other sources.
    void carry_over(const StepInputs& before);

  private:
    /// Of a water substep, counted from the world's beginning; all but the number of its step.
    StepInput substep(std::uint64_t substep);
    float advance(Total& total, double rate) const;
    /// Depth per time of source n [m/s].
    double rate_of(std::size_t n, double time) const;
    vec4 source_input(std::size_t n, double time);
    void set_sides(StepInput& input, double time);

    Settings settings_;
    double quantum_;
    bool rain_is_mapped_;
    double rain_peak_;
    std::vector<double> areas_; // covered by each source with a discharge [m2]
    Totals totals_, before_;    // before the last next()
};

} // namespace wadi
