// The stages that list a step's active tiles: their inputs, and what they must write by definition.
#pragma once
#include "tests/conformance/bench.hpp"
#include "tests/conformance/inputs.hpp"
#include "tests/conformance/stage_checks.hpp"

namespace wadi::conformance {

bool lists_active_tiles(const std::string& stage);
/// Gives the case tiles of 8 x 8 cells, and its step a number and two rectangles to wake.
void add_active_tiles(Scene& scene, StepInput& input);
/// Fills a buffer of these stages; false for any other binding.
bool fill_active_tiles(BenchBuffer& buffer, const compute::StageBinding& binding, const WorldParams& params);
Verdict check_active_tiles(const StageRun& run);

} // namespace wadi::conformance
