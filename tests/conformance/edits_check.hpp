// Edits for apply_edits, and what they should do by their definition.
#pragma once
#include "engine/edits/edits.hpp"
#include "tests/conformance/stage_checks.hpp"

namespace wadi::conformance {

/// One edit of each kind on each layer that fits the scene's grid; shapes keep off cell and face centres.
std::vector<Edit> edits_of(const Scene& scene);
/// The image that the stamps among them use.
Stamp stamp_of_cases();
/// Puts them into the input of a step.
void add_edits(const Scene& scene, StepInput& input);

/// Fields within a quantum per edit of the definition, the ledger exact: it holds what the depths changed by.
Verdict check_edits(const StageRun& run);

} // namespace wadi::conformance
