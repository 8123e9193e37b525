// The reference solver, stage by stage, under the names of Wadi's stages.
#pragma once
#include "engine/step/run/step_inputs.hpp"
#include "tests/conformance/inputs.hpp"
#include "tests/reference/solver.hpp"
#include <memory>
#include <string>

namespace wadi::conformance {

/// True for a stage that the reference solver has as a step of its own.
bool has_counterpart(const std::string& stage);

/// Runs one stage; a stage without a counterpart changes nothing.
template <class Real> void run_reference_stage(reference::Solver<Real>& solver, const std::string& stage);

constexpr int sampled_points = 150; // of a stage over POINTS: some rows, the last one not full

/// The state in front of a stage, the same in both precisions.
struct Pilot {
    std::unique_ptr<reference::Solver<float>> narrow;
    std::unique_ptr<reference::Solver<double>> wide;
    StepInput input{}; // of the step that the stage belongs to
};

/// Loads a scene, runs its pilot steps in float and the step's stages ahead of `stage`, and hands both precisions the same
/// floats. Stages outside the step (publish_*, mark_limits) see the state after the pilot steps.
Pilot make_pilot(const Scene& scene, const std::string& stage);

/// Both precisions side by side over whole steps, and the double solver once more without a quantum, all from the same floats.
struct References {
    explicit References(const Scene& scene);
    /// One stage of the plan, with the split of the water where the solver needs it as a step of its own.
    void run_stage(const std::string& stage);
    void step();
    void finish_step(); // after the stages of a step were run one by one

    reference::Solver<float> narrow;
    reference::Solver<double> wide, unrounded;
};

extern template void run_reference_stage(reference::Solver<float>&, const std::string&);
extern template void run_reference_stage(reference::Solver<double>&, const std::string&);

} // namespace wadi::conformance
