// Values for write_values, and what they should do by their definition.
#pragma once
#include "tests/conformance/stage_checks.hpp"

namespace wadi::conformance {

/// A rectangle off the rim where the grid has room for one, and a layer that follows from grid and effects.
void add_values(const Scene& scene, StepInput& input);
/// One for each cell of the largest rectangle: near and midway between quanta, too low, too high, and no numbers.
std::vector<float> values_of_cases(const Scene& scene);

/// Heights and ledger exact where there is a quantum, else to rounding; strain as the definition has it.
Verdict check_values(const StageRun& run);

} // namespace wadi::conformance
